#pragma once
/// A camera as matrices: what a view is seen through.

#include "scene/Scene.h"

namespace lucent::views {

struct Eye {
    mat4 clipFromWorld{1};
    vec3 position{0}; ///< world
    vec3 forward{0};  ///< world, unit
    bool perspective = false;

    /// Where eye rays come from in the space of an object: the position with w = 1, or with w = 0 the unit
    /// direction that all of them share. This is what shaders call `eye`.
    vec4 inObject(const mat4& worldFromObject) const;
};

/// Near and far plane are put around the scene's objects.
///
/// @param aspect  width over height of the picture
Eye makeEye(const scene::Scene& scene, float aspect);

/// Corners of the box around an object in world space: lowest and highest coordinate.
struct Bounds {
    vec3 low{1e30f}, high{-1e30f};
    void add(vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    vec3 center() const { return 0.5f * (low + high); }
    float radius() const { return 0.5f * glm::length(high - low); }
};
Bounds boundsOf(const scene::Object& object);

} // namespace lucent::views
