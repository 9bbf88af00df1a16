#pragma once
/// Speed against error of the relief methods, side by side in one run.

#include "gl/Context.h"
#include "scene/Scene.h"

#include <functional>
#include <string>
#include <vector>

namespace lucent::measure {

/// A height map to measure on.
struct BenchField {
    std::string name;
    std::shared_ptr<const Image> heights;
    float heightScale; ///< m, for a field 1 m wide
};

/// Median and spread of repeated times.
struct Timing {
    double median = 0, low = 0, high = 0; ///< ms
};

/// One method at one setting on one field.
struct BenchPoint {
    std::string field, method;
    ivec2 size{0}; ///< texels of the field, and pixels of the picture
    int steps = 0; ///< 0: none
    Timing perLight;
    double rmse = 0; ///< of d against the exact model in double precision
};

/// Cost of a texel on fields of growing size, by the default method.
struct SizePoint {
    int size = 0;
    double nanosecondsPerTexel = 0;
};

struct ReliefReport {
    std::string driver;
    std::vector<BenchPoint> points;
    std::vector<SizePoint> sizes;

    /// Lines for people, ratios and targets included.
    std::string text() const;
    std::string json() const;
};

/// Times the light pass alone: pictures with several lights less the picture without any, each ended by
/// reading a pixel back, so that software drivers are timed rightly too.
///
/// @param quick  fewer repeats and no field above 2048 texels
/// @param say    called with a line before each part
Result<ReliefReport> benchRelief(gl::Context& context, const std::vector<BenchField>& fields, bool quick,
                                 const std::function<void(const std::string&)>& say);

/// Draws one picture of a field with one light, and waits for it: what memory is measured after.
Status drawOnce(gl::Context& context, const BenchField& field);

/// Sum of sines of falling amplitude over seven octaves: the synthetic field of the benchmark, heights in [0,
/// 1].
std::shared_ptr<const Image> benchNoise(int size);

} // namespace lucent::measure
