#pragma once
/// Small scenes of glass for tests.

#include "scene/Mesh.h"
#include "scene/Scene.h"
#include "truth/LightPath.h"
#include "truth/Optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lucent::test {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A clear object at `centre`.
inline scene::Object glass(scene::Shape shape, float ior, vec3 centre = vec3(0)) {
    scene::Object object;
    object.name = "glass";
    object.shape = std::move(shape);
    object.material.kind = scene::Clear{.ior = ior};
    object.transform.translate = centre;
    return object;
}

/// Heights [m] of a place in x and z, in texels of 2 mm, as a field of glass on y = 0 whose top faces +y.
template <class Height>
scene::Object glassRelief(int texels, float ior, Height height) {
    auto map = std::make_shared<Image>(texels, texels, 1);
    scene::HeightField field;
    field.width = 0.002f * float(texels);
    field.heightScale = 1;
    for (int y = 0; y < texels; ++y)
        for (int x = 0; x < texels; ++x)
            *map->at(x, y) =
                float(height(0.002 * (x - 0.5 * (texels - 1)), 0.002 * (y - 0.5 * (texels - 1))));
    field.heights = std::move(map);
    scene::Object object = glass(field, ior);
    object.transform.rotate = {-90, 0, 0};
    return object;
}

inline scene::Object matt(scene::Shape shape, vec3 centre = vec3(0)) {
    scene::Object object;
    object.name = "matt";
    object.shape = std::move(shape);
    object.transform.translate = centre;
    return object;
}

inline scene::Object mirror(scene::Shape shape, vec3 centre = vec3(0)) {
    scene::Object object = matt(std::move(shape), centre);
    object.material.kind = scene::Mirror{};
    return object;
}

inline scene::Scene sceneOf(std::vector<scene::Object> objects) {
    scene::Scene scene;
    scene.objects = std::move(objects);
    return scene;
}

/// An environment of one colour.
inline void addSky(scene::Scene& scene, vec3 radiance) {
    Image map(4, 2, 3);
    for (std::size_t i = 0; i < map.pixels.size(); ++i)
        map.pixels[i] = radiance[int(i % 3)];
    scene.environment.emplace();
    scene.environment->map = std::make_shared<Image>(std::move(map));
}

/// A scene and the rays through it.
class Bench {
public:
    explicit Bench(scene::Scene scene) : scene_(std::move(scene)), optics_(truth::Optics::create(scene_)) {}
    explicit Bench(std::vector<scene::Object> objects) : Bench(sceneOf(std::move(objects))) {}

    const truth::Optics& optics() const { return *optics_; }
    /// By the chain, from a place that may lie inside.
    truth::Arrival send(const dvec3& origin, const dvec3& direction, int channel = 1) const {
        truth::Random unused(0, 0, 0);
        const truth::Beam beam{.origin = origin,
                               .direction = glm::normalize(direction),
                               .media = optics_->mediaAt(origin, true),
                               .hitsHidden = true};
        return truth::follow(*optics_, beam, channel, truth::Branching::Chain, {}, unused);
    }

private:
    scene::Scene scene_;
    Result<truth::Optics> optics_;
};

inline double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// Angle between unit vectors, exact for small ones too.
inline double angleBetween(const dvec3& a, const dvec3& b) {
    return 2 * std::asin(std::min(1.0, 0.5 * glm::distance(a, b)));
}

/// Fresnel's reflectance by the sines and tangents of both angles, another form than the code's.
inline double fresnel(double incident, double relative) {
    const double sine = std::sin(incident) * relative;
    if (sine >= 1) return 1;
    const double other = std::asin(sine);
    if (incident < 1e-6) {
        const double amplitude = (relative - 1) / (relative + 1);
        return amplitude * amplitude;
    }
    const double s = std::sin(incident - other) / std::sin(incident + other);
    const double p = std::tan(incident - other) / std::tan(incident + other);
    return 0.5 * (s * s + p * p);
}

} // namespace lucent::test
