#include "measure/Solve.h"

#include "measure/CausticsPlan.h"
#include "measure/RefractPlan.h"
#include "measure/ReliefPlan.h"
#include "measure/SubsurfaceTruth.h"

namespace lucent::measure {

Result<truth::Picture> solveWhatIsShown(const scene::Scene& scene, int directions, const truth::Tile& part,
                                        int threads) {
    using scene::Aov;
    switch (scene.view.show) {
    case Aov::Direction:
    case Aov::Layers:
        return solveRefraction(scene, part, threads);
    case Aov::Irradiance:
        return solveCaustics(scene, part, threads);
    case Aov::Radiosity:
        return solveSubsurface(scene, part, threads);
    default:
        return solveRelief(scene, directions, part, threads);
    }
}

} // namespace lucent::measure
