#pragma once
/// What the commands read and write, and the options they share.

#include "base/File.h"
#include "base/Image.h"
#include "base/Output.h"
#include "base/Result.h"
#include "scene/Scene.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lucent::cli {

/// The scene of a command and what its options change in it.
struct SceneOptions {
    std::string path;
    std::string size;                 ///< "WxH"; empty: the scene's own
    std::vector<std::string> sets;    ///< "KEY=VALUE"
    std::string aov;                  ///< empty: what the scene shows
    std::vector<std::string> allowed; ///< folders that it may read beside its own

    void addTo(CLI::App& parser);
    void addAovTo(CLI::App& parser, const std::string& help);
    /// Loads the scene and applies the options to it.
    Result<scene::Scene> load() const;
    /// The scene's file and all that it names, for checkNotRead(). Error when it cannot be read.
    Result<std::vector<std::string>> files() const;
};

/// Reads an option by the declaration of the parameter that it sets; "" leaves the value alone. Error
/// "OPTION: is TEXT; must be ..."
Status readParam(const std::string& option, const std::string& text, const ParamTable& table,
                 std::string_view id, void* value);

/// For integer options: "is TEXT; must be an integer in [LOW, HIGH]", to which CLI11 adds the option's name.
CLI::Validator integerIn(std::int64_t low, std::int64_t high);

/// Tells on stderr what a scene asks for and no picture of its light shows, one line each.
void tellNotDrawn(const scene::Scene& scene);

/// "512x256" as pixels. Error "OPTION: is TEXT; must be ..."
Result<ivec2> parseSize(const std::string& option, const std::string& text, int largest);

/// Adds --allow.
void addAllow(CLI::App& parser, std::vector<std::string>& folders);

/// Adds -o/--output.
void addOutput(CLI::App& parser, std::string& path, const std::string& help);

/// Refuses an output whose ending is that of no image.
Status checkImageEnding(const std::string& path);

/// Refuses what could not be written after hours of work: the folders of all outputs must be there, what they
/// replace must be regular files, no two may be one, and none may be a file that the command reads. "" stands
/// for no file.
Status checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Encodes by the ending of `path`: .exr as well as what encodeImage() knows. Error for values that are not
/// finite.
Result<Bytes> encode(const Image& image, const std::string& path);

/// Writes all of them, or none when one fails.
Status writeAll(const std::vector<Output>& outputs);

/// Text as the content of a file.
Bytes toBytes(const std::string& text);

/// Decodes any image file, EXR included.
Result<Image> readImage(const std::string& path, Encoding encoding);

} // namespace lucent::cli
