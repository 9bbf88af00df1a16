#include "techniques/throughput/Bake.h"

#include "tests/throughput/Shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::throughput {
namespace {

using namespace shapes;

Bake bakeOf(const scene::Mesh& mesh, const Medium& medium, BakeOptions options) {
    Result<Bake> baked = BakeMaking(std::make_shared<scene::Mesh>(mesh), 1, medium, options).finish();
    EXPECT_TRUE(baked) << baked.error().message;
    return std::move(*baked);
}

BakeOptions with(Local local, int side = 128) {
    BakeOptions options;
    options.side = side;
    options.local = local;
    options.factors.method = Global::Dense; // the others have tests of their own
    return options;
}

vec3 placeOf(const Bake& baked, std::size_t texel) {
    return positionAt(baked.surface.hats, baked.surface.texels.list[texel].place);
}

std::vector<vec3> radiosity(const Bake& baked, const std::function<float(const vec3&)>& light) {
    Lit lit = baked.relight(shapes::lit(baked.surface, light));
    for (std::size_t i = 0; i < lit.local.size(); ++i)
        lit.local[i] += lit.global[i];
    return lit.local;
}

// B at a place of the patch by a fine grid: what is compared with takes nothing from the bake but R_d.
double bruteForce(const Medium& medium, const vec3& place, float extent,
                  const std::function<float(const vec3&)>& light) {
    const Response response(medium, 0.1, 0);
    constexpr int kSteps = 120;
    const float step = 2 * extent / kSteps;
    double sum = 0;
    for (int y = 0; y < kSteps; ++y)
        for (int x = 0; x < kSteps; ++x) {
            const vec3 from((float(x) + 0.5f) * step - extent, (float(y) + 0.5f) * step - extent, 0);
            sum +=
                double(light(from) * response.whole(from, {0, 0, 1}, place).g) * double(step) * double(step);
        }
    return sum;
}

// Half the summed absolute difference over the true sum.
double misplaced(const Bake& baked, float extent, const std::function<float(const vec3&)>& light) {
    const std::vector<vec3> found = radiosity(baked, light);
    double wrong = 0, all = 0;
    for (std::size_t i = 0; i < found.size(); i += 37) {
        if (baked.surface.texels.list[i].own == 0 || glm::length(placeOf(baked, i)) > 1.7f * extent) continue;
        const double exact = bruteForce(baked.medium, placeOf(baked, i), extent, light);
        wrong += std::abs(double(found[i].g) - exact) / 2;
        all += exact;
    }
    return wrong / all;
}

constexpr Local kLocals[] = {Local::Live, Local::Stored};

// What the paper's fit of three numbers a texel misses more of.
double boundOf(Local local, double live, double stored) { return local == Local::Live ? live : stored; }

// The patch is 20 mm wide, more than 20 / sigma_tr; what is looked at is a square of 6 mm in its middle.
// Vertices stand 3.4, 1.7 and 0.85 z_r apart.
TEST(Bake, EvenLightLeavesAsOfAHalfSpaceWhereverVerticesStand) {
    for (const Local local : kLocals)
        for (const int cells : {16, 40}) {
            const Bake baked = bakeOf(patch(0.02f, cells), dense(), with(local, 96));
            const std::vector<vec3> found = radiosity(baked, [](const vec3&) { return 1.0f; });
            const vec3 exact = Response(dense(), 0.03, 0).total();
            float worst = 0;
            for (std::size_t i = 0; i < found.size(); ++i) {
                const vec3 place = glm::abs(placeOf(baked, i));
                if (baked.surface.texels.list[i].own == 0 || std::max(place.x, place.y) > 0.003f) continue;
                for (int c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(found[i][c] / exact[c] - 1));
            }
            EXPECT_LT(worst, 0.01f) << int(local) << ' ' << cells; // 0.001 to 0.003
            EXPECT_GT(worst, 0);
        }
}

TEST(Bake, WithoutBlendingCloseLightCountsTwice) {
    BakeOptions options = with(Local::Stored);
    options.blend = Blend::None;
    const Bake baked = bakeOf(patch(0.02f, 32), dense(), options);
    const std::vector<vec3> found = radiosity(baked, [](const vec3&) { return 1.0f; });
    float middle = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        if (glm::length(placeOf(baked, i)) < 0.002f) middle = std::max(middle, found[i].g);
    EXPECT_GT(middle, 1.2f * Response(dense(), 0.03, 0).total().g);
}

float board(const vec3& p) {
    const auto square = [](float x) { return int(std::floor(x / 0.001f)); };
    return (square(p.x) + square(p.y)) % 2 == 0 ? 1.0f : 0.0f;
}

// Figure 6: a checkerboard of 1 mm squares on triangles 0.6 mm wide.
TEST(Bake, ABoardOfSharpSquaresIsPlacedRightByAThirdOfTheErrorWithoutBlending) {
    const auto seen = [](const vec3& p) {
        return std::max(std::abs(p.x), std::abs(p.y)) < 0.004f ? board(p) : 0;
    };
    BakeOptions plain = with(Local::Stored, 160);
    plain.blend = Blend::None;
    const double without = misplaced(bakeOf(patch(0.02f, 32), dense(), plain), 0.004f, seen);
    for (const Local local : kLocals) {
        const double blended = misplaced(bakeOf(patch(0.02f, 32), dense(), with(local, 160)), 0.004f, seen);
        EXPECT_LT(blended, without / 3) << int(local);
        EXPECT_LT(blended, boundOf(local, 0.03, 0.05)) << int(local); // 0.021 and 0.036 of 0.294
    }
}

TEST(Bake, ASpotIsPlacedRight) {
    const auto spot = [](const vec3& p) {
        return glm::length(p - vec3(0.0003f, 0.0001f, 0)) < 0.0015f ? 1.0f : 0.0f;
    };
    for (const Local local : kLocals)
        EXPECT_LT(misplaced(bakeOf(patch(0.02f, 40), dense(), with(local, 200)), 0.002f, spot), 0.03)
            << int(local);
}

// One of the triangle's three vertices takes most of it.
TEST(Bake, ATriangleLitAtOneCornerLeavesTheLightThatFellThere) {
    const float cell = 0.02f / 16;
    const auto corner = [&](const vec3& p) { return glm::length(p) < 0.4f * cell ? 1.0f : 0.0f; };
    for (const Local local : kLocals) {
        const Bake baked = bakeOf(patch(0.02f, 16), dense(), with(local, 160));
        const std::vector<vec3> found = radiosity(baked, corner);
        double leaving = 0, entering = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            leaving += double(found[i].g * baked.surface.texels.list[i].own);
            entering += double(corner(placeOf(baked, i)) * baked.surface.texels.list[i].own);
        }
        EXPECT_NEAR(leaving / entering / double(Response(dense(), 0.03, 0).total().g), 1,
                    boundOf(local, 0.03, 0.1))
            << int(local);
    }
}

