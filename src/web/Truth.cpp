/// The page's third module: it computes the exact picture of a scene, in a worker where there is one, and is
/// fetched only when a person asks for that. C functions as in Api.h; strings returned stay valid until the
/// next call that returns one.

#include "base/Text.h"
#include "frame/Renderer.h"
#include "relief/Relief.h"
#include "scene/Load.h"
#include "truth/RenderRelief.h"

#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <string>

using namespace lucent;

namespace {

/// One picture at a time, pixel by pixel from the top.
struct Job {
    std::map<std::string, Bytes> files;
    scene::Scene scene;
    std::unique_ptr<truth::ReliefEstimator> estimator;
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

Result<Bytes> readPut(const std::string& path) {
    const auto found = job().files.find(path);
    if (found == job().files.end()) return Error{path + ": was not put; must be there before truth_start()"};
    return found->second;
}

truth::ReliefOptions optionsOf(const scene::Scene& scene, int directions) {
    const auto& settings = scene.technique.at("relief").as<relief::Settings>();
    const bool ratio = settings.attenuation == relief::Attenuation::Ratio;
    return {.attenuation = ratio ? truth::Attenuation::Ratio : truth::Attenuation::Exponential,
            .environmentLights = directions,
            .normalise = settings.normalise,
            .threads = 1};
}

// What follows rays through whole scenes needs Embree, which exists natively only.
Status checkScene(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects)
        if (!object.isField())
            return Error{
                "truth: object " + inQuotes(object.name) +
                " is no height field; must be one, or the scene be solved by the program (lucent truth)"};
    return truth::checkAov(scene.view.show);
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

/// Keeps a file of the scene; the bytes are copied.
void truth_file_put(const char* name, const std::uint8_t* bytes, int size) {
    const auto content = std::as_bytes(std::span(bytes, std::size_t(size)));
    job().files[name] = Bytes(content.begin(), content.end());
}

/// Begins the picture of "scene.json" and forgets the files. "" or the message.
///
/// @param directions  that stand for an environment
const char* truth_start(int width, int height, int directions) {
    Job& j = job();
    Result<scene::Scene> scene = scene::load("scene.json", readPut, frame::techniques());
    j.files.clear();
    if (!scene) return answer(scene.error().message);
    j.scene = std::move(*scene);
    if (Status known = checkScene(j.scene); !known) return answer(known.error().message);
    j.estimator = std::make_unique<truth::ReliefEstimator>(j.scene, ivec2(width, height), j.scene.view.show,
                                                           optionsOf(j.scene, directions));
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
