#include "scene/Memory.h"

#include "base/Text.h"
#include "scene/Mesh.h"

#include <cmath>

namespace lucent::scene {
namespace {

// Peaks as they grow from one size to four times as much, with room for what a page keeps beside them: 306
// bytes a vertex, 48 of them textures of llvmpipe; 54 a painted texel; 12 a height. A page draws the largest
// sheet that this lets pass (tests/web/limits.test.mjs).
constexpr double kBytesPerVertex = 240, kBytesPerPaintTexel = 80, kBytesPerHeight = 24;

std::string inGiB(double bytes) { return shortest(std::ceil(bytes / 0x1p30 * 10) / 10) + " GiB"; }

} // namespace

double bytesOf(const Water& water) {
    const ivec2 cells = waterCells(water);
    return kBytesPerVertex * double(cells.x + 1) * double(cells.y + 1);
}

double bytesOfBody(const HeightField& field) {
    const ivec2 grid = field.texels() + 2;
    return 2 * kBytesPerVertex * double(grid.x) * double(grid.y);
}

double bytesOfPaint(int side) { return kBytesPerPaintTexel * double(side) * double(side); }

double bytesOfHeights(ivec2 resolution) {
    return kBytesPerHeight * double(resolution.x) * double(resolution.y);
}

std::string whyTooLarge(const std::string& value, double bytes) {
    if (bytes <= kMostBytes) return "";
    return " is " + value + ": with it all objects take about " + inGiB(bytes) +
           " of memory; must take at most " + inGiB(kMostBytes);
}

} // namespace lucent::scene
