// lucent paint: strokes of a script become maps on an object of a scene.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/Archive.h"
#include "base/Text.h"
#include "scene/Load.h"
#include "scene/Painting.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace lucent::cli {

namespace {

namespace fs = std::filesystem;

struct PaintOptions {
    SceneOptions scene;
    std::string strokes, object, output, entering, leaving;
    int side = 0; // 0: as large as what is painted already, else the default
};

// The object of that name, or the only one whose material scatters.
Result<scene::Object*> objectOf(const PaintOptions& options, scene::Scene& scene) {
    std::vector<scene::Object*> scattering;
    for (scene::Object& object : scene.objects)
        if (object.material.isScattering()) scattering.push_back(&object);
    if (options.object.empty() && scattering.size() == 1) return scattering[0];
    std::vector<std::string_view> names;
    for (scene::Object* object : scattering) {
        if (object->name == options.object) return object;
        names.push_back(object->name);
    }
    if (names.empty())
        return Error{options.scene.path + ": has no object whose material scatters; must have one"};
    if (options.object.empty())
        return Error{options.scene.path + ": has " + std::to_string(names.size()) +
                     " objects whose materials scatter; --object must name one of them"};
    return Error{"--object: is " + options.object + ", no object whose material scatters; the nearest is " +
                 std::string(nearest(options.object, names))};
}

Status checkPlaces(const PaintOptions& options, const std::vector<std::string>& inputs) {
    if (isArchive(options.scene.path))
        return Error{options.scene.path + ": is an archive, beside which no painted map is found; must be a "
                                          "scene file"};
    const fs::path folder = fs::absolute(options.scene.path).parent_path();
    if (Status possible = checkOutputs({options.output, options.entering, options.leaving}, inputs);
        !possible)
        return possible;
    for (const std::string* path : {&options.output, &options.entering, &options.leaving}) {
        std::error_code ignored;
        if (!fs::equivalent(fs::absolute(*path).parent_path(), folder, ignored))
            return Error{*path + ": lies elsewhere than " + options.scene.path +
                         ", whose files are named from there; must lie beside it"};
        if (path != &options.output && fs::path(*path).extension() != ".exr")
            return Error{*path + ": cannot hold painted maps; must be .exr"};
    }
    return Done{};
}

Status paintScene(PaintOptions options) {
    const std::string stem = fs::path(options.output).replace_extension().string();
    if (options.entering.empty()) options.entering = stem + "-entering.exr";
    if (options.leaving.empty()) options.leaving = stem + "-leaving.exr";
    Result<std::vector<std::string>> inputs = options.scene.files();
    if (!inputs) return inputs.error();
    inputs->push_back(options.strokes);
    if (Status places = checkPlaces(options, *inputs); !places) return places;

    Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    const Result<scene::Object*> found = objectOf(options, *scene);
    if (!found) return found.error();
    scene::Object& object = **found;
    const Result<Bytes> script = readFile(options.strokes);
    if (!script) return script.error();
    const Result<std::vector<scene::Stroke>> strokes = scene::parseStrokes(*script, options.strokes);
    if (!strokes) return strokes.error();

    const std::shared_ptr<const scene::Painting> before = object.painting;
    if (before && options.side && options.side != before->side())
        return Error{"--side: is " + std::to_string(options.side) + ", but the object is painted with " +
                     std::to_string(before->side()) + "; must be left out"};
    const int side = before ? before->side() : options.side ? options.side : scene::PaintSource().side;
    const auto painted = scene::paint(object, *strokes, side, before ? before->entering : nullptr,
                                      before ? before->leaving : nullptr);
    if (!painted) return Error{"objects." + object.name + ": " + painted.error().message};
    Result<Bytes> entering = encode(*(*painted)->entering, options.entering),
                  leaving = encode(*(*painted)->leaving, options.leaving);
    if (!entering) return entering.error();
    if (!leaving) return leaving.error();

    scene::Painting files;
    files.entering = (*painted)->entering;
    files.leaving = (*painted)->leaving;
    files.enteringFile = fs::path(options.entering).filename().string();
    files.leavingFile = fs::path(options.leaving).filename().string();
    files.scale = object.transform.scale;
    object.painting = std::make_shared<const scene::Painting>(std::move(files));
    if (Status written = writeAll({{options.entering, std::move(*entering)},
                                   {options.leaving, std::move(*leaving)},
                                   {options.output, toBytes(scene::toJson(*scene))}});
        !written)
        return written;
    std::printf("%s: %zu strokes on %s, %d x %d texels\n", options.output.c_str(), strokes->size(),
                object.name.c_str(), side, side);
    return Done{};
}

} // namespace

Command addPaint(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("paint", "Paints the strokes of a script on a translucent object");
    const auto options = std::make_shared<PaintOptions>();
    options->scene.addTo(*parser);
    parser->add_option("--strokes", options->strokes, "Stroke script (.json)")->required()->type_name("FILE");
    parser->add_option("--object", options->object, "Object to paint [the only one that scatters]")
        ->type_name("NAME");
    parser->add_option("--side", options->side, "Texels a side of the maps [512]")
        ->check(integerIn(scene::kLeastPaintSide, scene::kMostPaintSide));
    addOutput(*parser, options->output, "Scene (.json) beside SCENE, with the maps it names");
    parser->add_option("--entering", options->entering, "Map where light enters [OUT-entering.exr]")
        ->type_name("FILE");
    parser->add_option("--leaving", options->leaving, "Map where light leaves [OUT-leaving.exr]")
        ->type_name("FILE");
    parser->footer("Example:\n  lucent paint ball.json --strokes stripes.json -o striped.json");
    return {parser, [options] { return paintScene(*options); }};
}

} // namespace lucent::cli
