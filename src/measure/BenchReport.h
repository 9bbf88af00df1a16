#pragma once
/// What a benchmark found, and its JSON form, the same for program, page and peers.

#include "measure/Metrics.h"
#include "measure/Statistics.h"

#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lucent::measure {

/// A line as std::printf would write it, up to 511 bytes.
std::string formatted(const char* format, auto... values) {
    char line[512];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

/// Where it ran. Empty texts and zeros are left out of the JSON.
struct Machine {
    std::string cpu;
    int cores = 0;
    double memoryMB = 0;
    std::string where = "native"; ///< or "browser"
    std::string driver, version;  ///< of GL
    std::string browser;
};

/// One method at one setting on one scene.
struct Measurement {
    std::string technique, scene, method;
    std::vector<std::pair<std::string, std::string>> knobs; ///< name and value, as in scene files
    ivec2 size{0};                                          ///< of the picture, in pixels
    int lights = 0; ///< that shine, an environment's directions included

    std::optional<Spread> ms;     ///< of the picture, less the picture without light (Timed)
    std::optional<double> bakeMs; ///< what is done once for a field, before the first picture
    int passes = 0, draws = 0;
    std::size_t bytes = 0; ///< GPU memory of textures

    std::optional<Metrics> error;      ///< against the same model solved exactly
    std::optional<Metrics> modelError; ///< against the physics
    double truthNoise = 0;             ///< RMS error of the exact solution itself
    bool pareto = false;               ///< nothing else on this scene is quicker and nearer at once
    std::string refused;               ///< the message, when the method could not
};

/// Time over the size of something.
struct ScalingSeries {
    std::string technique, method, over;
    std::vector<dvec2> points; ///< size and milliseconds
    double exponent() const { return fittedExponent(points); }
};

struct HardResult {
    enum class Status { Pass, Error, Refused };
    std::string name, method;
    Status status = Status::Pass;
    double error = 0;    ///< RMSE; NaN for a picture with values that are not finite
    std::string message; ///< of the refusal, or which value is not finite
};

/// A figure that a promise was made about.
struct Ratio {
    std::string name;
    double value = 0;
    std::optional<double> target;
    bool atLeast = true; ///< else at most
    bool met() const { return !target || (atLeast ? value >= *target : value <= *target); }
};

struct BenchReport {
    std::string date, commit;
    bool quick = false;
    Machine machine;
    std::string timing;               ///< Stopwatch::kind()
    double contextMB = 0, peakMB = 0; ///< resident memory with a context alone, at most; 0: unknown
    std::vector<Measurement> measurements;
    std::vector<ScalingSeries> scaling;
    std::vector<HardResult> hardCases;
    std::vector<Ratio> ratios;

    /// Sets Measurement::pareto: time against RMSE (of directions the median angle, of light on a floor what
    /// is misplaced) among the measurements of
    /// one scene, size and technique.
    void markParetoFronts();

    /// "lucent-bench-1".
    std::string json() const;
    /// Lines for people: measurements, exponents, how hard cases went, ratios with their targets.
    std::string text() const;
};

} // namespace lucent::measure
