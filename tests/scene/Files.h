#pragma once
/// Files in memory for loader tests, and a technique of our own.

#include "base/File.h"
#include "base/Image.h"
#include "base/Param.h"
#include "scene/Load.h"

#include <map>
#include <string>

namespace lucent::test {

/// What a scene finds beside it; anything else cannot be read.
struct Files {
    std::map<std::string, Bytes> content;

    void put(const std::string& path, std::string_view text) {
        const auto* begin = reinterpret_cast<const std::byte*>(text.data());
        content[path] = Bytes(begin, begin + text.size());
    }
    void put(const std::string& path, const Image& image) { content[path] = *encodeImage(image, path); }
    ReadFile reader() const {
        return [this](const std::string& path) -> Result<Bytes> {
            const auto found = content.find(path);
            if (found == content.end()) return Error{path + ": cannot be read (no such file)"};
            return found->second;
        };
    }
};

enum class Method : int { Plain, Fancy };
inline constexpr std::string_view kMethods[] = {"plain", "fancy"};

/// Settings of a technique that exists only here.
struct Demo {
    Method method = Method::Fancy;
    int steps = 64;
};

inline const ParamTable& demoParams() {
    static const Param params[] = {
        declare(
            &Demo::method,
            {.id = "method", .label = "Method", .group = Group::View, .doc = "How.", .choices = kMethods}),
        declare(&Demo::steps, {.id = "steps",
                               .label = "Steps",
                               .min = 1,
                               .max = 4096,
                               .low = 1,
                               .high = 256,
                               .doc = "How many."}),
    };
    static const ParamTable table = tableOf<Demo>("demo", params);
    return table;
}
inline const ParamTable* const kTechniques[] = {&demoParams()};

/// 4 x 2 texels, all different.
inline Image smallHeights() {
    Image image(4, 2, 1);
    for (std::size_t i = 0; i < 8; ++i)
        image.pixels[i] = float(i) / 8;
    return image;
}

/// Loads `json` as scenes/a.json beside `files`.
inline Result<scene::Scene> load(Files files, std::string_view json) {
    files.put("scenes/a.json", json);
    if (!files.content.contains("scenes/h.pfm")) files.put("scenes/h.pfm", smallHeights());
    return scene::load("scenes/a.json", files.reader(), kTechniques);
}

} // namespace lucent::test
