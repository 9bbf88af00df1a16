#include "scene/Bring.h"

#include "base/JsonWriter.h"
#include "base/Log.h"
#include "base/Pfm.h"
#include "base/Text.h"
#include "scene/HeightSource.h"
#include "scene/ImageUse.h"
#include "scene/Mesh.h"
#include "scene/ReflectanceTable.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace lucent::scene {
namespace {

Bytes toBytes(const std::string& text) {
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

void writeVector(JsonWriter& json, std::string_view key, vec3 value) {
    const float numbers[] = {value.x, value.y, value.z};
    json.key(key).value(std::span<const float>(numbers));
}

// Pictures have kSide pixels along the longer side of the frame.
void writeSize(JsonWriter& json, vec2 frame) {
    constexpr float kSide = 768;
    const vec2 size = glm::max(glm::round(frame * (kSide / std::max(frame.x, frame.y))), vec2(1));
    const float sides[] = {size.x, size.y};
    json.key("size").value(std::span<const float>(sides));
}

// What a colour shines that takes in and sends out `brightest` of white, so that it ends at kBrightest.
void writeExposure(JsonWriter& json, float brightest) {
    json.key("view").beginObject().key("exposure").value(std::log2(kBrightest / brightest)).end();
}

// --- reliefs

// Chosen by eye: air around the relief, where the lamp stands (of half the sides, and above the highest
// place), and how far the camera. Lengths are parts of the longer side.
constexpr float kReliefAir = 0.06f, kLampAcross = 1, kLampAbove = 0.25f, kEyeAbove = 2;
constexpr float kReliefHeight = 0.1f; // of heights in no unit of the relief's own
constexpr float kGloss = 0.2f; // specularity where a set says nothing of colours, or something of highlights
constexpr float kDiffuse = 0.8f; // where a set says nothing of colours

// Heights as the scene has them: `file` holds values from `low` to `high`, `scale` metres each.
struct Heights {
    std::string file;
    vec2 footprint{0}; // m
    float low = 0, high = 0, scale = kReliefHeight;

    // The lowest lies in the object's plane where it is not told by [0,1].
    float offset() const { return low < 0 || high > 1 ? -low * scale : 0; }
    float top() const { return high * scale + offset(); }
};

Heights heightsOf(const Image& image, const std::string& file) {
    Heights heights{.file = file};
    heights.footprint = vec2(image.size()) / float(std::max(image.width, image.height));
    const auto [low, high] = std::minmax_element(image.pixels.begin(), image.pixels.end());
    heights.low = *low;
    heights.high = *high;
    if (*low < 0 || *high > 1) heights.scale = kReliefHeight / std::max(*high - *low, 1e-6f);
    return heights;
}

struct Set {
    std::array<const MapFile*, 5> maps{}; // by use; null: none

    const MapFile* operator[](MapUse use) const { return maps[std::size_t(use)]; }
};

Result<Set> sorted(std::span<const MapFile> maps) {
    Set set;
    for (const MapFile& map : maps) {
        const MapFile*& place = set.maps[std::size_t(map.use)];
        if (place)
            return Error{map.name + ": is a second " + std::string(mapUseNames()[std::size_t(map.use)]) +
                         " map beside " + place->name + "; a set must have one of each"};
        place = &map;
    }
    if (!set[MapUse::Heights] && !set[MapUse::Normals])
        return Error{(maps.empty() ? "the set" : maps[0].name) +
                     std::string(": comes without heights; a set must have a height map or a normal map")};
    return set;
}

// The heights that a normal map tells, as a file of the scene.
Result<Heights> heightsFrom(const MapFile& map, Brought& files) {
    Result<Image> normals = decodeImage(map.bytes, map.name, Encoding::Linear);
    if (!normals) return normals.error();
    if (normals->channels >= 3 && greenPointsDown(*normals))
        for (std::size_t i = 1; i < normals->pixels.size(); i += std::size_t(normals->channels))
            normals->pixels[i] = 1 - normals->pixels[i];
    const Result<SourcedHeights> sourced = heightsOfNormals(*normals, map.name);
    if (!sourced) return sourced.error();
    const Image& image = *sourced->image;
    Heights heights = heightsOf(image, titleOf(map.name) + "_height.pfm");
    heights.scale = sourced->texelsPerHeight * heights.footprint.x / float(image.width);
    files.push_back({heights.file, encodePfm(image)});
    return heights;
}

Result<Heights> heightsOf(const Set& set, Brought& files) {
    const MapFile *heights = set[MapUse::Heights], *normals = set[MapUse::Normals];
    if (!heights) return heightsFrom(*normals, files);
    if (normals) warnOnce(normals->name + ": is left out; the heights come from " + heights->name);
    const auto image = decodeHeights(heights->bytes, heights->name);
    if (!image) return image.error();
    return heightsOf(**image, heights->name);
}

// The largest value of a picture of colours; 1 where there is none.
Result<float> brightestOf(const MapFile* map) {
    if (!map) return 1.0f;
    const auto image = decodeColors(map->bytes, map->name);
    if (!image) return image.error();
    const auto& pixels = (*image)->pixels;
    return std::max(*std::max_element(pixels.begin(), pixels.end()), 0.0f);
}

// What a relief sends back: at most diffuse where it is matt and specular where it is glossy.
struct Gloss {
    float diffuse = kDiffuse, specularity = kGloss, brightest = 1;
};

Result<Gloss> glossOf(const Set& set) {
    Gloss gloss;
    const MapFile *albedo = set[MapUse::Albedo], *specular = set[MapUse::Specular];
    if (albedo) gloss = {.diffuse = 1, .specularity = specular ? kGloss : 0};
    const Result<float> matt = brightestOf(albedo), shine = brightestOf(specular);
    if (!matt) return matt.error();
    if (!shine) return shine.error();
    gloss.brightest = (1 - gloss.specularity) * gloss.diffuse * *matt + gloss.specularity * *shine;
    gloss.brightest = std::max(gloss.brightest, 1e-3f); // a black picture stays black
    return gloss;
}

std::string reliefText(const std::string& title, const Set& set, const Heights& heights, const Gloss& gloss) {
    const vec2 frame = heights.footprint + kReliefAir, corner = kLampAcross * heights.footprint / 2.0f;
    JsonWriter json;
    json.beginObject().key("lucent").value(1).key("title").value(title);
    writeSize(json, frame);
    json.key("camera").beginObject().key("type").value("orthographic").key("height").value(frame.y);
    writeVector(json, "eye", {0, 0, heights.top() + kEyeAbove});
    json.end();
    writeExposure(json, gloss.brightest);
    json.key("environment").beginObject().key("source").value("sky").key("enabled").value(false).end();
    json.key("lights").beginArray().beginObject().key("type").value("point");
    writeVector(json, "position", {-corner.x, corner.y, heights.top() + kLampAbove});
    json.key("intensity").value(kPi).end().end(); // a white surface that faces it is 1

    json.key("objects").beginArray().beginObject().key("name").value(title);
    json.key("shape").beginObject().key("type").value("heightfield").key("heights").value(heights.file);
    json.key("width").value(heights.footprint.x).key("heightScale").value(heights.scale);
    if (const MapFile* alpha = set[MapUse::Alpha]) json.key("alpha").value(alpha->name);
    json.end().key("material").beginObject().key("kind").value("relief");
    const float grey[] = {gloss.diffuse, gloss.diffuse, gloss.diffuse};
    json.key("diffuse").value(std::span<const float>(grey)).key("specularity").value(gloss.specularity);
    if (const MapFile* albedo = set[MapUse::Albedo]) json.key("diffuseMap").value(albedo->name);
    if (const MapFile* specular = set[MapUse::Specular]) json.key("specularMap").value(specular->name);
    json.end().key("transform").beginObject();
    writeVector(json, "translate", {0, 0, heights.offset()});
    json.end().end().end().end();
    return json.text();
}

// --- models

// Chosen by eye: where the camera looks from, at what angle, where the lamp stands (in radii of the box), how
// large the ground is, its colour, and what part of a white surface's light comes from the sky.
constexpr vec3 kFromModel{0.4f, 0.5f, 1}, kLamp{-3, 4.5f, 1};
constexpr float kFov = 30, kModelAir = 1.08f, kGround = 30, kGroundColor = 0.5f, kSky = 0.3f;
constexpr float kLeastAspect = 0.75f, kMostAspect = 16.0f / 9, kWidest = 4; // the last of cameras of files
constexpr float kCausticRoom =
    2; // how much brighter than its surroundings a caustic may be before it is clipped

struct Bounds {
    vec3 low{std::numeric_limits<float>::infinity()}, high = -low;

    vec3 center() const { return (low + high) / 2.0f; }
    float radius() const { return glm::length(high - low) / 2; }
};

// Of everything that triangles use.
Bounds boundsOf(const Mesh& mesh) {
    Bounds bounds;
    for (const std::uint32_t index : mesh.indices) {
        bounds.low = glm::min(bounds.low, mesh.positions[index]);
        bounds.high = glm::max(bounds.high, mesh.positions[index]);
    }
    return bounds;
}

struct ModelView {
    vec3 eye, target, up;
    vec2 frame; // in any unit
    float fov = kFov;
    std::optional<float> height{}; // of an orthographic camera
};

// The camera looks at the middle of the box; each of its corners asks for a distance at which it still fits.
ModelView viewOf(const Bounds& bounds) {
    const vec3 back = glm::normalize(kFromModel), right = glm::normalize(glm::cross(vec3(0, 1, 0), back)),
               up = glm::cross(back, right);
    std::array<vec3, 8> corners{};
    vec2 reach(0);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const vec3 half = (bounds.high - bounds.low) / 2.0f;
        const vec3 corner = half * vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        corners[i] = {glm::dot(corner, right), glm::dot(corner, up), glm::dot(corner, back)};
        reach = glm::max(reach, glm::abs(vec2(corners[i])));
    }
    const float aspect = std::clamp(reach.x / std::max(reach.y, 1e-6f * reach.x), kLeastAspect, kMostAspect);
    const vec2 slope = std::tan(glm::radians(kFov / 2)) / kModelAir * vec2(aspect, 1);
    float distance = 0;
    for (const vec3 corner : corners) {
        const vec2 wanted = glm::abs(vec2(corner)) / slope;
        distance = std::max(distance, corner.z + std::max(wanted.x, wanted.y));
    }
    return {bounds.center() + distance * back, bounds.center(), {0, 1, 0}, {aspect, 1}};
}

// The target is as far as the middle of the model, so that turning the camera goes around that.
ModelView viewOf(const FileCamera& camera, const Bounds& bounds) {
    const float toMiddle = glm::dot(bounds.center() - camera.eye, camera.forward);
    const float distance = std::max(toMiddle, 0.1f * bounds.radius());
    const float aspect = camera.aspect > 0 ? std::clamp(camera.aspect, 1 / kWidest, kWidest) : 1;
    ModelView view{camera.eye, camera.eye + distance * camera.forward, camera.up, {aspect, 1}, camera.fov};
    if (!camera.perspective) view.height = camera.height;
    return view;
}

void writeCamera(JsonWriter& json, const ModelView& view) {
    json.key("camera").beginObject();
    if (view.height)
        json.key("type").value("orthographic").key("height").value(*view.height);
    else
        json.key("type").value("perspective").key("fov").value(view.fov);
    writeVector(json, "eye", view.eye);
    writeVector(json, "target", view.target);
    if (view.up != vec3(0, 1, 0)) writeVector(json, "up", view.up);
    json.end();
}

// Irradiance of what faces a lamp in the middle of the model, of its brightest colour.
float irradianceOf(const FileLight& light, vec3 middle) {
    const float whole = light.intensity * std::max({light.color.x, light.color.y, light.color.z});
    if (light.kind == FileLight::Kind::Distant) return whole;
    const vec3 away = middle - light.position;
    return whole / std::max(glm::dot(away, away), 1e-12f);
}

void writeLight(JsonWriter& json, const FileLight& light) {
    constexpr float kWidestSpot = 89.9f; // degrees
    constexpr const char* kTypes[] = {"point", "spot", "distant"};
    json.beginObject().key("type").value(kTypes[int(light.kind)]);
    if (light.kind != FileLight::Kind::Distant) writeVector(json, "position", light.position);
    if (light.kind != FileLight::Kind::Point) writeVector(json, "direction", light.direction);
    if (light.color != vec3(1)) writeVector(json, "color", light.color);
    json.key(light.kind == FileLight::Kind::Distant ? "irradiance" : "intensity").value(light.intensity);
    if (light.kind == FileLight::Kind::Point) json.key("falloff").value("inverse-square");
    if (light.kind == FileLight::Kind::Spot)
        json.key("innerAngle")
            .value(std::min(light.innerAngle, kWidestSpot))
            .key("outerAngle")
            .value(std::clamp(light.outerAngle, 0.1f, kWidestSpot));
    json.end();
}

// Lamps and sky; what a white surface that faces both sends, of all 1.
float writeLights(JsonWriter& json, const std::vector<FileLight>& lights, const Bounds& bounds) {
    float irradiance = 0;
    for (const FileLight& light : lights)
        irradiance += irradianceOf(light, bounds.center());
    const bool hasOwn = irradiance > 0;
    const float white = hasOwn ? irradiance / kPi / (1 - kSky) : 1;
    json.key("environment")
        .beginObject()
        .key("source")
        .value("sky")
        .key("intensity")
        .value(kSky * white)
        .end();
    json.key("lights").beginArray();
    for (const FileLight& light : lights)
        if (hasOwn) writeLight(json, light);
    if (!hasOwn) {
        json.beginObject().key("type").value("point");
        writeVector(json, "position", bounds.center() + bounds.radius() * kLamp);
        json.key("intensity")
            .value((1 - kSky) * kPi)
            .end(); // without falloff: E = intensity on what faces it
    }
    json.end();
    return white;
}

// What its brightest colour sends where a white surface sends `white`, and what shines by itself.
float brightestOf(const Mesh& mesh, float white) {
    float brightest = kGroundColor * white;
    const auto largest = [](vec3 color) { return std::max({color.x, color.y, color.z}); };
    if (mesh.parts.empty()) brightest = std::max(brightest, white * largest(Material().diffuse));
    for (const Mesh::Part& part : mesh.parts) {
        const Material& material = part.values;
        const bool throws = material.isRefractive() || material.isMirror();
        const float sent = throws                    ? kCausticRoom * kGroundColor
                           : material.isScattering() ? 1
                                                     : largest(material.diffuse);
        brightest = std::max(brightest, white * sent + largest(material.base));
    }
    return brightest;
}

void writeGround(JsonWriter& json, const Bounds& bounds) {
    const float side = kGround * bounds.radius(), size[] = {side, side};
    const float grey[] = {kGroundColor, kGroundColor, kGroundColor};
    json.beginObject().key("name").value("ground");
    json.key("shape").beginObject().key("type").value("plane");
    json.key("size").value(std::span<const float>(size)).end();
    json.key("material").beginObject().key("diffuse").value(std::span<const float>(grey)).end();
    json.key("transform").beginObject();
    const vec3 center = bounds.center(); // a little lower: two surfaces in one place would be drawn in turns
    writeVector(json, "translate", {center.x, bounds.low.y - 1e-3f * bounds.radius(), center.z});
    json.end().end();
}

// What is shown, and by what.
struct Model {
    std::string title;
    Bounds bounds;
    std::vector<FileLight> lights{};
    std::vector<FileCamera> cameras{};
    std::function<void(JsonWriter&)> writeThing;      // its shape and material
    std::function<float(float white)> brightestColor; // what that sends at most where white sends so much
};

std::string textOf(const Model& model) {
    const Bounds& bounds = model.bounds;
    const ModelView view = model.cameras.empty() ? viewOf(bounds) : viewOf(model.cameras[0], bounds);
    JsonWriter json;
    json.beginObject().key("lucent").value(1).key("title").value(model.title);
    writeSize(json, view.frame);
    writeCamera(json, view);
    const float white = writeLights(json, model.lights, bounds);
    writeExposure(json, model.brightestColor(white));

    json.key("objects").beginArray().beginObject();
    json.key("name").value(model.title == "ground" ? "model" : model.title);
    model.writeThing(json);
    json.end();
    writeGround(json, bounds);
    json.end().end();
    return json.text();
}

} // namespace

