#pragma once
/// Height fields and scenes that tests share.

#include "frame/Renderer.h"
#include "scene/Scene.h"
#include "technique/Technique.h"
#include "techniques/relief/Relief.h"

#include <cmath>
#include <functional>

namespace lucent::support {

/// Heights from a function of the texel's column and row.
inline std::shared_ptr<const Image> heights(ivec2 size, const std::function<float(int, int)>& height) {
    auto image = std::make_shared<Image>(size.x, size.y, 1);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
            *image->at(x, y) = height(x, y);
    return image;
}

/// Three waves of different direction and length, heights within [0, 1].
inline std::shared_ptr<const Image> waves(ivec2 size) {
    return heights(size, [size](int x, int y) {
        const float u = float(x) / float(size.x), v = float(y) / float(size.y);
        return 0.5f + 0.22f * std::sin(19 * u + 3 * v) + 0.16f * std::sin(31 * v - 11 * u + 1) +
               0.1f * std::sin(57 * u + 49 * v + 2);
    });
}

/// Bumps of many sizes from a fixed hash; heights within [0, 1].
inline std::shared_ptr<const Image> noise(ivec2 size) {
    const auto hash = [](int x, int y) {
        auto h = std::uint32_t(x) * 374761393u + std::uint32_t(y) * 668265263u;
        h = (h ^ (h >> 13)) * 1274126177u;
        return float((h ^ (h >> 16)) & 0xffffff) / float(0xffffff);
    };
    return heights(size, [hash](int x, int y) {
        float sum = 0;
        for (int octave = 2; octave <= 6; ++octave) {
            const float step = float(1 << octave);
            const int i = int(float(x) / step), j = int(float(y) / step);
            float fx = float(x) / step - float(i), fy = float(y) / step - float(j);
            fx = fx * fx * (3 - 2 * fx);
            fy = fy * fy * (3 - 2 * fy);
            const float top = hash(i, j) + fx * (hash(i + 1, j) - hash(i, j));
            const float down = hash(i, j + 1) + fx * (hash(i + 1, j + 1) - hash(i, j + 1));
            sum += step / 128 * (top + fy * (down - top));
        }
        return std::min(1.0f, sum);
    });
}

/// A scene of one height field seen straight from above, one pixel a texel, without lights.
inline scene::Scene sceneOf(std::shared_ptr<const Image> map, float heightScale, float depth) {
    scene::Scene scene;
    scene::Object object;
    object.name = "field";
    object.field().heights = std::move(map);
    object.field().heightScale = heightScale;
    object.material.relief().depth = depth;
    object.material.diffuse = vec3(1);
    scene.size = object.field().texels();
    scene.camera.height = object.field().footprint().y;
    scene.camera.eye = {0, 0, 2 + heightScale};
    technique::addSettings(scene);
    scene.objects.push_back(std::move(object));
    return scene;
}

inline relief::Settings& reliefSettings(scene::Scene& scene) {
    return *static_cast<relief::Settings*>(scene.technique.at("relief").data());
}

/// A distant light `elevation` degrees above the horizon, `azimuth` degrees from +x towards +y.
inline scene::DistantLight distantLight(double elevation, double azimuth) {
    const double e = elevation * std::numbers::pi / 180, a = azimuth * std::numbers::pi / 180;
    scene::DistantLight light;
    light.irradiance = kPi; // a white surface that faces it is 1
    light.direction = -vec3(glm::dvec3(std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)));
    return light;
}

/// A matt box, 0.25 m wide.
inline scene::Object boxAt(vec3 place) {
    scene::Object box;
    box.name = "box";
    box.shape = scene::Box{vec3(0.25f)};
    box.material.diffuse = {0.7f, 0.4f, 0.2f};
    box.transform.translate = place;
    return box;
}

} // namespace lucent::support
