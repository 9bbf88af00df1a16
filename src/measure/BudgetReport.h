#pragma once
/// Whether quality.maxError keeps what it promises, on scenes that nothing was fitted to.

#include "measure/TechniqueBench.h"

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
    double error = 0;     ///< and in truth
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

    /// For each wanted error the share of scenes that kept it, and of those done within 1.5 times the best
    /// time; with every result as lines and as JSON.
    Proof proof() const;

private:
    std::string text() const;
    std::string json() const;
    std::vector<Ratio> totals() const;
};

/// Root of the mean squared difference over the mean, on the pixels that show something in the exact picture.
double relativeError(const Image& image, const Image& exact);

/// Finds what the budget chooses on one scene for each wanted error.
///
/// @param prover  has budget(wanted), a Result<BudgetResult>
template <class Prover>
Status proveWantedErrors(Prover& prover, const std::string& scene, BudgetReport& report) {
    for (const float wanted : kWantedErrors) {
        Result<BudgetResult> result = prover.budget(wanted);
        if (!result) return result.error();
        result->scene = scene;
        report.results.push_back(std::move(*result));
    }
    return Done{};
}

} // namespace lucent::measure
