#include "scene/Environment.h"

#include "scene/ImageUse.h"
#include "scene/Load.h"

#include <algorithm>
#include <cmath>

namespace lucent::scene {
namespace {

constexpr std::string_view kNames[] = {"rainbow", "sky", "uniform", "direction"};
constexpr int kWidth = 256, kHeight = 128;

// Unit direction of a texel's centre.
vec3 directionOf(int x, int y) {
    const float azimuth = ((float(x) + 0.5f) / kWidth - 0.5f) * 2 * kPi; // 0 at -z, growing towards +x
    const float polar = (float(y) + 0.5f) / kHeight * kPi;               // 0 at +y
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)};
}

// Full saturation and value: each channel is a trapezoid over the hue, a third of the circle apart.
vec3 rainbow(vec3 d) {
    const float hue = std::atan2(d.x, -d.z) / (2 * kPi); // turns
    const auto channel = [&](float peak) {
        const float turns = hue - peak;
        const float distance =
            std::abs(turns - std::round(turns)); // [0, 1/2] turns from the channel's own hue
        return std::clamp(2 - 6 * distance, 0.0f, 1.0f);
    };
    return {channel(0), channel(1 / 3.0f), channel(2 / 3.0f)};
}

vec3 sky(vec3 d) {
    const vec3 horizon(0.9f, 0.95f, 1.0f), zenith(0.15f, 0.35f, 0.8f), ground(0.2f, 0.17f, 0.14f);
    return d.y < 0 ? ground : glm::mix(horizon, zenith, std::sqrt(d.y));
}

vec3 radiance(std::string_view name, vec3 d) {
    if (name == "rainbow") return rainbow(d);
    if (name == "sky") return sky(d);
    return name == "direction" ? 0.5f + 0.5f * d : vec3(1);
}

} // namespace

std::span<const std::string_view> proceduralEnvironments() { return kNames; }

Image proceduralEnvironment(std::string_view name) {
    Image map(kWidth, kHeight, 3);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const vec3 value = radiance(name, directionOf(x, y));
            std::copy_n(&value.x, 3, map.at(x, y));
        }
    return map;
}

Result<std::shared_ptr<const Image>> loadEnvironmentMap(const std::string& source,
                                                        std::span<const std::byte> bytes) {
    if (std::find(std::begin(kNames), std::end(kNames), source) != std::end(kNames))
        return std::shared_ptr<const Image>(std::make_shared<Image>(proceduralEnvironment(source)));
    return decodeColors(bytes, source);
}

} // namespace lucent::scene
