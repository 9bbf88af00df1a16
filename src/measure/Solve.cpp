#include "measure/Solve.h"

#include "measure/SubsurfaceTruth.h"
#include "measure/TruthModel.h"
#include "technique/Technique.h"
#include "truth/Glass.h"
#include "truth/LightTracer.h"
#include "truth/RenderRelief.h"

#include <atomic>

namespace lucent::measure {

Result<truth::Picture> solveWhatIsShown(const scene::Scene& scene, int directions, const truth::Tile& part,
                                        int threads) {
    const std::atomic<bool> never{false};
    const truth::Work work{.threads = threads};
    const truth::Model drawn = technique::modelOf(scene);
    switch (usualTruth(scene)) {
    case TruthModel::Light: {
        constexpr std::int64_t kRaysOfAPixel = 800; // 0.7 % of noise in cells of 5 x 5 that all of them meet
        const std::int64_t pixels = std::int64_t(scene.size.x) * scene.size.y;
        return truth::traceLight(
            scene, scene.size,
            {.photons = part.photons(kRaysOfAPixel * pixels), .seed = std::uint64_t(part.index)}, {}, work,
            never);
    }
    case TruthModel::Dipole:
        return solveSubsurface(scene, part, threads);
    case TruthModel::Glass: {
        const auto estimator = truth::GlassEstimator::create(scene, scene.size, scene.view.show,
                                                             {.attenuation = drawn.attenuation});
        return estimator ? render(*estimator, scene.size, part, work, never) : estimator.error();
    }
    case TruthModel::Relief:
        break;
    }
    if (Status known = truth::checkAov(scene.view.show); !known) return known.error();
    const truth::ReliefOptions options{
        .attenuation = drawn.attenuation, .environmentLights = directions, .normalise = drawn.normalise};
    return render(truth::ReliefEstimator(scene, scene.size, scene.view.show, options), scene.size, part, work,
                  never);
}

} // namespace lucent::measure
