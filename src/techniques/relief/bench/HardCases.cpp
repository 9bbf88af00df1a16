#include "techniques/relief/bench/Bench.h"

#include "base/Pfm.h"
#include "scene/Load.h"
#include "technique/Technique.h"

#include <cmath>
#include <functional>
#include <limits>

namespace lucent::relief {

namespace {

using namespace measure;
using HeightAt = std::function<float(int, int)>;

float waves(float u, float v) {
    return 0.5f + 0.22f * std::sin(19 * u + 3 * v) + 0.16f * std::sin(31 * v - 11 * u + 1) +
           0.1f * std::sin(57 * u + 49 * v + 2);
}
HeightAt wavesOn(int size) {
    return [size](int x, int y) { return waves(float(x) / float(size), float(y) / float(size)); };
}

scene::DistantLight sun(double elevationDegrees) {
    const double e = glm::radians(elevationDegrees), azimuth = glm::radians(33.0);
    scene::DistantLight light;
    light.direction =
        -vec3(dvec3(std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e)));
    return light;
}

struct Field {
    ivec2 size{48, 48};
    HeightAt height = wavesOn(48);
    float heightScale = 0.2f, depth = 0.03f;
};

MakeScene sceneOf(const Field& field, const scene::Light& light, ivec2 pixels) {
    return {[=]() -> Result<scene::Scene> {
                scene::Scene scene = fieldScene(
                    {"field", heightsOf(field.size, field.height), field.heightScale}, field.depth);
                scene.size = pixels;
                scene.lights.push_back(light);
                return scene;
            },
            double(pixels.x) * pixels.y};
}
MakeScene sceneOf(const Field& field, const scene::Light& light) { return sceneOf(field, light, field.size); }

scene::Light lamp(vec3 place) {
    scene::PointLight light;
    light.position = place;
    return light;
}

Bytes bytesOf(const std::string& text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return Bytes(first, first + text.size());
}

// A scene file whose height map holds one bad number: the loader must name its place.
MakeScene badTexel(float value) {
    return {[value] {
        Image map = *heightsOf({8, 8}, wavesOn(8));
        *map.at(5, 2) = value;
        const Bytes scene = bytesOf(R"({ "lucent": 1, "objects": [ { "name": "field",
            "shape": { "type": "heightfield", "heights": "heights.pfm" } } ] })");
        const Bytes file = encodePfm(map);
        const auto read = [&](const std::string& path) -> Result<Bytes> {
            return path == "heights.pfm" ? file : scene;
        };
        return scene::load("scene.json", read, technique::tables());
    }};
}

// 8-bit heights, judged by the exact solution of what they were rounded from.
HardCase terraces() {
    Field original, rounded;
    rounded.height = [height = original.height](int x, int y) {
        return std::round(height(x, y) * 255) / 255;
    };
    return {"8-bit terraces against the original", sceneOf(rounded, sun(30)), sceneOf(original, sun(30))};
}

} // namespace

std::vector<HardCase> hardCases(bool quick) {
    const HeightAt cliff = [](int x, int) { return x < 24 ? 1.0f : 0.0f; };
    const HeightAt spikes = [](int x, int y) { return x % 8 == 3 && y % 8 == 5 ? 1.0f : 0.0f; };
    const HeightAt steps = [](int x, int y) { return float((x * 7 + y * 3) % 11) / 11; };
    const HeightAt constant = [](int, int) { return 0.7f; };
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();

    std::vector<HardCase> cases{
        {"light at elevation 0", sceneOf({}, sun(0)), {}},
        {"light at elevation 0.1 degrees", sceneOf({}, sun(0.1)), {}},
        {"light under the field", sceneOf({}, sun(-30)), {}},
        {"lamp exactly over a texel", sceneOf({}, lamp({0.5f / 48, 0.5f / 48, 2})), {}},
        {"lamp inside the solid", sceneOf({}, lamp({0, 0, 0.02f})), {}},
        {"lamp 1e-4 from the origin", sceneOf({}, lamp({1e-4f, 0, 1e-4f})), {}},
        {"lamp 1e6 away", sceneOf({}, lamp({3e5f, -4e5f, 1e6f})), {}},
        {"depth 1e-6", sceneOf({.depth = 1e-6f}, sun(30)), {}},
        {"depth 10", sceneOf({.depth = 10}, sun(30)), {}},
        {"cliff", sceneOf({.height = cliff, .heightScale = 0.5f}, sun(20)), {}},
        {"single-texel spikes", sceneOf({.height = spikes, .heightScale = 0.4f}, sun(20)), {}},
        {"constant field", sceneOf({.height = constant}, sun(30)), {}},
        {"1 x 1 texel", sceneOf({{1, 1}, constant, 0.3f, 0.2f}, sun(30), {16, 16}), {}},
        {"1 x 33 texels", sceneOf({{1, 33}, steps, 3, 0.5f}, sun(30)), {}},
        {"33 x 1 texels", sceneOf({{33, 1}, steps, 0.1f, 0.05f}, sun(30)), {}},
        {"37 x 23 texels", sceneOf({{37, 23}, steps, 0.1f, 0.05f}, sun(30)), {}},
        terraces(),
        {"height scale 0", sceneOf({.height = steps, .heightScale = 0}, sun(30)), {}},
        {"height scale 1e4", sceneOf({.height = steps, .heightScale = 1e4f, .depth = 10}, sun(30)), {}},
        {"a texel that is NaN", badTexel(kNaN), {}},
        {"a texel that is infinite", badTexel(kInfinity), {}},
    };
    if (!quick)
        cases.push_back({"4096 x 4096 texels",
                         sceneOf({{4096, 4096}, wavesOn(64), 0.02f, 0.004f}, sun(15), {64, 64}),
                         {}});
    return cases;
}

} // namespace lucent::relief