// On a ball of the dense medium light reaches so little that the radiosity of even light is nearly one:
// charts' borders would show.
TEST(Bake, ChartsShowNoSeams) {
    for (const Local local : kLocals) {
        const Bake baked = bakeOf(scene::meshOf(scene::Sphere{0.006f}, 40), dense(), with(local, 144));
        const std::vector<vec3> found = radiosity(baked, [](const vec3&) { return 1.0f; });
        float least = 1e30f, most = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            if (baked.surface.texels.list[i].own > 0) {
                least = std::min(least, found[i].g);
                most = std::max(most, found[i].g);
            }
        EXPECT_LT(most / least, 1.02f) << int(local); // 1 % up or down; the ball itself is of triangles
    }
}

// 1 mm thick: light passes to the other side, and no filter of texels goes there.
TEST(Bake, AThinClosedWallShinesThrough) {
    const scene::Mesh wall = scene::meshOf(scene::Box{{0.02f, 0.02f, 0.001f}}, 20);
    const auto front = [](const vec3& p) { return p.z > 0.00049f ? 1.0f : 0.0f; };
    const double exact = bruteForce(dense(), {0, 0, -0.001f}, 0.01f, [](const vec3&) { return 1.0f; });
    for (const Local local : kLocals) {
        const Bake baked = bakeOf(wall, dense(), with(local, 128));
        const std::vector<vec3> found = radiosity(baked, front);
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const vec3 place = placeOf(baked, i);
            if (place.z > -0.00049f || std::max(std::abs(place.x), std::abs(place.y)) > 0.003f) continue;
            sum += double(found[i].g);
            ++count;
        }
        ASSERT_GT(count, 100);
        EXPECT_NEAR(sum / count / exact, 1, boundOf(local, 0.02, 0.05)) << int(local);
    }
}

TEST(Bake, BearsNeedlesAndVerticesApart) {
    scene::Mesh mesh = patch(0.01f, 12);
    const auto add = [&](vec3 a, vec3 b, vec3 c) {
        for (const vec3& p : {a, b, c}) {
            mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
            mesh.positions.push_back(0.01f * p);
            mesh.normals.push_back({0, 0, 1});
        }
    };
    add({1, 0, 0}, {2, 0, 0}, {1.5f, 1e-4f, 0});
    add({3, 0, 0}, {4, 0, 0}, {3.5f, 0, 0});
    mesh.positions.push_back(vec3(1));
    mesh.normals.push_back({0, 0, 1});
    for (const Local local : kLocals)
        for (const vec3& value :
             radiosity(bakeOf(mesh, dense(), with(local)), [](const vec3&) { return 1.0f; }))
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(value[c] > -1e-4f && value[c] < 1.05f) << int(local) << ' ' << value[c];
}

TEST(Bake, InSlicesComesToTheSameAndTellsHowFarItIs) {
    for (const Local local : kLocals) {
        const auto mesh = std::make_shared<scene::Mesh>(patch(0.02f, 16));
        const Bake whole = bakeOf(*mesh, dense(), with(local));
        BakeMaking making(mesh, 1, dense(), with(local), 1);
        std::optional<Result<Bake>> made;
        double last = 0;
        int slices = 0;
        for (; !(made = making.advance(0)); ++slices) {
            EXPECT_GE(making.share(), last);
            last = making.share();
        }
        EXPECT_GT(slices, 500); // of one piece each
        EXPECT_GT(last, 0.9);
        ASSERT_TRUE(*made) << made->error().message;
        EXPECT_EQ((*made)->factors, whole.factors);
        EXPECT_EQ((*made)->filters, whole.filters);
        EXPECT_EQ((*made)->reach, whole.reach);
        EXPECT_EQ((*made)->surface.duals.values, whole.surface.duals.values);
    }
}

TEST(Bake, CanBeLeftInTheMiddle) {
    for (const Local local : kLocals) {
        BakeMaking making(std::make_shared<scene::Mesh>(patch(0.02f, 16)), 1, dense(), with(local));
        while (making.share() < 0.5)
            ASSERT_FALSE(making.advance(1));
    }
}

} // namespace
} // namespace lucent::throughput