std::vector<std::optional<MapUse>> usesOf(std::span<const Output> pictures) {
    std::vector<std::optional<MapUse>> uses;
    bool hasColors = false;
    for (const Output& picture : pictures) {
        std::optional<MapUse>& use = uses.emplace_back(mapUseOf(picture.path));
        if (use) continue;
        const Result<Image> image = decodeImage(picture.bytes, picture.path, Encoding::Linear);
        if (!image) continue; // the scene says what is wrong
        if (holdsNormals(*image))
            use = MapUse::Normals;
        else
            hasColors = hasColors || holdsColors(*image);
    }
    const bool told = std::any_of(uses.begin(), uses.end(), [](const std::optional<MapUse>& use) {
        return use == MapUse::Heights || use == MapUse::Normals;
    });
    if (!told && !hasColors && std::count(uses.begin(), uses.end(), std::nullopt) == 1)
        *std::find(uses.begin(), uses.end(), std::nullopt) = MapUse::Heights;
    return uses;
}

Result<Brought> sceneOfMaps(std::span<const MapFile> maps) {
    const Result<Set> set = sorted(maps);
    if (!set) return set.error();
    Brought files(1);
    const Result<Heights> heights = heightsOf(*set, files);
    if (!heights) return heights.error();
    const Result<Gloss> gloss = glossOf(*set);
    if (!gloss) return gloss.error();
    const MapFile& main = *((*set)[MapUse::Heights] ? (*set)[MapUse::Heights] : (*set)[MapUse::Normals]);
    const std::string title = titleOf(main.name);
    files[0] = {title + ".json", toBytes(reliefText(title, *set, *heights, *gloss))};
    for (const MapFile& map : maps)
        if (map.use != MapUse::Normals) files.push_back({map.name, map.bytes});
    return files;
}

