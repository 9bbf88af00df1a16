// Directions of light behind glass as figures.
#include "measure/BenchReport.h"
#include "measure/MeshSeries.h"
#include "scene/Mesh.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>

namespace lucent::measure {
namespace {

/// Directions along -z, all of them there.
Image straight(int size) {
    Image image(size, size, 4);
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        image.pixels[i + 2] = -1;
        image.pixels[i + 3] = 1;
    }
    return image;
}

void turn(Image& image, ivec2 at, double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    image.at(at.x, at.y)[0] = 3 * float(std::sin(angle)); // of any length
    image.at(at.x, at.y)[2] = -3 * float(std::cos(angle));
}

TEST(Directions, AreComparedInDegreesWhereThereIsGlass) {
    // 10 x 10 pixels: the left column shows no glass, and one pixel has no exact direction: 89 count.
    // Silhouettes and the picture's border take column 1, the rows at the border and the last column: 7 x 8
    // are inside.
    const Image exact = [] {
        Image image = straight(10);
        image.at(5, 0)[3] = 0;
        return image;
    }();
    Image layers(10, 10, 1), found = straight(10);
    for (int y = 0; y < 10; ++y)
        for (int x = 1; x < 10; ++x)
            *layers.at(x, y) = 2;
    for (int y = 0; y < 10; ++y) {
        turn(found, {0, y}, 90); // no glass
        turn(found, {1, y}, 20); // the silhouette
        for (int x = 2; x < 10; ++x)
            turn(found, {x, y}, 0.01);
    }
    turn(found, {4, 4}, 150);
    found.at(6, 6)[3] = 0;
    const Result<Metrics> metrics = compareDirections(found, "found", exact, layers);
    ASSERT_TRUE(metrics.ok()) << metrics.error().message;
    ASSERT_TRUE(metrics->angles.has_value());
    const auto& [all, inside] = *metrics->angles;
    EXPECT_EQ(all.pixels, 89);
    EXPECT_EQ(inside.pixels, 56);
    EXPECT_NEAR(all.median, 0.01, 1e-5); // rounding of floats, in degrees
    EXPECT_NEAR(all.p95, 20, 1e-5);      // 10 of 88 are that far off, one is farther
    EXPECT_NEAR(all.p99, 150, 1e-5);     // 99 % of 88 are all of them
    EXPECT_NEAR(inside.p95, 0.01, 1e-5);
    EXPECT_NEAR(inside.p99, 150, 1e-5); // one of 55
    EXPECT_NEAR(all.lost, 1 / 89.0, 1e-12);
    EXPECT_NEAR(inside.lost, 1 / 56.0, 1e-12);

    JsonWriter json;
    json.beginObject();
    writeMembers(json, *metrics);
    json.end();
    const auto parsed = nlohmann::json::parse(json.text());
    EXPECT_EQ(parsed["degrees"]["all"]["pixels"], 89);
    EXPECT_NEAR(double(parsed["degrees"]["inside"]["p99"]), 150, 1e-4);

    const Result<Metrics> none = compareDirections(found, "found", exact, Image(10, 10, 1));
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().message, "found: no pixel is covered; at least one must be");
}

TEST(BenchReport, DirectionsAreWeighedByTheirMedianAngle) {
    BenchReport report;
    for (const double median : {0.1, 0.2}) {
        Measurement m;
        m.ms = Spread{1, 1, 1, 1};
        m.error.emplace().rmse = 1 - median; // the other way round
        m.error->angles.emplace().all.median = median;
        report.measurements.push_back(m);
    }
    report.markParetoFronts();
    EXPECT_TRUE(report.measurements[0].pareto);
    EXPECT_FALSE(report.measurements[1].pareto);
    EXPECT_NE(report.text().find("all: 0.1 degrees"), std::string::npos) << report.text();
}

TEST(MeshSeries, MeshesFillTheSamePlace) {
    scene::Mesh mesh = meshOf(scene::Box{{1, 2, 4}});
    for (vec3& position : mesh.positions)
        position = 3.0f * position + vec3(100, 0, 0);
    const scene::Object block = objectOf(BenchMesh{"block", std::make_shared<const scene::Mesh>(mesh)});
    vec3 low(9), high(-9);
    for (const vec3& position : mesh.positions) {
        const vec3 world = vec3(block.transform.worldFromObject() * vec4(position, 1));
        low = glm::min(low, world);
        high = glm::max(high, world);
    }
    EXPECT_NEAR(glm::distance(low, vec3(-0.25f, -0.5f, -1)), 0, 1e-4); // floats near 100 / 6
    EXPECT_NEAR(glm::distance(high, vec3(0.25f, 0.5f, 1)), 0, 1e-4);
}

} // namespace
} // namespace lucent::measure
