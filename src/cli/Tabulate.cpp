// lucent tabulate: the reflectance of a material as a table of directions.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/Text.h"
#include "scene/ReflectanceTable.h"
#include "truth/Gloss.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace lucent::cli {

namespace {

struct TabulateOptions {
    SceneOptions scene;
    std::string object, output, form = "equal-area";
    int blocks = 32, texels = 32;
};

Result<const scene::Material*> materialOf(const scene::Scene& scene, const std::string& name) {
    std::vector<std::string_view> known;
    for (const scene::Object& object : scene.objects) {
        if (object.name == name || (name.empty() && object.material.isGlossy())) {
            if (object.material.isGlossy()) return &object.material;
            return Error{"object " + inQuotes(name) + ": is not glossy; must be, to have a table"};
        }
        known.push_back(object.name);
    }
    if (name.empty()) return Error{"the scene has no glossy object; must have one"};
    return Error{"--object: is " + inQuotes(name) + "; the nearest is " + inQuotes(nearest(name, known))};
}

Status tabulate(const TabulateOptions& options) {
    const bool isMerl = std::filesystem::path(options.output).extension() == ".binary";
    if (!isMerl)
        if (Status known = checkImageEnding(options.output); !known) return known;
    const Result<std::vector<std::string>> files = options.scene.files();
    if (!files) return files.error();
    if (Status possible = checkOutputs({options.output}, *files); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    const Result<const scene::Material*> material = materialOf(*scene, options.object);
    if (!material) return material.error();
    const scene::TableForm form = isMerl                        ? scene::TableForm::Merl
                                  : options.form == "projected" ? scene::TableForm::Projected
                                                                : scene::TableForm::EqualArea;
    const auto brdf = [&](const dvec3& toLight, const dvec3& toEye) {
        return vec3(truth::Gloss(**material, dvec3(0, 0, 1), toEye).share(toLight) / toLight.z);
    };
    const Image table = scene::tabulate(brdf, form, options.blocks, options.texels);
    Result<Bytes> encoded = isMerl ? scene::encodeMerl(table) : encode(table, options.output);
    if (!encoded) return encoded.error();
    if (Status written = writeAll({{options.output, std::move(*encoded)}}); !written) return written;
    std::printf("%s: %d x %d values\n", options.output.c_str(), table.width, table.height);
    return Done{};
}

} // namespace

Command addTabulate(CLI::App& program) {
    CLI::App* parser = program.add_subcommand(
        "tabulate", "Writes the reflectance of a glossy material as a table of directions of light and view");
    const auto options = std::make_shared<TabulateOptions>();
    options->scene.addTo(*parser);
    parser->add_option("--object", options->object, "Whose material [the first glossy one's]")
        ->type_name("NAME");
    addOutput(*parser, options->output,
              "Table: .binary in the format of the MERL database; .pfm, .exr or .hdr in blocks");
    parser->add_option("--form", options->form, "Of a table in blocks [equal-area]")
        ->check(CLI::IsMember({"projected", "equal-area"}));
    parser->add_option("--blocks", options->blocks, "Along a side, for directions of light [32]")
        ->check(integerIn(2, 256));
    parser->add_option("--texels", options->texels, "Of a block along its side, for directions of view [32]")
        ->check(integerIn(2, 256));
    parser->footer("Example:\n"
                   "  lucent tabulate ball.json -o ball.binary\n"
                   "Then a material {\"kind\": \"measured\", \"table\": \"ball.binary\"} looks it up.");
    return {parser, [options] { return tabulate(*options); }};
}

} // namespace lucent::cli