Result<Brought> sceneOfMesh(const std::string& name, std::span<const std::byte> bytes) {
    const Result<Mesh> mesh = decodeShape(bytes, name);
    if (!mesh) return mesh.error();
    const Bounds bounds = boundsOf(posed(*mesh, poseAt(mesh->rig, 0)));
    if (!(bounds.radius() > 0)) return Error{name + ": is a single point; must have some extent"};
    const std::string title = titleOf(name), file = title + ".mesh";
    const auto writeMesh = [&](JsonWriter& json) {
        json.key("shape").beginObject().key("type").value("mesh").key("source").value(file).end();
    };
    const auto brightest = [&](float white) { return brightestOf(*mesh, white); };
    const Model model{title, bounds, mesh->lights, mesh->cameras, writeMesh, brightest};
    return Brought{{title + ".json", toBytes(textOf(model))}, {file, Bytes(bytes.begin(), bytes.end())}};
}

Result<Brought> sceneOfTable(const std::string& name, std::span<const std::byte> bytes) {
    const auto table = decodeTable(bytes, name, TableForm::Merl, 0);
    if (!table) return table.error();
    const std::string title = titleOf(name), file = title + ".binary";
    const auto writeBall = [&](JsonWriter& json) {
        json.key("shape").beginObject().key("type").value("sphere").key("radius").value(1).end();
        json.key("material").beginObject().key("kind").value("measured").key("table").value(file).end();
    };
    const auto brightest = [](float white) { return white; };
    const Model model{
        .title = title, .bounds = {vec3(-1), vec3(1)}, .writeThing = writeBall, .brightestColor = brightest};
    return Brought{{title + ".json", toBytes(textOf(model))}, {file, Bytes(bytes.begin(), bytes.end())}};
}

} // namespace lucent::scene
