#pragma once
/// Parts of the benchmark for tests.

#include "measure/Solve.h"
#include "measure/TechniqueBench.h"
#include "scene/Mesh.h"

#include <gtest/gtest.h>

namespace lucent::support {

/// A ball by the name of the bunny, and nothing else.
struct RoundBunny : measure::BenchAssets {
    Result<std::vector<measure::BenchMesh>> meshes(Names names) const override {
        std::vector<measure::BenchMesh> found;
        for (const std::string_view name : names)
            if (name == mesh.name) found.push_back(mesh);
        return found;
    }
    measure::BenchMesh mesh{"bunny", std::make_shared<const scene::Mesh>(meshOf(scene::Sphere{1}, 8))};
};

/// What the sweep measures of a part.
inline measure::Plan planOf(std::string_view part, bool quick,
                            const measure::BenchAssets& assets = measure::BenchAssets()) {
    const auto parts = measure::benchParts(part);
    EXPECT_EQ(parts.size(), 1u) << part;
    Result<measure::Plan> plan = measure::planOf(parts, assets, quick);
    EXPECT_TRUE(plan.ok());
    return std::move(*plan);
}

/// How many of the figures have a target, of a report in which all of these are missed.
inline int countMissed(const measure::Plan& plan, const measure::BenchReport& report) {
    int promised = 0;
    for (const measure::RatioRule& rule : plan.ratios) {
        const std::optional<measure::Ratio> ratio = rule(report);
        EXPECT_TRUE(ratio.has_value());
        if (!ratio || !ratio->target) continue;
        EXPECT_FALSE(ratio->met()) << ratio->name;
        ++promised;
    }
    return promised;
}

/// For Sweep, on one thread.
inline Result<truth::Picture> solveHere(const scene::Scene& scene, int directions, const truth::Tile& part) {
    return measure::solveWhatIsShown(scene, directions, part, 1);
}

} // namespace lucent::support
