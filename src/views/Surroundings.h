#pragma once
/// What lies around mirrors and refractive objects, which the camera need not see: cube views from there, and
/// of flat mirrors the camera's own view mirrored.

#include "base/Param.h"
#include "graph/Device.h"
#include "scene/Scene.h"
#include "views/Eye.h"

#include <array>
#include <string>
#include <vector>

namespace lucent::views {

/// What rays show that leave a mirror or refractive objects: the environment alone, what the camera sees too,
/// or all that is there.
enum class Around : int { Environment, View, Surroundings };

/// The parameter of a technique that shades where such rays begin.
ParamText aroundText();

/// A place from which all around is seen.
struct Probe {
    std::string name;    ///< whose, for people
    vec3 place{0};       ///< world
    int object = -1;     ///< of the scene: the mirror where rays begin; -1: refractive objects; -2: only the
                         ///< mirror of the probe before is seen, in itself
    vec3 reflectance{0}; ///< of that mirror
    std::vector<int> hidden; ///< objects of the scene that are not seen from there: the own one
    bool operator==(const Probe&) const = default;
};

/// A flat side of a mirror that faces the camera.
struct FlatMirror {
    std::string name;
    int object = -1; ///< of the scene
    vec3 place{0};   ///< world, its middle
    vec3 normal{0};  ///< world, unit, towards the camera
    float share = 0; ///< of the picture that it covers, about
    bool operator==(const FlatMirror&) const = default;
};

/// What the techniques of a picture ask for.
struct Probes {
    std::vector<Probe> cubes;
    std::vector<FlatMirror> flat;
};

/// A probe from the middle of an object.
Probe probeFrom(const scene::Scene& scene, int object);
/// The same for a mirror, and a second one where it may be seen in itself.
std::vector<Probe> probesFromMirror(const scene::Scene& scene, int object);
/// Sides of a mirror that are plane and may be seen, none where it is no plane or box, or where a wave bends
/// it.
std::vector<FlatMirror> flatSides(const scene::Scene& scene, int object, const Eye& eye);
bool isFlat(const scene::Object& object);

/// Faces of a cube view: +x, -x, +y, -y, +z, -z of the world (shaders/views/surroundings.glsl).
scene::Camera cameraOf(const Probe& probe, int face);
/// The camera as a mirror shows it. Its picture is the mirror's with left and right exchanged.
scene::Camera mirrored(const scene::Camera& camera, const FlatMirror& mirror);

/// Of cubes, between looks along a ray; edges between them are found in halves.
inline constexpr float kTexelsALook = 2;

/// All of it as drawn. Who shades reads it by shaders/views/surroundings.glsl.
struct Surroundings {
    std::vector<Probe> cubes;
    std::vector<int> faces; ///< of each cube: bits of those that show anything, and six higher of those that
                            ///< also show what the first objects in their pixels hide
    std::vector<FlatMirror> flat;
    Bounds bounds;                    ///< of all that is drawn
    int further = 1;                  ///< mirrors that a ray from one is followed to
    float texelsALook = kTexelsALook; ///< how finely rays look at cubes
    graph::TextureHandle radiance = graph::TextureHandle::None; ///< of cubes, arrays: of the first objects,
                                                                ///< then of what they hide
    graph::TextureHandle solid = graph::TextureHandle::None;
    graph::TextureHandle mirrored = graph::TextureHandle::None; ///< a layer for each flat mirror

    bool hasCubes() const { return radiance != graph::TextureHandle::None; }
};

/// @param surroundings  or null
AroundBlock aroundBlock(const Surroundings* surroundings);

} // namespace lucent::views
