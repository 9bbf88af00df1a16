// lucent truth: the exact model, or the physics that it stands for, on the CPU.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/ProgressBar.h"
#include "cli/TruthOutput.h"

#include "base/Text.h"
#include "relief/Relief.h"
#include "truth/Lambert.h"
#include "truth/RenderRelief.h"

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <memory>

namespace lucent::cli {

namespace {
struct TruthOptions {
    SceneOptions scene;
    TruthOutput output;
    std::string estimator = "relief";
    std::string tile; ///< "I/N"; empty: the whole picture
    int samples = truth::ReliefOptions{}.discSamples;
    int directions = truth::ReliefOptions{}.environmentLights;
    const CLI::Option* directionsGiven = nullptr;
    std::uint32_t seed = 0;
    int threads = 0;
};

std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free); // or a signal handler must not touch it

Result<std::unique_ptr<truth::Estimator>> makeEstimator(const scene::Scene& scene,
                                                        const TruthOptions& options) {
    const auto& settings = scene.technique.at("relief").as<relief::Settings>();
    if (options.estimator == "lambert") {
        auto lambert = truth::LambertEstimator::create(
            scene, scene.size, scene.view.show,
            {.samples = options.samples, .normalise = settings.normalise, .seed = options.seed});
        if (!lambert) return lambert.error();
        return std::unique_ptr<truth::Estimator>(new truth::LambertEstimator(std::move(*lambert)));
    }
    if (Status known = truth::checkAov(scene.view.show); !known) return known.error();
    const bool ratio = settings.attenuation == relief::Attenuation::Ratio;
    const truth::ReliefOptions model{.attenuation =
                                         ratio ? truth::Attenuation::Ratio : truth::Attenuation::Exponential,
                                     .environmentLights = options.directions,
                                     .normalise = settings.normalise,
                                     .discSamples = options.samples,
                                     .seed = options.seed};
    return std::unique_ptr<truth::Estimator>(
        new truth::ReliefEstimator(scene, scene.size, scene.view.show, model));
}

truth::Facts factsOf(const scene::Scene& scene, const TruthOptions& options) {
    return {.scene = options.scene.path,
            .fingerprint = truth::fingerprint(scene),
            .size = scene.size,
            .aov = std::string(scene::aovNames()[std::size_t(scene.view.show)]),
            .estimator = options.estimator,
            .seed = options.seed,
            .samples = options.samples,
            .directions = options.estimator == "relief" ? options.directions : 0,
            .exposure = scene.view.exposure};
}

/// "3/8": the third of eight parts.
Result<truth::Tile> parseTile(const std::string& text, int rows) {
    char* end = nullptr;
    const long index = std::strtol(text.c_str(), &end, 10);
    const long count = *end == '/' ? std::strtol(end + 1, &end, 10) : 0;
    if (*end != 0 || index < 1 || count < index || count > rows)
        return Error{"--tile: is " + inQuotes(text) +
                     "; must be I/N with I from 1 to N, and N at most the picture's " + std::to_string(rows) +
                     " rows"};
    return truth::Tile{int(index) - 1, int(count)};
}

Status checkOptions(const TruthOptions& options) {
    if (options.estimator == "lambert" && options.directionsGiven->count() > 0)
        return Error{"--directions: is of the relief estimator; must be --samples for lambert"};
    if (options.tile.empty()) return options.output.check();
    if (!options.output.errors.empty())
        return Error{"--errors: is of the whole picture; must be given to lucent merge"};
    return checkFolder(options.output.picture);
}

Status makeTruth(const TruthOptions& options) {
    if (Status possible = checkOptions(options); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    const Result<truth::Tile> tile =
        options.tile.empty() ? truth::Tile{} : parseTile(options.tile, scene->size.y);
    if (!tile) return tile.error();
    const auto estimator = makeEstimator(*scene, options);
    if (!estimator) return estimator.error();

    std::signal(SIGINT, [](int) { interrupted = true; });
    Result<truth::Picture> picture = [&] {
        ProgressBar bar;
        return truth::render(**estimator, scene->size, *tile,
                             {options.threads, [&](double share) { bar.show(share); }}, interrupted);
    }();
    if (!picture) return picture.error();
    const truth::Facts facts = factsOf(*scene, options);
    if (options.tile.empty()) return options.output.write(facts, *picture);
    return writeFile(options.output.picture, truth::encodePart({facts, *tile, std::move(*picture)}));
}
} // namespace

Command addTruth(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("truth", "Solves a scene's model exactly, on the CPU");
    const auto options = std::make_shared<TruthOptions>();
    options->scene.addTo(*parser);
    options->scene.addAovTo(*parser, "Quantity to solve: color or d (illumination)");
    options->output.addTo(*parser);
    parser
        ->add_option(
            "--estimator", options->estimator,
            "relief: the model; lambert: ray-traced direct light on a matt surface, which it stands for")
        ->check(CLI::IsMember({"relief", "lambert"}))
        ->capture_default_str();
    parser
        ->add_option("--samples", options->samples,
                     "Points on the disc of each soft light; with lambert also directions of the environment")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    options->directionsGiven = parser
                                   ->add_option("--directions", options->directions,
                                                "Directions that stand for the environment in relief")
                                   ->check(CLI::Range(1, 1 << 20))
                                   ->capture_default_str();
    parser
        ->add_option("--seed", options->seed, "Other points and directions; threads and tiles change nothing")
        ->type_name("NUMBER")
        ->capture_default_str();
    parser
        ->add_option("--tile", options->tile,
                     "Solves part I of N (every N-th row) for lucent merge; -o takes any name")
        ->type_name("I/N");
    parser->add_option("--threads", options->threads, "0: as many as the machine has")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    parser->footer(
        "Ctrl-C stops the work; nothing is written then. scripts/truth spreads it over processes.\n\n"
        "Examples:\n"
        "  lucent truth coin.json -o truth.pfm\n"
        "  lucent truth coin.json -o d.exr --aov d --size 256x256\n"
        "  lucent truth coin.json -o physics.pfm --estimator lambert --samples 1024\n"
        "  lucent truth coin.json -o coin-3.tile --tile 3/8");
    return {parser, [options] { return makeTruth(*options); }};
}

} // namespace lucent::cli
