#pragma once
/// What the commands read and write, and the options they share.

#include "base/File.h"
#include "base/Image.h"
#include "base/Result.h"
#include "scene/Scene.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace lucent::cli {

/// The scene of a command and what its options change in it.
struct SceneOptions {
    std::string path;
    std::string size;              ///< "WxH"; empty: the scene's own
    std::vector<std::string> sets; ///< "KEY=VALUE"
    std::string aov;               ///< empty: what the scene shows

    void addTo(CLI::App& parser);
    void addAovTo(CLI::App& parser, const std::string& help);
    /// Loads the scene and applies the options to it.
    Result<scene::Scene> load() const;
};

/// "512x256" as pixels. Error "OPTION: is TEXT; must be ..."
Result<ivec2> parseSize(const std::string& option, const std::string& text, int largest);

/// Adds -o/--output.
void addOutput(CLI::App& parser, std::string& path, const std::string& help);

/// Refuses a path that could not be written after hours of work: its folder must be there.
Status checkFolder(const std::string& path);

/// The same for an image, whose ending must be known as well.
Status checkImageOutput(const std::string& path);

/// Encodes by the ending of `path`: .exr as well as what encodeImage() knows.
Result<Bytes> encode(const Image& image, const std::string& path);

/// A file to write.
struct Output {
    std::string path;
    Bytes bytes;
};
/// Writes all of them, or none when one fails.
Status writeAll(const std::vector<Output>& outputs);

/// Text as the content of a file.
Bytes toBytes(const std::string& text);

/// Decodes any image file, EXR included.
Result<Image> readImage(const std::string& path, Encoding encoding);

} // namespace lucent::cli
