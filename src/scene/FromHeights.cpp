// Scenes made from a picture that a person hands over.
#include "base/Text.h"
#include "scene/HeightSource.h"
#include "scene/ImageUse.h"
#include "scene/Keys.h"
#include "scene/Load.h"

#include <algorithm>

namespace lucent::scene {
namespace {

// "some/folder/coin.png" -> "coin"; names of objects hold no dots.
std::string stemOf(const std::string& path) {
    const std::string file = path.substr(path.rfind('/') + 1);
    const std::string stem = file.substr(0, file.find('.'));
    return stem.empty() ? "heights" : stem;
}

} // namespace

Status replaceHeights(Object& object, const std::string& name, std::span<const std::byte> bytes) {
    if (!std::holds_alternative<HeightField>(object.shape))
        return Error{name + ": would replace " + inQuotes(object.name) + ", a " +
                     inQuotes(typeOf(object.shape).type) + "; must replace a height field"};
    Result<std::shared_ptr<const Image>> heights = decodeHeights(bytes, name);
    if (!heights) return heights.error();
    object.field().heights = *heights;
    object.field().source = {};
    object.field().source.file = name;
    object.field().alpha = nullptr;
    object.field().alphaFile.clear();
    Material& material = object.material;
    material.baseMap = material.diffuseMap = material.specularMap = nullptr;
    for (std::string* file : {&material.baseMapFile, &material.diffuseMapFile, &material.specularMapFile})
        file->clear();
    fitHeights(object);
    return Done{};
}

Result<Scene> sceneFromHeights(const std::string& name, std::span<const std::byte> bytes,
                               std::span<const ParamTable* const> techniques) {
    Scene scene;
    scene.title = stemOf(name);
    for (const ParamTable* table : techniques)
        scene.technique.emplace(table->name, Settings(*table));
    Object& object = scene.objects.emplace_back();
    object.name = stemOf(name);
    object.material.relief().specularity = 0.2f;
    if (Status loaded = replaceHeights(object, name, bytes); !loaded) return loaded.error();

    const vec2 footprint = object.field().footprint();
    scene.camera.height = 1.06f * std::max(footprint.x, footprint.y); // a little air around a square picture
    scene.camera.eye.z = std::max(2.0f, 2 * scene.camera.height);
    scene.lights.emplace_back(PointLight{.intensity = kPi}); // a white surface that faces it is 1
    Environment& environment = scene.environment.emplace();
    environment.source = "rainbow";
    environment.enabled = false;
    environment.map = *loadEnvironmentMap(environment.source, {});
    return scene;
}

} // namespace lucent::scene
