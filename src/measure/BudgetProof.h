#pragma once
/// Whether quality.maxError keeps what it promises, on scenes that nothing was fitted to.

#include "gl/Context.h"
#include "measure/ReliefPlan.h"

#include <string>
#include <vector>

namespace lucent::measure {

/// The wanted errors of the proof: RMSE over the mean.
inline constexpr float kWantedErrors[] = {0.1f, 0.03f, 0.01f, 0.003f};

/// What the budget did on one scene for one wanted error.
struct BudgetResult {
    std::string scene;
    float wanted = 0;
    std::string chosen;   ///< settings, for people
    double predicted = 0; ///< RMSE over the mean, by the budget
    double error = 0;     ///< and in truth: fields against 8192 directions and 1024 points a lamp, summed
                          ///< exactly; glass against ray tracing
    double ms = 0;        ///< the picture with the chosen settings
    double planMs = 0;    ///< choosing them
    double bestMs = 0;    ///< the quickest setting that keeps the error, of all; 0: none does
    std::string best;

    bool kept() const { return error <= wanted || bestMs == 0; }
    bool quick() const { return bestMs == 0 || ms <= 1.5 * bestMs; }
};

struct BudgetReport {
    std::vector<BudgetResult> results;
    std::string what = "scenes"; ///< that were drawn
    std::string text() const;
    std::string json() const;
    /// For each wanted error the share of scenes that kept it, and of those done within 1.5 times the best
    /// time.
    std::vector<Ratio> totals() const;
};

/// Root of the mean squared difference over the mean, on the pixels that show something in the exact picture.
double relativeError(const Image& image, const Image& exact);

/// Ten kinds of fields under six kinds of light. The sample size and the safety of frame::Budget were chosen
/// on smooth noise under a sky and one light probe, which are not among them.
///
/// @param fields        beside synthetic ones
/// @param environments  measured light probes
/// @param side          of the pictures, in pixels
Result<BudgetReport> proveBudget(gl::Context& context, const std::vector<BenchField>& fields,
                                 const std::vector<BenchEnvironment>& environments, int side, const Say& say);

} // namespace lucent::measure
