#include "measure/FormScenes.h"

#include "technique/Technique.h"

#include <algorithm>
#include <cmath>

namespace lucent::measure {

scene::Object objectOf(scene::Shape shape, vec3 place) {
    scene::Object object;
    object.shape = std::move(shape);
    object.material.diffuse = vec3(1);
    object.transform.translate = place;
    return object;
}

scene::Object glassOf(scene::Shape shape, float ior, vec3 place) {
    scene::Object object = objectOf(std::move(shape), place);
    object.material.kind = scene::Clear{.ior = ior};
    return object;
}

scene::Scene sceneOf(std::vector<scene::Object> objects, float height) {
    scene::Scene scene;
    scene.size = {kSide, kSide};
    scene.objects = std::move(objects);
    scene.camera.eye = {0, 4, 0};
    scene.camera.up = {0, 0, -1};
    scene.camera.height = height;
    technique::addSettings(scene);
    return scene;
}

void addSun(scene::Scene& scene, double angle) {
    auto& sun = scene.lights.emplace_back(std::in_place_type<scene::DistantLight>);
    std::get<scene::DistantLight>(sun).direction = {float(-std::sin(angle)), float(-std::cos(angle)), 0};
}

void addWhiteSphere(scene::Scene& scene) {
    auto map = std::make_shared<Image>(8, 4, 3);
    std::fill(map->pixels.begin(), map->pixels.end(), 1.0f);
    scene.environment.emplace().map = map;
}

dvec3 valueAt(const Image& image, ivec2 pixel) {
    const float* value = image.at(pixel.x, pixel.y);
    return {value[0], value[1], value[2]};
}

void takeAll(Finding& finding, const Image& image, dvec3 expected) {
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int channel = 0; channel < 3; ++channel)
                finding.take(expected[channel], image.at(x, y)[channel]);
}

} // namespace lucent::measure
