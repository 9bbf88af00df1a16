// lucent convert: a mesh, a normal map or any image becomes a map of heights.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/ImageSize.h"
#include "scene/HeightSource.h"
#include "scene/readers/Readers.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string_view>

namespace lucent::cli {

namespace {
using scene::HeightSource;

struct ConvertOptions {
    std::string input, output, size, rotate, margin, floorGap;
    bool normals = false;

    bool forMesh() const { return !(size.empty() && rotate.empty() && margin.empty() && floorGap.empty()); }
};

/// Readers turn every mesh into the plain form, which starts with these letters (scene/Mesh.h).
bool isMesh(std::span<const std::byte> bytes) {
    constexpr std::string_view kMagic = "LUCENTM1";
    return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

/// Reads an option by the declaration of the scene file's parameter of the same meaning.
template <class Value>
Status readParam(const std::string& option, const std::string& text, std::string_view id, Value& value) {
    if (text.empty()) return Done{};
    const auto params = scene::heightSourceParams().params;
    const auto param = std::find_if(params.begin(), params.end(), [&](const Param& p) { return p.id == id; });
    const Status set = setText(*param, &value, text);
    return set ? set : Status(Error{option + ": " + set.error().message});
}

Result<HeightSource> sourceOf(const ConvertOptions& options, std::span<const std::byte> bytes) {
    HeightSource source;
    if (options.normals) source.kind = HeightSource::Kind::NormalMap;
    if (isMesh(bytes)) source.kind = HeightSource::Kind::Mesh;
    if (source.kind == HeightSource::Kind::Mesh && options.normals)
        return Error{options.input + ": is a mesh; --normals takes an image"};
    if (source.kind != HeightSource::Kind::Mesh && options.forMesh())
        return Error{options.input + ": is no mesh; --size, --rotate, --margin and --floor-gap take a mesh"};

    if (!options.size.empty()) {
        const Result<ivec2> size = parseSize("--size", options.size, kMaxImageSide);
        if (!size) return size.error();
        source.resolution = *size;
    }
    if (Status read = readParam("--rotate", options.rotate, "meshRotate", source.meshRotate); !read)
        return read.error();
    if (Status read = readParam("--margin", options.margin, "margin", source.margin); !read)
        return read.error();
    if (Status read = readParam("--floor-gap", options.floorGap, "floorGap", source.floorGap); !read)
        return read.error();
    return source;
}

Status convert(const ConvertOptions& options) {
    if (Status possible = checkImageOutput(options.output); !possible) return possible;
    if (std::filesystem::path(options.output).extension() == ".png")
        return Error{options.output +
                     ": 8-bit PNG would make terraces of the heights; must be .pfm, .exr or .hdr"};
    const Result<Bytes> bytes = scene::plainFiles()(options.input);
    if (!bytes) return bytes.error();
    const Result<HeightSource> source = sourceOf(options, *bytes);
    if (!source) return source.error();
    const Result<scene::SourcedHeights> heights = scene::loadHeights(*source, *bytes, options.input);
    if (!heights) return heights.error();
    Result<Bytes> encoded = encode(*heights->image, options.output);
    if (!encoded) return encoded.error();
    if (Status written = writeAll({{options.output, std::move(*encoded)}}); !written) return written;

    const Image& image = *heights->image;
    std::printf("%s: %d x %d heights\n", options.output.c_str(), image.width, image.height);
    if (heights->texelsPerHeight > 0)
        std::printf("true slopes: heightScale = %g for a width of 1 m\n",
                    double(heights->texelsPerHeight) / image.width);
    return Done{};
}
} // namespace

Command addConvert(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("convert", "Makes a height map from a mesh, a normal map or an image");
    const auto options = std::make_shared<ConvertOptions>();
    parser->add_option("INPUT", options->input, "Mesh (.gltf, .glb) or image (.png, .jpg, .hdr, .exr, .pfm)")
        ->required();
    addOutput(*parser, options->output, "Heights: .pfm, .exr or .hdr");
    parser->add_flag("--normals", options->normals,
                     "The image is a normal map: integrates it by least squares");
    parser->add_option("--size", options->size, "Mesh: texels of the height map [512x512]")->type_name("WxH");
    parser->add_option("--rotate", options->rotate, "Mesh: degrees about the x, y and z axes [0,0,0]")
        ->type_name("X,Y,Z");
    parser
        ->add_option("--margin", options->margin,
                     "Mesh: free space around it, part of the larger side [0.04]")
        ->type_name("M");
    parser->add_option("--floor-gap", options->floorGap, "Mesh: height of its farthest visible point [0.12]")
        ->type_name("G");
    parser->footer("Examples:\n"
                   "  lucent convert dragon.glb -o dragon.pfm --size 1024x768 --rotate 0,-20,0\n"
                   "  lucent convert bricks-normal.png -o bricks.exr --normals");
    return {parser, [options] { return convert(*options); }};
}

} // namespace lucent::cli
