// A Scene back to its file.
#include "base/JsonWriter.h"
#include "scene/Displacement.h"
#include "scene/Keys.h"
#include "scene/Load.h"
#include "scene/Strokes.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace lucent::scene {
namespace {

void writeValue(JsonWriter& json, const Param& param, const void* data) {
    if (param.kind == Kind::Toggle)
        json.value(getComponent(param, data, 0) != 0);
    else if (param.kind == Kind::Choice)
        json.value(getText(param, data));
    else if (componentCount(param.kind) == 1)
        json.raw(getText(param, data));
    else {
        std::array<float, 3> numbers{};
        const std::size_t count = std::size_t(componentCount(param.kind));
        for (std::size_t i = 0; i < count; ++i)
            numbers[i] = float(getComponent(param, data, int(i)));
        json.value(std::span<const float>(numbers.data(), count));
    }
}

bool isDefault(const ParamTable& table, const Param& param, const void* values) {
    const auto at = [&](const void* base) { return static_cast<const std::byte*>(base) + param.offset; };
    return getText(param, at(values)) == getText(param, at(table.defaults));
}

bool isDefault(const ParamTable& table, const void* values) {
    return std::all_of(table.params.begin(), table.params.end(),
                       [&](const Param& param) { return isDefault(table, param, values); });
}

// Parameters that differ from their defaults; `always` is written in any case.
void writeParams(JsonWriter& json, const ParamTable& table, const void* values,
                 std::string_view always = "") {
    for (const Param& param : table.params) {
        if (isDefault(table, param, values) && param.id != always) continue;
        json.key(param.id);
        writeValue(json, param, static_cast<const std::byte*>(values) + param.offset);
    }
}

void writeText(JsonWriter& json, std::string_view key, const std::string& text) {
    if (!text.empty()) json.key(key).value(text);
}

void writeSize(JsonWriter& json, std::string_view key, ivec2 size) {
    const float sides[] = {float(size.x), float(size.y)};
    json.key(key).value(std::span<const float>(sides));
}

void writeHeightSource(JsonWriter& json, const HeightSource& source) {
    constexpr std::string_view kKeys[] = {"heights", "normalMap", "mesh"};
    json.key(kKeys[int(source.kind)]).value(source.file);
    if (source.kind != HeightSource::Kind::Mesh) return;
    writeSize(json, "resolution", source.resolution);
    writeParams(json, heightSourceParams(), &source);
}

void writeHeightField(JsonWriter& json, const HeightField& field) {
    writeHeightSource(json, field.source);
    writeParams(json, heightFieldParams(), &field, "heightScale"); // a normal map has its own default
    writeText(json, "alpha", field.alphaFile);
    if (!field.alphaIsSolid) json.key("alphaIsSolid").value(false);
}

void writeShape(JsonWriter& json, const Shape& shape) {
    json.key("shape").beginObject();
    json.key("type").value(typeOf(shape).type);
    if (const auto* field = std::get_if<HeightField>(&shape)) {
        writeHeightField(json, *field);
    } else {
        if (const auto* mesh = std::get_if<MeshShape>(&shape)) {
            json.key("source").value(mesh->source);
            writeText(json, "part", mesh->part);
        }
        writeParams(json, *typeOf(shape).keys.tables[0], dataOf(shape));
    }
    json.end();
}

// Always there: without it a mesh would take the materials of its file.
void writeMaterial(JsonWriter& json, const Object& object) {
    const Material& material = object.material;
    json.key("material").beginObject();
    json.key("kind").value(materialKinds()[material.kind.index()].type);
    for (const ParamTable* table : materialKeysOf(object).tables)
        if (table != &attenuationParams()) writeParams(json, *table, structOf(material, *table));
    if (material.isScattering() && !material.translucent().layers.empty()) {
        json.key("layers").beginArray();
        for (const MediumLayer& layer : material.translucent().layers) {
            json.beginObject();
            writeParams(json, layerParams(), &layer);
            json.end();
        }
        json.end();
    }
    if (material.isRelief()) {
        writeText(json, "baseMap", material.baseMapFile);
        writeText(json, "diffuseMap", material.diffuseMapFile);
        writeText(json, "specularMap", material.specularMapFile);
    }
    if (const auto* measured = std::get_if<MeasuredBrdf>(&material.kind))
        writeText(json, "table", measured->tableFile);
    json.end();
}

void writeWave(JsonWriter& json, const Object& object) {
    if (!whyIdle(object, "wave").empty() || isDefault(waveParams(), &object.wave)) return;
    json.key("wave").beginObject();
    writeParams(json, waveParams(), &object.wave, "amplitude");
    json.end();
}

void writeDisplacement(JsonWriter& json, const Object& object) {
    if (!object.displacement) return;
    json.key("displacement").beginObject();
    writeHeightSource(json, object.displacement->source);
    writeParams(json, displacementParams(), &*object.displacement);
    json.end();
}

// Strokes were measured in the world: radii grow with the object.
std::vector<Stroke> strokesNow(const Object& object) {
    std::vector<Stroke> strokes = object.painting->strokes;
    const float growth = object.transform.scale / object.painting->scale;
    for (Stroke& stroke : strokes)
        if (growth != 1) stroke.brush.radius *= growth;
    return strokes;
}

void writePaint(JsonWriter& json, const Object& object) {
    if (!object.painting || !object.material.isScattering()) return;
    const Painting& painting = *object.painting;
    const bool hasMaps = !painting.enteringFile.empty() || !painting.leavingFile.empty();
    json.key("paint").beginObject();
    writeText(json, "entering", painting.enteringFile);
    writeText(json, "leaving", painting.leavingFile);
    const bool asWritten = !painting.strokesFile.empty() && object.transform.scale == painting.scale;
    if (asWritten) json.key("strokes").value(painting.strokesFile);
    if (!asWritten && (!painting.strokes.empty() || !hasMaps)) {
        json.key("strokes");
        writeStrokes(json, strokesNow(object));
    }
    if (!hasMaps) json.key("side").value(painting.side());
    json.end();
}

void writeObject(JsonWriter& json, const Object& object) {
    json.beginObject();
    json.key("name").value(object.name);
    writeShape(json, object.shape);
    writeMaterial(json, object);
    json.key("transform").beginObject();
    writeParams(json, transformParams(), &object.transform);
    json.end();
    writeWave(json, object);
    writeDisplacement(json, object);
    writePaint(json, object);
    writeText(json, "bake", object.bakeFile);
    if (!object.visible) json.key("visible").value(false);
    json.end();
}

void writeLight(JsonWriter& json, const Light& light) {
    json.beginObject();
    json.key("type").value(typeOf(light).type);
    const auto* spot = std::get_if<SpotLight>(&light);
    if (spot) writeText(json, "image", spot->imageFile);
    for (const ParamTable* table : typeOf(light).keys.tables)
        if (table != &projectorParams() || spot->image) writeParams(json, *table, dataOf(light));
    json.end();
}

void writeTechniques(JsonWriter& json, const std::map<std::string, Settings>& techniques) {
    json.key("technique").beginObject();
    for (const auto& [name, settings] : techniques) {
        json.key(name).beginObject();
        writeParams(json, settings.table(), settings.data());
        json.end();
    }
    json.end();
}

} // namespace

std::string toJson(const Scene& scene) {
    JsonWriter json;
    json.beginObject();
    json.key("lucent").value(1);
    writeText(json, "title", scene.title);
    writeText(json, "caption", scene.caption);
    writeSize(json, "size", scene.size);
    json.key("camera").beginObject();
    writeParams(json, cameraParams(), &scene.camera);
    json.end();
    json.key("view").beginObject();
    writeParams(json, viewParams(), &scene.view);
    json.end();
    if (scene.environment) {
        json.key("environment").beginObject();
        json.key("source").value(scene.environment->source);
        writeParams(json, environmentParams(), &*scene.environment);
        json.end();
    }
    json.key("lights").beginArray();
    for (const Light& light : scene.lights)
        writeLight(json, light);
    json.end();
    json.key("objects").beginArray();
    for (const Object& object : scene.objects)
        writeObject(json, object);
    json.end();
    writeTechniques(json, scene.technique);
    json.key("quality").beginObject();
    writeParams(json, qualityParams(), &scene.quality);
    json.end();
    json.end();
    return json.text();
}

} // namespace lucent::scene
