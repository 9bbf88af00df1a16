// lucent convert: a mesh, a normal map or any image becomes a map of heights; a mesh another kind of mesh
// file; files of a person a scene in a folder.
#include "cli/Bring.h"
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/ImageSize.h"
#include "base/Log.h"
#include "scene/HeightSource.h"
#include "scene/Mesh.h"
#include "scene/readers/Obj.h"
#include "scene/readers/Readers.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace lucent::cli {

namespace {
using scene::HeightSource;

struct ConvertOptions {
    std::vector<std::string> inputs;
    std::string input, output, size, rotate, margin, floorGap; ///< input: the first
    std::vector<std::string> allowed;
    bool normals = false;

    bool forMesh() const { return !(size.empty() && rotate.empty() && margin.empty() && floorGap.empty()); }
};

Result<HeightSource> sourceOf(const ConvertOptions& options, std::span<const std::byte> bytes) {
    HeightSource source;
    if (options.normals) source.kind = HeightSource::Kind::NormalMap;
    if (scene::isMesh(bytes)) source.kind = HeightSource::Kind::Mesh;
    if (source.kind == HeightSource::Kind::Mesh && options.normals)
        return Error{options.input + ": is a mesh; --normals takes an image"};
    if (source.kind != HeightSource::Kind::Mesh && options.forMesh())
        return Error{options.input + ": is no mesh; --size, --rotate, --margin and --floor-gap take a mesh"};

    if (!options.size.empty()) {
        const Result<ivec2> size = parseSize("--size", options.size, kMaxImageSide);
        if (!size) return size.error();
        source.resolution = *size;
    }
    const ParamTable& table = scene::heightSourceParams();
    if (Status read = readParam("--rotate", options.rotate, table, "meshRotate", &source.meshRotate); !read)
        return read.error();
    if (Status read = readParam("--margin", options.margin, table, "margin", &source.margin); !read)
        return read.error();
    if (Status read = readParam("--floor-gap", options.floorGap, table, "floorGap", &source.floorGap); !read)
        return read.error();
    return source;
}

std::string endingOf(const std::string& path) { return std::filesystem::path(path).extension().string(); }

// What a person wants to know of a mesh before light goes through it.
void describe(const std::string& path, const scene::Mesh& mesh, std::size_t open) {
    std::printf("%s: %zu vertices, %zu triangles, %s\n", path.c_str(), mesh.positions.size(),
                mesh.indices.size() / 3,
                open == 0 ? "closed" : (std::to_string(open) + " open edges").c_str());
    for (const scene::Mesh::Part& part : mesh.parts)
        std::printf("part \"%s\": %u triangles\n", part.material.c_str(), part.indexCount / 3);
    for (const auto& image : mesh.images)
        std::printf("texture: %d x %d texels\n", image->size.x, image->size.y);
    if (mesh.moves()) std::printf("moves for %g s\n", double(mesh.rig.duration));
}

Status convertMesh(const ConvertOptions& options) {
    if (options.normals || options.forMesh())
        return Error{options.output +
                     ": is a mesh; --normals, --size, --rotate, --margin and --floor-gap make heights"};
    if (Status possible = checkOutputs({options.output}, {options.input}); !possible) return possible;
    const Result<Bytes> bytes = scene::plainFiles(options.input, options.allowed)(options.input);
    if (!bytes) return bytes.error();
    const Result<scene::Mesh> mesh = scene::decodeMesh(*bytes, options.input);
    if (!mesh) return mesh.error();
    const scene::Mesh still = scene::posed(*mesh, scene::poseAt(mesh->rig, 0)); // OBJ knows no motion
    const bool isObj = endingOf(options.output) == ".obj";
    if (isObj && !mesh->images.empty())
        logInfo(options.output + ": is written without its textures; a .mesh keeps them");
    Bytes encoded = isObj ? scene::encodeObj(still) : *bytes;
    if (Status written = writeAll({{options.output, std::move(encoded)}}); !written) return written;
    describe(options.output, *mesh, scene::openEdges(still));
    return Done{};
}

Status convertFolder(const ConvertOptions& options) {
    if (options.normals || options.forMesh())
        return Error{options.output +
                     ": is a folder; --normals, --size, --rotate, --margin and --floor-gap make heights"};
    return bringInto(options.output, options.inputs, options.allowed);
}

Status convert(ConvertOptions options) {
    const std::string ending = endingOf(options.output);
    if (ending.empty()) return convertFolder(options);
    options.input = options.inputs.front();
    if (options.inputs.size() > 1)
        return Error{options.output + ": is to be made of " + std::to_string(options.inputs.size()) +
                     " files; several become a folder"};
    if (ending == ".mesh" || ending == ".obj") return convertMesh(options);
    if (Status known = checkImageEnding(options.output); !known) return known;
    if (ending == ".png")
        return Error{options.output +
                     ": 8-bit PNG would make terraces of the heights; must be .pfm, .exr or .hdr"};
    if (Status possible = checkOutputs({options.output}, {options.input}); !possible) return possible;
    const Result<Bytes> bytes = scene::plainFiles(options.input, options.allowed)(options.input);
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
    CLI::App* parser = program.add_subcommand(
        "convert", "Makes a height map from a mesh, a normal map or an image, another mesh file, or a scene");
    const auto options = std::make_shared<ConvertOptions>();
    parser
        ->add_option(
            "INPUT", options->inputs,
            "Mesh (.gltf, .glb, .obj, .mesh) or image (.png, .jpg, .hdr, .exr, .pfm); for a folder also "
            "several images that belong together, by what their names end in (_height, _normal, _albedo, "
            "_alpha, _specular), a light file of photographs (.lp: normals and colours by photometric "
            "stereo), a .ptm, or a .binary of the MERL database")
        ->required();
    addOutput(
        *parser, options->output,
        "Heights: .pfm, .exr or .hdr; a mesh: .mesh (all of it, read fastest) or .obj (its rest); without an "
        "ending a folder for a scene of the input with all files that it names");
    addAllow(*parser, options->allowed);
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
                   "  lucent convert bricks-normal.png -o bricks.exr --normals\n"
                   "  lucent convert fish.glb -o fish.mesh\n"
                   "  lucent convert coin_height.png coin_albedo.png -o coin && lucent render coin/coin.json "
                   "-o coin.png");
    return {parser, [options] { return convert(*options); }};
}

} // namespace lucent::cli
