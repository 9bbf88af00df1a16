#pragma once
/// How a movement on the picture changes the scene: where things are seen, and what a drag makes of a light,
/// an environment or a camera. Pure functions; who calls them when is the viewer's business.

#include "scene/Scene.h"

#include <optional>

namespace lucent::viewer {

/// A camera in front of a picture of a certain size: between world and pixels.
class Lens {
public:
    /// @param size    of the picture in CSS pixels, > 0
    /// @param corner  upper left one of the picture, from which pixels count in the functions below
    Lens(const scene::Camera& camera, vec2 size, vec2 corner = vec2(0));

    /// Pixel at which a world point is seen; nothing behind a perspective camera.
    std::optional<vec2> project(vec3 point) const;
    /// The line on which a pixel's points lie: where it starts, and its unit direction.
    struct Sight {
        vec3 from, way;
    };
    Sight sight(vec2 pixel) const;
    /// Where the sight line of a pixel meets the plane through `point`; nothing when it runs along the plane
    /// (steeper than 1 : 20) or meets it behind the camera. @param normal  unit
    std::optional<vec3> onPlane(vec2 pixel, vec3 point, vec3 normal) const;
    /// Metres that one pixel covers at the depth of a world point.
    float metresPerPixel(vec3 point) const;
    /// Unit vector in which the camera looks.
    vec3 forward() const { return forward_; }
    vec3 eye() const { return eye_; }
    /// How far a vector goes to the right and down as it is seen, m.
    vec2 across(vec3 vector) const { return {glm::dot(vector, right_), -glm::dot(vector, up_)}; }
    /// The vector parallel to the picture that goes so many metres to the right and down.
    vec3 aside(vec2 metres) const { return right_ * metres.x - up_ * metres.y; }

private:
    bool perspective_;
    vec3 eye_, forward_, right_, up_;
    vec2 size_, corner_;
    float spread_; ///< m a pixel; perspective: m a pixel at a depth of 1 m
};

/// The camera that shows all of a picture of `sceneSize` within a view of another shape: a narrow view sees
/// more above and below instead of cutting off the sides.
scene::Camera framed(scene::Camera camera, ivec2 sceneSize, vec2 viewSize);

/// Where a light stands that a drag can move: an area light's corner; null for a distant light, which turns.
const vec3* placeOf(const scene::Light& light);
vec3 colorOf(const scene::Light& light);

/// Where a light is gripped on the picture.
struct LightHandle {
    vec2 place{0};               ///< of its dot, or of an arrow at the border, pixels
    std::optional<vec2> towards; ///< of an arrow: unit, to where the light is
};
/// Every light has one that is seen: where it stands, or an arrow at the border towards one outside of the
/// picture or behind the camera. A distant light has its dot on a disc in the middle: there while it shines
/// along the line of sight, at the rim when from the side.
LightHandle handleOf(const scene::Light& light, const Lens& lens, vec2 size);

/// A light moved from under one pixel to under another, in the plane through it; one behind the camera
/// parallel to the picture. Unmoved where onPlane() fails.
vec3 movedLight(const Lens& lens, vec3 position, vec3 normal, vec2 from, vec2 to);
/// A distant light turned so that its source goes with the pointer; half a turn for the view's shorter side.
vec3 turnedLight(const scene::Camera& camera, vec3 direction, vec2 turns);
/// An environment turned about the world's y axis (sideways) and x axis (up and down), or with `roll` about
/// z. What stands behind the camera goes with the pointer.
///
/// @param rotation  degrees about x, y, z
/// @param turns     drag in half turns
/// @return          degrees, each in [-180, 180)
vec3 turnedMap(vec3 rotation, vec2 turns, bool roll);
/// The eye led around the target by a drag, `up` kept; stops one degree before the poles.
vec3 orbited(const scene::Camera& camera, vec2 turns);
/// Closer for factors above 1: shows 1 / `factor` of the height, or brings the eye to 1 / `factor` of its
/// distance.
scene::Camera zoomed(scene::Camera camera, float factor);
/// A place on a sheet of water.
struct WaterPlace {
    int object = 0; ///< in the scene
    vec2 at{0};     ///< along x and z from its middle, m of the object
};
/// The water that a pixel shows where it is still and nothing stands before it; the nearest sheet of several.
std::optional<WaterPlace> waterAt(const scene::Scene& scene, const Lens& lens, vec2 pixel);

/// `z` times `factor`; heights under a millimetre start at a millimetre, so that zero is no trap.
float liftedLight(float z, float factor);

} // namespace lucent::viewer
