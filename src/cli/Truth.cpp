// lucent truth: the exact models, or the physics that they stand for, on the CPU.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/Interrupt.h"
#include "cli/ProgressBar.h"
#include "cli/TruthOutput.h"

#include "base/Text.h"
#include "measure/TruthModel.h"
#include "technique/Technique.h"
#include "truth/Dipole.h"
#include "truth/Glass.h"
#include "truth/Lambert.h"
#include "truth/LightTracer.h"
#include "truth/RenderRelief.h"
#include "truth/Walk.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <limits>
#include <memory>

namespace lucent::cli {

namespace {
struct TruthOptions {
    SceneOptions scene;
    TruthOutput output;
    std::string estimator; ///< empty: by the scene; see measure::usualTruth()
    std::string tile;      ///< "I/N"; empty: the whole picture
    std::int64_t photons = truth::LightOptions{}.photons;
    const CLI::Option* photonsGiven = nullptr;
    int samples = truth::ReliefOptions{}.discSamples;
    int directions = truth::ReliefOptions{}.environmentLights;
    const CLI::Option* directionsGiven = nullptr;
    std::uint32_t seed = 0;
    int threads = 0;
};

bool isLight(const TruthOptions& options) {
    return options.estimator == "light" || options.estimator == "light-tree";
}
bool isGlass(const TruthOptions& options) {
    return options.estimator == "glass" || options.estimator == "glass-tree";
}
/// Whether the picture is made by rays of light, not pixel by pixel.
bool isByRays(const TruthOptions& options) { return isLight(options) || options.estimator == "walk"; }
bool isInside(const TruthOptions& options) {
    return options.estimator == "dipole" || options.estimator == "walk";
}
truth::Branching branchingOf(const TruthOptions& options) {
    const bool tree = options.estimator == "glass-tree" || options.estimator == "light-tree";
    return tree ? truth::Branching::Tree : truth::Branching::Chain;
}

/// The name of what a scene is solved by unless it is said.
std::string chosenEstimator(const scene::Scene& scene) {
    constexpr std::string_view kNames[] = {truth::kReliefName, "glass", "light",
                                           "dipole"}; // as measure::TruthModel
    return std::string(kNames[std::size_t(measure::usualTruth(scene))]);
}

/// Irradiance is of light alone, radiosity of what scatters inside; the estimators of height fields leave out
/// everything else.
Status checkEstimator(const scene::Scene& scene, const TruthOptions& options) {
    const scene::Aov aov = scene.view.show;
    const std::string name(scene::aovNames()[std::size_t(aov)]);
    if (aov == scene::Aov::Irradiance && !isLight(options))
        return Error{"--estimator: " + options.estimator +
                     " does not solve the AOV irradiance; must be light or light-tree"};
    if (isInside(options) != (aov == scene::Aov::Radiosity) && aov != scene::Aov::Color)
        return Error{"--estimator: " + options.estimator + " does not solve the AOV " + name + "; must be " +
                     (isInside(options) ? "glass, or --aov color or radiosity" : "dipole or walk")};
    if (isLight(options) && aov != scene::Aov::Irradiance && aov != scene::Aov::Color)
        return Error{"--estimator: " + options.estimator + " does not solve the AOV " + name +
                     "; must be glass, or --aov irradiance or color"};
    if (isLight(options) || isGlass(options) || isInside(options)) return Done{};
    for (const scene::Object& object : scene.objects)
        if (!object.isField())
            return Error{"--estimator: " + options.estimator + " knows height fields only, and object " +
                         inQuotes(object.name) + " is none; must be glass, glass-tree, light or light-tree"};
    return Done{};
}

/// @param size     of the picture whose pixels are solved; the scene's, or PixelMean::sizeOf() it
/// @param samples  of each of them
Result<std::unique_ptr<truth::Estimator>>
makeEstimator(const scene::Scene& scene, const TruthOptions& options, ivec2 size, int samples) {
    const truth::Model drawn = technique::modelOf(scene);
    const auto own = [](auto estimator) -> Result<std::unique_ptr<truth::Estimator>> {
        if (!estimator) return estimator.error();
        using Made = std::decay_t<decltype(*estimator)>;
        return std::unique_ptr<truth::Estimator>(new Made(std::move(*estimator)));
    };
    if (isGlass(options))
        return own(truth::GlassEstimator::create(scene, size, scene.view.show,
                                                 {.branching = branchingOf(options),
                                                  .samples = samples,
                                                  .seed = options.seed,
                                                  .attenuation = drawn.attenuation}));
    if (options.estimator == "dipole") {
        truth::DipoleOptions model = drawn.dipole;
        model.aov = scene.view.show;
        model.samples = std::max(samples, truth::DipoleOptions::kFewest);
        model.seed = options.seed;
        return own(truth::DipoleEstimator::create(scene, size, model));
    }
    if (options.estimator == "lambert")
        return own(truth::LambertEstimator::create(
            scene, size, scene.view.show,
            {.samples = samples, .normalise = drawn.normalise, .seed = options.seed}));
    if (Status known = truth::checkAov(scene.view.show); !known) return known.error();
    truth::ReliefOptions model{.attenuation = drawn.attenuation,
                               .environmentLights = options.directions,
                               .normalise = drawn.normalise,
                               .discSamples = samples,
                               .seed = options.seed};
    if (drawn.overPixels) {
        model.environmentLights = truth::PixelMean::samplesOf(options.directions);
        model.environmentSets = truth::PixelMean::kPlaces; // each place of a pixel has others
    }
    return std::unique_ptr<truth::Estimator>(new truth::ReliefEstimator(scene, size, scene.view.show, model));
}

/// Of the middles of pixels, or of their means, as the scene is drawn.
Result<std::unique_ptr<truth::Estimator>> makeEstimator(const scene::Scene& scene,
                                                        const TruthOptions& options) {
    if (!technique::modelOf(scene).overPixels)
        return makeEstimator(scene, options, scene.size, options.samples);
    using truth::PixelMean;
    const int count = isGlass(options) ? PixelMean::placesFor(options.samples) : PixelMean::kPlaces;
    auto places = makeEstimator(scene, options, PixelMean::sizeOf(scene.size, count),
                                PixelMean::samplesOf(options.samples, count));
    if (!places) return places;
    return std::unique_ptr<truth::Estimator>(new PixelMean(std::move(*places), options.seed, count));
}

Result<truth::Picture> solve(const scene::Scene& scene, const TruthOptions& options, const truth::Tile& tile,
                             const truth::Work& work) {
    const std::atomic<bool>& interrupted = catchInterrupt();
    const truth::Model drawn = technique::modelOf(scene);
    if (isLight(options))
        return truth::traceLight(scene, scene.size,
                                 {.aov = scene.view.show,
                                  .branching = branchingOf(options),
                                  .photons = options.photons,
                                  .samples = options.samples,
                                  .seed = options.seed,
                                  .attenuation = drawn.attenuation,
                                  .overPixels = drawn.overPixels},
                                 tile, work, interrupted);
    if (options.estimator == "walk")
        return truth::traceWalks(scene, scene.size,
                                 {.aov = scene.view.show,
                                  .photons = options.photons,
                                  .samples = options.samples,
                                  .overPixels = drawn.overPixels,
                                  .seed = options.seed},
                                 tile, work, interrupted);
    const auto estimator = makeEstimator(scene, options);
    if (!estimator) return estimator.error();
    return truth::render(**estimator, scene.size, tile, work, interrupted);
}

truth::Facts factsOf(const scene::Scene& scene, const TruthOptions& options) {
    return {.scene = options.scene.path,
            .fingerprint = truth::fingerprint(scene),
            .size = scene.size,
            .aov = std::string(scene::aovNames()[std::size_t(scene.view.show)]),
            .estimator = options.estimator,
            .seed = options.seed,
            .samples = options.samples,
            .directions = options.estimator == truth::kReliefName ? options.directions : 0,
            .photons = isByRays(options) ? options.photons : 0,
            .antialias = technique::modelOf(scene).overPixels,
            .exposure = scene.view.exposure};
}

/// "3/8": the third of eight parts.
///
/// @param most  parts that there can be, and what they are made of
Result<truth::Tile> parseTile(const std::string& text, std::int64_t most, const std::string& unit) {
    char* end = nullptr;
    const long index = std::strtol(text.c_str(), &end, 10);
    const long count = *end == '/' ? std::strtol(end + 1, &end, 10) : 0;
    if (*end != 0 || index < 1 || count < index || count > most)
        return Error{"--tile: is " + inQuotes(text) +
                     "; must be I/N with I from 1 to N, and N at most the picture's " + std::to_string(most) +
                     " " + unit};
    return truth::Tile{int(index) - 1, int(count)};
}

Result<truth::Tile> tileOf(const scene::Scene& scene, const TruthOptions& options) {
    constexpr std::int64_t kMost = std::numeric_limits<int>::max();
    if (options.tile.empty()) return truth::Tile{};
    if (isByRays(options)) return parseTile(options.tile, std::min(options.photons, kMost), "light rays");
    return parseTile(options.tile, scene.size.y, "rows");
}

Status checkOptions(const TruthOptions& options) {
    if (options.estimator != truth::kReliefName && options.directionsGiven->count() > 0)
        return Error{"--directions: is of the relief estimator; must be --samples for " + options.estimator};
    if (!isByRays(options) && options.photonsGiven->count() > 0)
        return Error{"--photons: is of light, light-tree and walk; must be --samples for " +
                     options.estimator};
    return Done{};
}

Status checkOutput(const TruthOptions& options, const std::vector<std::string>& inputs) {
    if (options.tile.empty()) return options.output.check(inputs);
    if (!options.output.errors.empty())
        return Error{"--errors: is of the whole picture; must be given to lucent merge"};
    return checkOutputs({options.output.picture}, inputs);
}

Status makeTruth(TruthOptions options) {
    const Result<std::vector<std::string>> read = options.scene.files();
    if (!read) return read.error();
    if (Status possible = checkOutput(options, *read); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    if (options.estimator.empty()) options.estimator = chosenEstimator(*scene);
    if (Status possible = checkOptions(options); !possible) return possible;
    if (Status possible = checkEstimator(*scene, options); !possible) return possible;
    const Result<truth::Tile> tile = tileOf(*scene, options);
    if (!tile) return tile.error();

    tellNotDrawn(*scene);
    Result<truth::Picture> picture = [&] {
        ProgressBar bar;
        return solve(*scene, options, *tile, {options.threads, [&](double share) { bar.show(share); }});
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
    options->scene.addAovTo(
        *parser,
        "Quantity to solve: of height fields color or d (illumination); of other scenes color, irradiance, "
        "radiosity, direction, layers, normal, depth or position");
    options->output.addTo(*parser);
    parser
        ->add_option(
            "--estimator", options->estimator,
            "Of height fields relief: the model; lambert: ray-traced direct light on a matt surface, which "
            "it "
            "stands for. Of what is seen through glass, without caustics, glass: the model; glass-tree: "
            "every "
            "reflection, which it leaves out. Of irradiance, and of colours with caustics, light: the model; "
            "light-tree: with every reflection. Of what has subsurface scattering, dipole: the model, with "
            "the "
            "scene's profile and dipoleGeometry; walk: random walks, which it stands for. Unless given: "
            "radiosity, "
            "and colours of scenes in which something scatters, by dipole; irradiance, and colours of scenes "
            "whose picture is drawn with caustics (lucent explain names them), by light; height fields alone "
            "by "
            "relief; all else by glass")
        ->check(CLI::IsMember({std::string(truth::kReliefName), std::string("lambert"), std::string("glass"),
                               std::string("glass-tree"), std::string("light"), std::string("light-tree"),
                               std::string("dipole"), std::string("walk")}));
    parser
        ->add_option(
            "--samples", options->samples,
            "Points of each light that has a size, and of the environment on matt surfaces; with glass-tree "
            "paths, with dipole places where light enters; with glass and light each has a place of its own "
            "in the pixel, from 16 to 256")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    options->photonsGiven =
        parser->add_option("--photons", options->photons, "Light rays of light, light-tree and walk")
            ->check(CLI::Range(std::int64_t(1), std::int64_t(1) << 40))
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
                     "Solves part I of N (every N-th row and light ray) for lucent merge; -o takes any name")
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
        "  lucent truth coin.json -o coin-3.tile --tile 3/8\n"
        "  lucent truth ball.json -o direction.exr --aov direction\n"
        "  lucent truth ball.json -o floor.exr --aov irradiance --photons 100000000\n"
        "  lucent truth marble.json -o b.exr --aov radiosity --samples 4096\n"
        "  lucent truth marble.json -o physics.exr --aov radiosity --estimator walk");
    return {parser, [options] { return makeTruth(*options); }};
}

} // namespace lucent::cli
