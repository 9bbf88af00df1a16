#pragma once
/// What the images of a view depend on: while it stays, only light has changed.

#include "views/Eye.h"
#include "views/ObjectKey.h"

namespace lucent::views {

struct SurfaceKey {
    std::vector<ObjectKey> objects;
    mat4 clipFromWorld;
    bool second; // Eye::second
    ivec2 size;
    bool showsGlass;      // its surface, not what is behind
    std::uint64_t waters; // Waters::changes()
    bool operator==(const SurfaceKey&) const = default;
};

/// @param waters  Waters::changes()
SurfaceKey surfaceKey(const scene::Scene& scene, const Eye& eye, ivec2 size, std::uint64_t waters);

/// Whether a quantity is one of the surfaces alone, without light.
inline bool isGeometric(scene::Aov aov) {
    return aov == scene::Aov::Normal || aov == scene::Aov::Depth || aov == scene::Aov::Position;
}

} // namespace lucent::views
