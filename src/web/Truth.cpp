/// The page's third module: it computes the exact picture of a scene, in a worker where there is one, and is
/// fetched only when a person asks for that. C functions as in Api.h; strings returned stay valid until the
/// next call that returns one.

#include "base/Text.h"
#include "frame/Renderer.h"
#include "measure/TruthModel.h"
#include "scene/Load.h"
#include "technique/Technique.h"
#include "truth/Glass.h"
#include "truth/RenderRelief.h"
#include "web/Files.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string>

using namespace lucent;

namespace {

/// One picture at a time, pixel by pixel from the top.
struct Job {
    PutFiles files;
    scene::Scene scene;
    std::unique_ptr<truth::Estimator> estimator;
    Image image;
    int done = 0;       // pixels
    double squares = 0; // of the standard errors, over all colours
    std::string answer;
};

Job& job() {
    static Job only;
    return only;
}

const char* answer(std::string text) {
    job().answer = std::move(text);
    return job().answer.c_str();
}

Result<Bytes> readPut(const std::string& path) { return job().files.read(path); }

/// What takes too long for a page, by name.
Error leftToProgram(const std::string& what) {
    return Error{"truth: " + what +
                 ", which the page does not solve; must be solved by the program (lucent truth)"};
}

Error leftToProgram(const scene::Scene& scene, measure::TruthModel model) {
    const scene::Aov aov = scene.view.show;
    if (aov != scene::Aov::Color)
        return leftToProgram("shown is the AOV " + std::string(scene::aovNames()[std::size_t(aov)]));
    if (model == measure::TruthModel::Light) return leftToProgram(*measure::causticOf(scene));
    const auto scattering = std::find_if(scene.objects.begin(), scene.objects.end(),
                                         [](const auto& object) { return object.material.isScattering(); });
    return leftToProgram("object " + inQuotes(scattering->name) + " has subsurface scattering");
}

/// @param size     of the picture whose pixels are solved; PixelMean::sizeOf() it where their means are drawn
/// @param samples  of each of them
Result<std::unique_ptr<truth::Estimator>> makeEstimator(const scene::Scene& scene, ivec2 size, int samples) {
    const scene::Aov aov = scene.view.show;
    const measure::TruthModel model = measure::usualTruth(scene);
    if (model == measure::TruthModel::Relief) {
        if (Status known = truth::checkAov(aov); !known) return known.error();
        const truth::Model drawn = technique::modelOf(scene);
        truth::ReliefOptions options{.attenuation = drawn.attenuation,
                                     .environmentLights = samples,
                                     .normalise = drawn.normalise,
                                     .threads = 1};
        if (drawn.overPixels) {
            options.environmentSets = truth::PixelMean::kPlaces; // each place of a pixel has others
            options.discSamples = truth::PixelMean::samplesOf(options.discSamples);
        }
        return std::unique_ptr<truth::Estimator>(new truth::ReliefEstimator(scene, size, aov, options));
    }
    if (model != measure::TruthModel::Glass) return leftToProgram(scene, model);
    auto glass = truth::GlassEstimator::create(scene, size, aov, {.samples = samples});
    if (!glass) return glass.error();
    return std::unique_ptr<truth::Estimator>(new truth::GlassEstimator(std::move(*glass)));
}

Result<std::unique_ptr<truth::Estimator>> makeFiltered(const scene::Scene& scene, ivec2 size, int samples) {
    using truth::PixelMean;
    if (!technique::modelOf(scene).overPixels) return makeEstimator(scene, size, samples);
    const bool isGlass = measure::usualTruth(scene) == measure::TruthModel::Glass;
    const int count = isGlass ? PixelMean::placesFor(samples) : PixelMean::kPlaces;
    auto places = makeEstimator(scene, PixelMean::sizeOf(size, count), PixelMean::samplesOf(samples, count));
    if (!places) return places;
    return std::unique_ptr<truth::Estimator>(new PixelMean(std::move(*places), 0, count));
}

void solveNext() {
    Job& j = job();
    const ivec2 at(j.done % j.image.width, j.done / j.image.width);
    const truth::Pixel pixel = j.estimator->solve(at);
    float* out = j.image.at(at.x, at.y);
    for (int channel = 0; channel < 3; ++channel) {
        out[channel] = float(pixel.value[channel]);
        j.squares += pixel.variance[channel];
    }
    out[3] = float(pixel.coverage);
    ++j.done;
}

} // namespace

extern "C" {

/// Makes room for a file of the scene. @return  where its bytes are to be written
std::uint8_t* truth_file_space(const char* name, int size) { return job().files.space(name, size); }

/// Begins the picture of "scene.json" and forgets the files. "" or the message.
///
/// @param samples  of a relief directions that stand for an environment, else of each pixel in which
/// something
///                 is left to chance
const char* truth_start(int width, int height, int samples) {
    Job& j = job();
    Result<scene::Scene> scene = scene::load("scene.json", readPut, technique::tables());
    j.files.clear();
    if (!scene) return answer(scene.error().message);
    j.scene = std::move(*scene);
    auto estimator = makeFiltered(j.scene, ivec2(width, height), samples);
    if (!estimator) return answer(estimator.error().message);
    j.estimator = std::move(*estimator);
    j.image = Image(width, height, 4);
    j.done = 0;
    j.squares = 0;
    return answer(std::string());
}

/// Works on the picture for about so long. @return the finished share, [0,1]
double truth_step(double milliseconds) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double, std::milli>(milliseconds);
    Job& j = job();
    const int all = j.image.width * j.image.height;
    while (j.done < all && Clock::now() < end)
        solveNext();
    return double(j.done) / all;
}

/// Width x height x 4 floats, linear, row 0 at the top, the fourth is coverage.
const float* truth_pixels() { return job().image.pixels.data(); }
/// RMSE that a finished picture must be expected to have against one without noise.
double truth_noise() { return std::sqrt(job().squares / (3.0 * job().image.width * job().image.height)); }
}
