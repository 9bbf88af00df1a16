// lucent truth: the exact model on the CPU.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/ProgressBar.h"

#include "relief/Relief.h"
#include "truth/RenderRelief.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <memory>

namespace lucent::cli {

namespace {
struct TruthOptions {
    SceneOptions scene;
    std::string output;
    int directions = truth::ReliefOptions{}.environmentLights;
    int threads = 0;
};

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // or a signal handler must not touch it

/// The picture of linear values: exposure for colours, then clamp and sRGB curve.
Image toDisplay(Image image, const scene::View& view) {
    const float gain = view.show == scene::Aov::Color ? std::exp2(view.exposure) : 1;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) image.pixels[i] = srgbFromLinear(std::clamp(gain * image.pixels[i], 0.f, 1.f));
    return image;
}

truth::ReliefOptions modelOf(const scene::Scene& scene, const TruthOptions& options) {
    const auto& settings = scene.technique.at("relief").as<relief::Settings>();
    const bool ratio = settings.attenuation == relief::Attenuation::Ratio;
    return {.attenuation = ratio ? truth::Attenuation::Ratio : truth::Attenuation::Exponential,
            .environmentLights = options.directions,
            .normalise = settings.normalise,
            .threads = options.threads};
}

Result<Image> solve(const scene::Scene& scene, const TruthOptions& options) {
    std::signal(SIGINT, [](int) { interrupted = true; });
    ProgressBar bar;
    return truth::renderRelief(
        scene, scene.size, scene.view.show, modelOf(scene, options), [&](double share) { bar.show(share); },
        interrupted);
}

Status makeTruth(const TruthOptions& options) {
    if (Status possible = checkImageOutput(options.output); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    Result<Image> image = solve(*scene, options);
    if (!image) return image.error();
    if (std::filesystem::path(options.output).extension() == ".png") *image = toDisplay(*image, scene->view);
    Result<Bytes> encoded = encode(*image, options.output);
    if (!encoded) return encoded.error();
    return writeAll({{options.output, std::move(*encoded)}});
}
} // namespace

Command addTruth(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("truth", "Solves a scene's model exactly, on the CPU");
    const auto options = std::make_shared<TruthOptions>();
    options->scene.addTo(*parser);
    options->scene.addAovTo(*parser, "Quantity to solve: color or d (illumination)");
    addOutput(*parser, options->output, "Picture: .png as displayed; .hdr, .exr or .pfm with linear values");
    parser->add_option("--directions", options->directions, "Directions that stand for the environment")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    parser->add_option("--threads", options->threads, "0: as many as the machine has")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    parser->footer("Ctrl-C stops the work; nothing is written then.\n\n"
                   "Examples:\n"
                   "  lucent truth coin.json -o truth.pfm\n"
                   "  lucent truth coin.json -o d.exr --aov d --size 256x256");
    return {parser, [options] { return makeTruth(*options); }};
}

} // namespace lucent::cli
