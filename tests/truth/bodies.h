#pragma once
/// Scenes of measured marble, and places on them.

#include "scene/MaterialPresets.h"
#include "tests/truth/scenes.h"
#include "truth/Translucent.h"

namespace lucent::test {

/// Light of one watt per square metre that travels this way.
inline scene::DistantLight sun(vec3 direction) {
    scene::DistantLight light;
    light.direction = direction;
    return light;
}

/// A body of the measured marble.
inline scene::Object marble(scene::Shape shape, vec3 centre = vec3(0)) {
    scene::Object object = matt(std::move(shape), centre);
    object.name = "marble";
    for (const scene::MaterialPreset& preset : scene::materialPresets())
        if (preset.name == "marble") {
            scene::Translucent inside;
            apply(preset, inside);
            object.material.kind = inside;
        }
    return object;
}

/// The marble sphere of 10 mm under light along -z.
inline scene::Scene marbleSphere() {
    scene::Scene scene = sceneOf({marble(scene::Sphere{0.01f})});
    scene.lights.push_back(sun({0, 0, -1}));
    return scene;
}

/// A plane so wide that light does not reach its edge, under light along -y.
inline scene::Scene marbleHalfSpace() {
    scene::Scene scene = sceneOf({marble(scene::Plane{{0.6f, 0.6f}})});
    scene.lights.push_back(sun({0, -1, 0}));
    return scene;
}

/// What a ray meets first.
inline truth::Hit intersect(const truth::Bodies& bodies, const dvec3& from, const dvec3& direction) {
    const auto hit = bodies.optics().rays().intersect({from, direction});
    EXPECT_TRUE(hit.has_value());
    return hit ? *hit : truth::Hit{};
}

} // namespace lucent::test
