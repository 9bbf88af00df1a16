// lucent render: one picture on the GPU.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/JsonWriter.h"
#include "frame/Renderer.h"
#include "gl/Context.h"

#include <filesystem>
#include <memory>

namespace lucent::cli {

namespace {
struct RenderOptions {
    SceneOptions scene;
    std::string output, stats;
};

std::string statsJson(const RenderOptions& options, ivec2 size, const gl::Context& context,
                      const frame::Stats& stats) {
    JsonWriter json;
    json.beginObject();
    json.key("scene").value(options.scene.path);
    json.key("width").value(size.x).key("height").value(size.y);
    json.key("renderer").value(context.caps().renderer);
    json.key("milliseconds").value(stats.milliseconds);
    json.key("passes").value(stats.passes).key("draws").value(stats.draws).key("lights").value(stats.lights);
    json.key("textureBytes").value(double(stats.bytes));
    json.end();
    return json.text();
}

Status render(const RenderOptions& options) {
    if (Status possible = checkImageOutput(options.output); !possible) return possible;
    if (Status possible = checkFolder(options.stats); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();

    frame::Renderer renderer(**context);
    if (Status finished = renderer.finish(*scene, 1, scene->size); !finished) return finished;
    const bool isPicture = std::filesystem::path(options.output).extension() == ".png";
    const Result<Image> image =
        isPicture ? renderer.readDisplay(*scene) : renderer.read(*scene, scene->view.show);
    if (!image) return image.error();
    Result<Bytes> encoded = encode(*image, options.output);
    if (!encoded) return encoded.error();

    std::vector<Output> outputs{{options.output, std::move(*encoded)}};
    if (!options.stats.empty())
        outputs.push_back(
            {options.stats, toBytes(statsJson(options, scene->size, **context, renderer.stats()))});
    return writeAll(outputs);
}
} // namespace

Command addRender(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("render", "Renders a scene into an image file");
    const auto options = std::make_shared<RenderOptions>();
    options->scene.addTo(*parser);
    options->scene.addAovTo(*parser, "Quantity to show: color, d (illumination), visibility, normal, depth, "
                                     "position, iterations");
    addOutput(*parser, options->output, "Picture: .png as displayed; .hdr, .exr or .pfm with linear values");
    parser->add_option("--stats", options->stats, "Writes time, passes, lights and bytes as JSON")
        ->type_name("FILE");
    parser->footer("Examples:\n"
                   "  lucent render coin.json -o coin.png\n"
                   "  lucent render coin.json -o coin.exr --size 1024x1024 --aov d\n"
                   "  lucent render coin.json -o shiny.png --set objects.coin.material.specularity=0.6");
    return {parser, [options] { return render(*options); }};
}

} // namespace lucent::cli
