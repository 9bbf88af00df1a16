// Scenes made from a mesh that a person hands over.
#include "base/JsonWriter.h"
#include "scene/Load.h"
#include "scene/Mesh.h"

#include <cmath>
#include <limits>

namespace lucent::scene {
namespace {

// Chosen by eye: where the camera and the lamp stand, and how much air is left around the mesh.
constexpr vec3 kFromTarget{0.5f, 0.35f, 1}, kLampDirection{0.4f, -1, -0.6f};
constexpr float kAir = 1.05f, kFov = 40; // degrees

struct Ball {
    vec3 center;
    float radius;
};

// Around the box of everything that triangles use.
Ball ballAround(const Mesh& mesh) {
    vec3 low(std::numeric_limits<float>::infinity()), high = -low;
    for (const std::uint32_t index : mesh.indices) {
        low = glm::min(low, mesh.positions[index]);
        high = glm::max(high, mesh.positions[index]);
    }
    return {(low + high) / 2.0f, glm::length(high - low) / 2};
}

void writeVector(JsonWriter& json, std::string_view key, vec3 value) {
    const float numbers[] = {value.x, value.y, value.z};
    json.key(key).value(std::span<const float>(numbers));
}

// The scene as a file: the loader then reads materials and checks everything as it does for others.
std::string sceneText(const std::string& name, const Ball& ball) {
    const float distance = kAir * ball.radius / std::sin(glm::radians(kFov / 2));
    JsonWriter json;
    json.beginObject().key("lucent").value(1).key("title").value(name);
    json.key("camera").beginObject().key("type").value("perspective").key("fov").value(kFov);
    writeVector(json, "eye", ball.center + distance * glm::normalize(kFromTarget));
    writeVector(json, "target", ball.center);
    json.end().key("environment").beginObject().key("source").value("sky").end();
    json.key("lights").beginArray().beginObject().key("type").value("distant");
    writeVector(json, "direction", kLampDirection);
    json.key("irradiance").value(kPi).end().end(); // a white surface that faces it is 1
    json.key("objects").beginArray().beginObject().key("name").value("mesh");
    json.key("shape").beginObject().key("type").value("mesh").key("source").value(name).end().end().end();
    return json.end().text();
}

} // namespace

Result<Scene> sceneFromMesh(const std::string& name, std::span<const std::byte> bytes,
                            std::span<const ParamTable* const> techniques) {
    const Result<Mesh> mesh = decodeMesh(bytes, name);
    if (!mesh) return mesh.error();
    const Ball ball = ballAround(posed(*mesh, poseAt(mesh->rig, 0)));
    if (ball.radius == 0) return Error{name + ": is a single point; must have some extent"};
    const std::string path = name + ".json", text = sceneText(name, ball);
    const ReadFile read = [&](const std::string& file) -> Result<Bytes> {
        const auto content = file == path ? std::as_bytes(std::span(text)) : bytes;
        return Bytes(content.begin(), content.end());
    };
    return load(path, read, techniques);
}

} // namespace lucent::scene
