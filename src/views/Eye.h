#pragma once
/// A camera as matrices: what a view is seen through.

#include "graph/Device.h"
#include "scene/Scene.h"
#include "shaders/views/Blocks.h"

#include <vector>

namespace lucent::views {

struct Eye {
    mat4 clipFromWorld{1};
    vec3 position{0}; ///< world
    vec3 forward{0};  ///< world, unit
    bool perspective = false;
    vec3 right{0}, up{0};            ///< world, unit
    vec2 halfExtent{0};              ///< of the picture: m, or m for each metre of depth
    float nearest = 0, farthest = 0; ///< depths between which everything lies, m
    vec2 shift{0}; ///< of what the picture shows, in halves of it: samples of a pixel lie beside its middle
    vec4 cut{0, 0, 0, 1}; ///< world, a plane: what lies where dot(cut, (place, 1)) is below 0 is not shown
    bool second =
        false; ///< of each pixel the object that it meets first is left out: what that hides is shown
    float threshold = 0; ///< [0,1]: by which views of the same pixel differ in what they show of blended
                         ///< meshes (shaders/views/holes.glsl)

    bool isCut() const { return vec3(cut) != vec3(0); }
    /// Where eye rays come from in the space of an object: the position with w = 1, or with w = 0 the unit
    /// direction that all of them share. This is what shaders call `eye`.
    vec4 inObject(const mat4& worldFromObject) const;
    bool operator==(const Eye&) const = default;
};

/// Near and far plane are put around the scene's objects.
///
/// @param aspect   width over height of the picture
/// @param nearest  of a perspective eye that stands among them: the near plane is no nearer than this part of
/// the
///                 far one. Depth buffers that are not linear need a thousandth
/// @param shift    Eye::shift
Eye makeEye(const scene::Scene& scene, float aspect, float nearest = 1e-3f, vec2 shift = vec2(0));

ViewBlock viewBlock(const Eye& eye, ivec2 size);

/// Corners of the box around an object in world space: lowest and highest coordinate.
struct Bounds {
    vec3 low{1e30f}, high{-1e30f};
    void add(vec3 point) {
        low = glm::min(low, point);
        high = glm::max(high, point);
    }
    void add(const Bounds& other) {
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    vec3 center() const { return 0.5f * (low + high); }
    float radius() const { return 0.5f * glm::length(high - low); }
    bool operator==(const Bounds&) const = default;
};
/// Of an object at any time. A moving mesh's are those of its poses at a few times, with a margin.
Bounds boundsOf(const scene::Object& object);

} // namespace lucent::views
