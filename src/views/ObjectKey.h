#pragma once
/// What the surface of an object depends on: while it stays, its images in a view do.

#include "scene/Scene.h"

#include <memory>
#include <vector>

namespace lucent::views {

struct ObjectKey {
    /// In the object's own space.
    struct Own {
        std::shared_ptr<const void> shape, mask;
        vec2 field{0}; ///< of a height field: width and height scale
        bool isRefractive = false;
        scene::Wave wave{};                                ///< where it acts
        std::optional<scene::Displacement> displacement{}; ///< of what is displaced
        float time = 0;                                    ///< s, where the object moves by itself
        bool operator==(const Own&) const = default;
    };
    Own own;
    mat4 worldFromObject{1};
    bool visible = true;
    bool operator==(const ObjectKey&) const = default;
};

/// @param time  s; of account where the object moves. Water moves by itself: see Waters::changes()
ObjectKey objectKey(const scene::Object& object, float time);
/// Of all objects of a scene at its time.
std::vector<ObjectKey> objectKeys(const scene::Scene& scene);

} // namespace lucent::views
