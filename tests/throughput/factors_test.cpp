#include "techniques/throughput/Factors.h"

#include "tests/throughput/Shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::throughput {
namespace {

using namespace shapes;

Factors factorsFrom(const Hats& hats, const Response& response, const FactorOptions& options) {
    const FactorRows rows(hats, response, options);
    Factors factors;
    Stages stages;
    addFactors(stages, 1, rows, hats, options, factors);
    const Status done = stages.finish();
    EXPECT_TRUE(done) << done.error().message;
    return factors;
}

vec3 middleOf(const Hats& hats, const Factors& factors) {
    return factors.product(std::vector<vec3>(hats.count(), vec3(1)))[vertexAt(hats, vec3(0))];
}

TEST(Factors, FluxThatVerticesExchangeIsSymmetricOnAFlatPatch) {
    const Hats hats = hatsOf(patch(0.004f, 9), 1);
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
        const Response response(dense(geometry), 0.01, 0);
        const Factors factors = factorsFrom(hats, response, {.method = Global::Dense, .quadrature = false});
        for (std::size_t i = 0; i < hats.count(); ++i)
            for (std::size_t j = 0; j < i; ++j) {
                const vec3 to = float(hats.areas[j]) * factors.dense[j * hats.count() + i],
                           back = float(hats.areas[i]) * factors.dense[i * hats.count() + j];
                EXPECT_LE(glm::length(to - back), 1e-4f * glm::length(to)) << i << ' ' << j;
            }
    }
}

// 20 mm wide: more than 20 / sigma_tr.
TEST(Factors, EvenLightOnAWidePatchLeavesAsMuchAsOfAHalfSpace) {
    for (const int cells : {16, 48}) { // 3 z_r and z_r apart
        const Hats hats = hatsOf(patch(0.02f, cells), 1);
        const Response response(dense(), 0.03, 0);
        const vec3 exact = response.total();
        const vec3 found = middleOf(hats, factorsFrom(hats, response, {.method = Global::Dense})) / exact;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], 1, 0.005) << cells << ' ' << c;
    }
}

TEST(Factors, OnePointAFactorErrsByAThirdWhereVerticesStandWide) {
    const Hats hats = hatsOf(patch(0.02f, 16), 1);
    const Response response(dense(), 0.03, 0);
    const vec3 found =
        middleOf(hats, factorsFrom(hats, response, {.method = Global::Dense, .quadrature = false})) /
        response.total();
    EXPECT_GT(std::abs(found.g - 1), 0.3);
}

// Even light within 3 mm of the middle: at the middle what leaves within a disc, by the profile's closed
// form.
TEST(Factors, VerticesAloneComeNearTheIntegralAsTheyAreMadeMore) {
    const float radius = 0.003f;
    const Medium medium = dense();
    const Response response(medium, 0.03, 0);
    const double exact =
        diffusion::reflectanceWithin(medium.colors[1], diffusion::Shape::Dipole, 0, double(radius));
    double last = 1;
    for (const int cells : {12, 24, 48}) {
        const Surface surface = surfaceFrom(patch(0.02f, cells), 256);
        const auto irradiance =
            lit(surface, [&](const vec3& p) { return glm::length(p) < radius ? 1.0f : 0.0f; });
        std::vector<vec3> vertices(surface.hats.count(), vec3(0));
        for (std::size_t v = 0; v < vertices.size(); ++v)
            for (std::uint32_t k = surface.duals.starts[v]; k < surface.duals.starts[v + 1]; ++k)
                vertices[v] += surface.duals.values[k] * irradiance[surface.duals.columns[k]];
        const Factors factors = factorsFrom(surface.hats, response, {.method = Global::Dense});
        const double error =
            std::abs(double(factors.product(vertices)[vertexAt(surface.hats, vec3(0))].g) / exact - 1);
        EXPECT_LT(error, std::max(0.7 * last, 0.004)) << cells;
        last = error;
    }
    EXPECT_LT(last, 0.01);
}

TEST(Factors, HierarchicalOnesKeepTheirBoundWithFewProducts) {
    const Hats hats = hatsOf(scene::meshOf(scene::Sphere{0.01f}, 72), 1);
    for (const DipoleGeometry geometry : {DipoleGeometry::Planar, DipoleGeometry::Offset}) {
        const Response response(marble(geometry), 0.021, 0);
        const Factors all = factorsFrom(hats, response, {.method = Global::Dense});
        std::vector<vec3> light(hats.count(), vec3(0));
        for (std::size_t i = 0; i < light.size(); ++i) // half of it lit, in stripes
            light[i] =
                vec3(hats.positions[i].x > 0 && std::sin(4000 * hats.positions[i].y) > 0 ? 1.0f : 0.0f);
        const auto exact = all.product(light), even = all.product(std::vector<vec3>(hats.count(), vec3(1)));
        for (const float epsilon : {0.02f, 0.001f}) {
            const Factors few = factorsFrom(hats, response, {.epsilon = epsilon});
            const auto found = few.product(light);
            float worst = 0;
            for (std::size_t j = 0; j < found.size(); ++j)
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(found[j][c] - exact[j][c]) / even[j][c]);
            EXPECT_LE(worst, epsilon);
            EXPECT_GT(worst, 0);
            EXPECT_LT(few.kept(), all.kept() / (epsilon > 0.005f ? 5 : 4)); // of 2,522 vertices
        }
    }
}

TEST(Factors, SparseOnesAreThoseAboveTheThreshold) {
    const Hats hats = hatsOf(scene::meshOf(scene::Sphere{0.01f}, 32), 1);
    const Response response(dense(), 0.021, 0);
    const Factors all = factorsFrom(hats, response, {.method = Global::Dense});
    const Factors sparse = factorsFrom(hats, response, {.method = Global::Sparse, .threshold = 1e-4f});
    const auto isKept = [](const vec3& f) { return std::max({f.r, f.g, f.b}) >= 1e-4f; };
    EXPECT_EQ(sparse.kept(), std::size_t(std::count_if(all.dense.begin(), all.dense.end(), isKept)));
    EXPECT_LT(sparse.kept(), all.kept() / 2);
}

TEST(Factors, SayWhenAllOfThemAreTooMany) {
    const Hats hats = hatsOf(patch(1, 120), 1); // 14,641 vertices
    const Response response(dense(), 2, 0);
    const FactorOptions options{.method = Global::Dense, .quadrature = false};
    const FactorRows rows(hats, response, options);
    Factors factors;
    Stages stages;
    addFactors(stages, 1, rows, hats, options, factors);
    const Status done = stages.finish();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().message,
              "all factors of 14641 vertices are 2453 MiB; must be sparse or hierarchical, or "
              "fewer than 13,377");
}

} // namespace
} // namespace lucent::throughput
