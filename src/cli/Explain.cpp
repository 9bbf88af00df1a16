// lucent explain: what would be drawn, and why.
#include "cli/Command.h"
#include "cli/Files.h"

#include "frame/Renderer.h"
#include "gl/Context.h"

#include <cstdio>
#include <memory>

namespace lucent::cli {

namespace {
Status explain(const SceneOptions& options) {
    const Result<scene::Scene> scene = options.load();
    if (!scene) return scene.error();
    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    frame::Renderer renderer(**context);
    const Result<std::string> text = renderer.explain(*scene, scene->size);
    if (!text) return text.error();
    std::fputs(text->c_str(), stdout);
    return Done{};
}
} // namespace

Command addExplain(CLI::App& program) {
    CLI::App* parser = program.add_subcommand(
        "explain", "Prints the passes of a scene, why they run, and what was left out");
    const auto options = std::make_shared<SceneOptions>();
    options->addTo(*parser);
    options->addAovTo(*parser, "Quantity to show: color, d, visibility, normal, depth, position, iterations");
    parser->footer("Examples:\n"
                   "  lucent explain coin.json\n"
                   "  lucent explain coin.json --aov normal --size 4096x4096");
    return {parser, [options] { return explain(*options); }};
}

} // namespace lucent::cli
