#include "cli/Files.h"

#include "base/Archive.h"
#include "base/Text.h"
#include "frame/Renderer.h"
#include "scene/Keys.h"
#include "scene/Load.h"
#include "scene/readers/Readers.h"
#include "technique/Technique.h"
#include "views/SurfaceKey.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace lucent::cli {

namespace fs = std::filesystem;

void SceneOptions::addTo(CLI::App& parser) {
    parser.add_option("SCENE", path, "Scene file (JSON), or a zip archive of one with its files")->required();
    parser.add_option("--size", size, "Size of the picture in pixels, WxH; else the scene's own")
        ->type_name("WxH");
    parser
        .add_option("--set", sets,
                    "Changes a parameter of the scene; lucent list names them. May be repeated")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
    addAllow(parser, allowed);
}

void SceneOptions::addAovTo(CLI::App& parser, const std::string& help) {
    parser.add_option("--aov", aov, help)->type_name("NAME");
}

namespace {
Status applySet(scene::Scene& scene, const std::string& text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos) return Error{"--set: is " + inQuotes(text) + "; must be KEY=VALUE"};
    const Status set = setParam(scene, text.substr(0, equals), text.substr(equals + 1));
    return set ? set : Status(Error{"--set: " + set.error().message});
}

Result<scene::Aov> parseAov(const std::string& text) {
    const auto names = scene::aovNames();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found != names.end()) return scene::Aov(found - names.begin());
    std::string known;
    for (const std::string_view name : names)
        known += (known.empty() ? "" : ", ") + std::string(name);
    return Error{"--aov: is " + inQuotes(text) + "; must be one of " + known};
}
} // namespace

Result<scene::Scene> SceneOptions::load() const {
    const Result<scene::SceneSource> source = scene::sceneSource(path, allowed);
    if (!source) return source.error();
    Result<scene::Scene> scene = scene::load(source->path, source->read, technique::tables());
    if (!scene) return scene;
    for (const std::string& set : sets)
        if (Status applied = applySet(*scene, set); !applied) return applied.error();
    if (!size.empty()) {
        const Result<ivec2> pixels = parseSize("--size", size, scene::kMaxPictureSide);
        if (!pixels) return pixels.error();
        scene->size = *pixels;
    }
    if (!aov.empty()) {
        const Result<scene::Aov> shown = parseAov(aov);
        if (!shown) return shown.error();
        scene->view.show = *shown;
    }
    return scene;
}

Result<std::vector<std::string>> SceneOptions::files() const {
    if (isArchive(path)) return std::vector{path};
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) return bytes.error();
    Result<std::vector<std::string>> files = scene::dependencies(path, *bytes);
    if (files) files->push_back(path);
    return files;
}

Status readParam(const std::string& option, const std::string& text, const ParamTable& table,
                 std::string_view id, void* value) {
    if (text.empty()) return Done{};
    const auto param = std::find_if(table.params.begin(), table.params.end(),
                                    [&](const Param& one) { return one.id == id; });
    const Status set = setText(*param, value, text);
    return set ? set : Status(Error{option + ": " + set.error().message});
}

CLI::Validator integerIn(std::int64_t low, std::int64_t high) {
    const auto check = [low, high](const std::string& text) {
        char* end = nullptr;
        errno = 0;
        const std::int64_t value = std::strtoll(text.c_str(), &end, 10);
        if (!text.empty() && *end == 0 && errno == 0 && low <= value && value <= high) return std::string();
        return "is " + inQuotes(text) + "; must be an integer in [" + std::to_string(low) + ", " +
               std::to_string(high) + "]";
    };
    return CLI::Validator(check, "in [" + std::to_string(low) + ", " + std::to_string(high) + "]");
}

Result<ivec2> parseSize(const std::string& option, const std::string& text, int largest) {
    char* end = nullptr;
    const long width = std::strtol(text.c_str(), &end, 10);
    const long height = *end == 'x' ? std::strtol(end + 1, &end, 10) : 0;
    if (*end != 0 || width < 1 || height < 1 || width > largest || height > largest)
        return Error{option + ": is " + inQuotes(text) + "; must be WIDTHxHEIGHT, each from 1 to " +
                     std::to_string(largest)};
    return ivec2(int(width), int(height));
}

void addAllow(CLI::App& parser, std::vector<std::string>& folders) {
    parser
        .add_option("--allow", folders,
                    "Folder beneath which files may be read that the input names, beside its own. May be "
                    "repeated")
        ->type_name("DIR")
        ->check(CLI::Validator(CLI::ExistingDirectory).description(""))
        ->allow_extra_args(false);
}

void addOutput(CLI::App& parser, std::string& path, const std::string& help) {
    parser
        .add_option("-o,--output", path,
                    help + ". Replaces regular files only; all files of a command are written or none")
        ->required()
        ->type_name("FILE");
}

Status checkImageEnding(const std::string& path) {
    const std::string ending = fs::path(path).extension().string();
    if (ending == ".png" || ending == ".hdr" || ending == ".exr" || ending == ".pfm") return Done{};
    return Error{path + ": ends in no known image type; must be .png, .hdr, .exr or .pfm"};
}

namespace {
Status checkFolder(const std::string& path) {
    std::error_code ignored;
    const fs::path folder = fs::path(path).parent_path();
    if (folder.empty() || fs::is_directory(folder, ignored)) return Done{};
    return Error{path + ": cannot be written, " + folder.string() +
                 " is no folder; must be in an existing one"};
}

Status checkNotRead(const std::string& output, const std::vector<std::string>& inputs) {
    std::error_code ignored; // where either is missing they are not the same
    for (const std::string& input : inputs)
        if (fs::equivalent(output, input, ignored))
            return Error{output + ": is read as well; must be another file than " + input};
    return Done{};
}
} // namespace

Status checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    for (const std::string& output : outputs) {
        if (Status possible = checkFolder(output); !possible) return possible;
        if (Status apart = checkNotRead(output, inputs); !apart) return apart;
    }
    return lucent::checkOutputs(outputs);
}

void tellNotDrawn(const scene::Scene& scene) {
    if (views::isGeometric(scene.view.show)) return;
    for (const std::string& line : technique::notDrawn(scene))
        std::fprintf(stderr, "lucent: not drawn: %s\n", line.c_str());
}

Result<Bytes> encode(const Image& image, const std::string& path) {
    if (const ivec2 bad = findNonFinite(image); bad.x >= 0)
        return Error{path + ": the picture is NaN or infinite at pixel (" + std::to_string(bad.x) + ", " +
                     std::to_string(bad.y) + "); must be finite everywhere"};
    return fs::path(path).extension() == ".exr" ? scene::encodeExr(image) : encodeImage(image, path);
}

Status writeAll(const std::vector<Output>& outputs) { return writeFiles(outputs); }

Bytes toBytes(const std::string& text) {
    const auto* first = reinterpret_cast<const std::byte*>(text.data());
    return Bytes(first, first + text.size());
}

Result<Image> readImage(const std::string& path, Encoding encoding) {
    Result<Bytes> bytes = scene::plainFiles(path)(path);
    if (!bytes) return bytes.error();
    return decodeImage(*bytes, path, encoding);
}

} // namespace lucent::cli
