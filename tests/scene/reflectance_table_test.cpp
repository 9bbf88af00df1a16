// Tables of BRDFs: their files, and what is read off them.
#include "scene/ReflectanceTable.h"

#include "base/Image.h"
#include "scene/Load.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <numbers>

namespace lucent::scene {
namespace {

constexpr double kPi = std::numbers::pi;

dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// Smooth, reciprocal, another one in each colour, and not the same around the normal.
vec3 smooth(const dvec3& l, const dvec3& v) {
    const double g = 0.2 + 0.1 * l.z * v.z + 0.05 * (l.x * v.x + l.y * v.y);
    return vec3(float(g), float(2 * g), float(0.5 * g));
}

TEST(ReflectanceTable, SquaresHoldEachDirectionOnce) {
    for (const TableForm form : {TableForm::Projected, TableForm::EqualArea})
        for (int i = 0; i < 12; ++i)
            for (int j = 0; j < 12; ++j) {
                const dvec3 d = direction((i + 0.5) / 12 * 0.95 * kPi / 2, 2 * kPi * (j + 0.3) / 12);
                const dvec3 back = directionFrom(squareFrom(d, form), form);
                for (int c = 0; c < 3; ++c)
                    ASSERT_NEAR(back[c], d[c], 1e-9) << i << ' ' << j << ' ' << int(form);
            }
}

TEST(ReflectanceTable, EqualAreaTexelsHaveEqualSolidAngles) {
    // Directions that are even by solid angle fill cells of the square evenly.
    int counts[16] = {};
    constexpr int kSide = 400;
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const dvec2 at = squareFrom(direction(std::acos((i + 0.5) / kSide), 2 * kPi * (j + 0.5) / kSide),
                                        TableForm::EqualArea);
            ++counts[int(at.x * 4) + 4 * int(at.y * 4)];
        }
    for (const int count : counts)
        EXPECT_NEAR(double(count), kSide * kSide / 16.0, 0.02 * kSide * kSide / 16);
}

TEST(ReflectanceTable, IsLookedUpWithoutBeingMadeAsIfItWere) {
    for (const TableForm form : {TableForm::EqualArea, TableForm::Projected}) {
        const Image table = tabulate(smooth, form, 6, 9);
        for (int i = 0; i < 100; ++i) {
            const dvec3 l = direction(0.7 + 0.7 * std::sin(i * 1.7), i * 2.1),
                        v = direction(0.7 + 0.7 * std::sin(i * 0.9), i * 1.3);
            ASSERT_EQ(lookUp(smooth, form, 6, 9, l, v), lookUp(table, form, 6, l, v)) << i;
        }
    }
}

TEST(ReflectanceTable, ReadsBackWhatItWasMadeOf) {
    struct {
        TableForm form;
        double
            error; // of what is linear between texels; the square of a disc has creases along its diagonals
    } const kForms[] = {{TableForm::EqualArea, 0.004}, {TableForm::Projected, 0.002}};
    for (const auto& [form, error] : kForms) {
        const Image table = tabulate(smooth, form, 24, 24);
        for (int i = 0; i < 200; ++i) { // up to 60 degrees: beyond, the projected table has few texels
            const dvec3 l = direction(0.3 + 0.5 * std::sin(i * 1.7), i * 2.1),
                        v = direction(0.5 + 0.5 * std::sin(i * 0.9), i * 1.3);
            const dvec3 found = lookUp(table, form, 24, l, v);
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(found[c], double(smooth(l, v)[c]), error) << i << " form " << int(form);
        }
    }
    // MERL's form has no directions around the normal of its own.
    const auto isotropic = [](const dvec3& l, const dvec3& v) {
        return vec3(float(0.2 + 0.1 * l.z * v.z + 0.05 * glm::dot(l, v)));
    };
    const Image table = tabulate(isotropic, TableForm::Merl, 0, 0);
    for (int i = 0; i < 200; ++i) {
        const dvec3 l = direction(0.3 + 0.5 * std::sin(i * 1.7), i * 2.1),
                    v = direction(0.5 + 0.5 * std::sin(i * 0.9), i * 1.3);
        ASSERT_NEAR(lookUp(table, TableForm::Merl, 0, l, v).x, double(isotropic(l, v).x), 1e-4) << i;
    }
}

TEST(ReflectanceTable, MerlFilesComeAndGo) {
    const Image table = tabulate(smooth, TableForm::Merl, 0, 0);
    const Bytes bytes = encodeMerl(table);
    const auto read = decodeTable(bytes, "a.binary", TableForm::Merl, 0);
    ASSERT_TRUE(read) << read.error().message;
    for (std::size_t i = 0; i < table.pixels.size(); i += 997)
        ASSERT_FLOAT_EQ((*read)->pixels[i], table.pixels[i]);

    const auto message = [](Bytes changed) {
        return decodeTable(changed, "a.binary", TableForm::Merl, 0).error().message;
    };
    Bytes cut(bytes.begin(), bytes.end() - 8);
    EXPECT_EQ(message(cut), "a.binary: has 34992004 bytes; must have 34992012");
    cut.resize(20);
    EXPECT_EQ(message(cut), "a.binary: has 20 bytes; must have 34992012");
    Bytes other = bytes;
    other[0] = std::byte(91);
    EXPECT_EQ(message(other), "a.binary: begins with 91, 90, 180; must begin with 90, 90, 180");
    Bytes infinite = bytes;
    const double value = INFINITY;
    std::memcpy(infinite.data() + 12 + 8 * 5, &value, sizeof value);
    EXPECT_EQ(message(infinite), "a.binary: value 5 of colour 0 is not finite; must be");
}

TEST(ReflectanceTable, PicturesMustHaveBlocks) {
    const auto message = [](ivec2 size, TableForm form, int blocks) {
        const Image image(size.x, size.y, 3);
        const Status legal = checkTable(image, form, blocks);
        return legal ? std::string() : legal.error().message;
    };
    EXPECT_EQ(message({64, 64}, TableForm::Projected, 0), "");
    EXPECT_EQ(message({96, 96}, TableForm::EqualArea, 12), "");
    EXPECT_EQ(message({96, 96}, TableForm::EqualArea, 0),
              "has 96 texels a side; must have a square number, or name its blocks");
    EXPECT_EQ(message({96, 96}, TableForm::EqualArea, 7),
              "has 96 texels a side; must have a multiple of 7 for its blocks");
    EXPECT_EQ(message({96, 64}, TableForm::EqualArea, 8), "has 96 x 64 texels; must be as high as wide");
    EXPECT_EQ(message({96, 64}, TableForm::Merl, 0),
              "has 96 x 64 texels; must have 1800 x 810, or be a file of MERL's format");
}

} // namespace
} // namespace lucent::scene
