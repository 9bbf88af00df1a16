#include "scene/MapUse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace lucent::scene {
namespace {

constexpr std::string_view kNames[] = {"height", "normal", "albedo", "alpha", "specular"};

constexpr std::pair<std::string_view, MapUse> kWords[] = {
    {"height", MapUse::Heights},       {"heights", MapUse::Heights}, {"heightmap", MapUse::Heights},
    {"displacement", MapUse::Heights}, {"disp", MapUse::Heights},    {"bump", MapUse::Heights},
    {"normal", MapUse::Normals},       {"normals", MapUse::Normals}, {"normalmap", MapUse::Normals},
    {"albedo", MapUse::Albedo},        {"color", MapUse::Albedo},    {"colour", MapUse::Albedo},
    {"basecolor", MapUse::Albedo},     {"diffuse", MapUse::Albedo},  {"alpha", MapUse::Alpha},
    {"opacity", MapUse::Alpha},        {"mask", MapUse::Alpha},      {"specular", MapUse::Specular},
    {"spec", MapUse::Specular}};

std::string_view stemOf(std::string_view path) {
    const std::string_view file = path.substr(path.find_last_of('/') + 1);
    return file.substr(0, file.find_last_of('.'));
}

// Where the last part of a stem begins, behind its separator; 0: it is the only one.
std::size_t lastPart(std::string_view stem) { return stem.find_last_of("_-. ") + 1; }

std::optional<MapUse> useOfWord(std::string_view word) {
    std::string lower(word);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
    const auto found = std::find_if(std::begin(kWords), std::end(kWords),
                                    [&](const auto& known) { return known.first == lower; });
    return found == std::end(kWords) ? std::nullopt : std::optional(found->second);
}

dvec3 normalAt(const Image& image, int x, int y) {
    const float* texel = image.at(x, y);
    return 2.0 * dvec3(texel[0], texel[1], texel[2]) - 1.0;
}

} // namespace

std::span<const std::string_view> mapUseNames() { return kNames; }

std::optional<MapUse> mapUseNamed(std::string_view name) {
    const auto found = std::find(std::begin(kNames), std::end(kNames), name);
    return found == std::end(kNames) ? std::nullopt : std::optional(MapUse(found - std::begin(kNames)));
}

std::optional<MapUse> mapUseOf(std::string_view path) {
    const std::string_view stem = stemOf(path);
    return useOfWord(stem.substr(lastPart(stem)));
}

std::string titleOf(std::string_view path) {
    std::string_view stem = stemOf(path);
    if (const std::size_t part = lastPart(stem); part > 1 && mapUseOf(path)) stem = stem.substr(0, part - 1);
    std::string title(stem);
    std::replace(title.begin(), title.end(), '.', '-');
    return title.empty() ? "scene" : title;
}

bool holdsNormals(const Image& image) {
    if (image.channels < 3) return false;
    std::size_t unit = 0;
    dvec3 sum(0);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const dvec3 n = normalAt(image, x, y);
            unit += n.z > 0 && std::abs(glm::length(n) - 1) < 0.1;
            sum += n;
        }
    const std::size_t texels = std::size_t(image.width) * std::size_t(image.height);
    return 64 * unit >= 63 * texels && sum.z >= std::cos(glm::radians(30.0)) * glm::length(sum);
}

bool holdsColors(const Image& image) {
    if (image.channels < 3) return false;
    constexpr float kGrey = 8.0f / 255;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const auto [least, most] = std::minmax({image.at(x, y)[0], image.at(x, y)[1], image.at(x, y)[2]});
            if (most - least > kGrey) return true;
        }
    return false;
}

bool greenPointsDown(const Image& normals) {
    const auto slopes = [&](int x, int y) {
        const dvec3 n = normalAt(normals, x, y);
        return n.z > 0 ? dvec2(n) / -n.z : dvec2(0);
    };
    double up = 0, down = 0;
    for (int y = 0; y + 1 < normals.height; ++y)
        for (int x = 0; x + 1 < normals.width; ++x) {
            // Rows run downwards: dp/dy is the row above less the one below, both means of two columns.
            const dvec2 a = slopes(x, y), b = slopes(x + 1, y), c = slopes(x, y + 1),
                        d = slopes(x + 1, y + 1);
            const double pAlongY = a.x + b.x - c.x - d.x, qAlongX = b.y + d.y - a.y - c.y;
            up += (pAlongY - qAlongX) * (pAlongY - qAlongX);
            down += (pAlongY + qAlongX) * (pAlongY + qAlongX);
        }
    return down < 0.5 * up; // rounding to 8 bits leaves about as much of both where nothing slopes
}

} // namespace lucent::scene
