#include "scene/ReflectanceTable.h"

#include "scene/ImageUse.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace lucent::scene {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMerlCount = std::size_t(kMerlHalf) * kMerlDifference * kMerlAround;
static_assert(kMerlCount == std::size_t(kMerlSize.x) * std::size_t(kMerlSize.y));
// By which the values of the files are multiplied.
constexpr double kMerlScale[] = {1.0 / 1500, 1.15 / 1500, 1.66 / 1500};
constexpr std::size_t kMerlHeader = 3 * sizeof(std::int32_t);
constexpr double kRim = 0.9999; // of Projected: a direction just above the horizon

std::string sizeText(ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }

Result<std::shared_ptr<const Image>> decodeMerl(std::span<const std::byte> bytes, const std::string& name) {
    std::int32_t sizes[3] = {};
    std::memcpy(sizes, bytes.data(), kMerlHeader);
    const std::int32_t expected[] = {kMerlHalf, kMerlDifference, kMerlAround};
    if (std::memcmp(sizes, expected, sizeof sizes) != 0)
        return Error{name + ": begins with " + std::to_string(sizes[0]) + ", " + std::to_string(sizes[1]) +
                     ", " + std::to_string(sizes[2]) + "; must begin with 90, 90, 180"};
    const std::size_t needed = kMerlHeader + 3 * kMerlCount * sizeof(double);
    if (bytes.size() != needed)
        return Error{name + ": has " + std::to_string(bytes.size()) + " bytes; must have " +
                     std::to_string(needed)};
    auto table = std::make_shared<Image>(kMerlSize.x, kMerlSize.y, 3);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < kMerlCount; ++i) {
            double value;
            std::memcpy(&value, bytes.data() + kMerlHeader + (c * kMerlCount + i) * sizeof value,
                        sizeof value);
            if (!std::isfinite(value))
                return Error{name + ": value " + std::to_string(i) + " of colour " + std::to_string(c) +
                             " is not finite; must be"};
            table->pixels[3 * i + c] = float(kMerlScale[c] * value);
        }
    return std::shared_ptr<const Image>(std::move(table));
}

bool isMerl(std::span<const std::byte> bytes) {
    std::int32_t first = 0;
    if (bytes.size() < kMerlHeader) return false;
    std::memcpy(&first, bytes.data(), sizeof first);
    return first > 0 && first < 0x10000; // no picture begins so
}

// A direction around another one, as MERL's table counts: z is the normal.
dvec3 turned(const dvec3& v, double cosine, double sine) {
    return {cosine * v.x + sine * v.z, v.y, -sine * v.x + cosine * v.z};
}

Image tabulateMerl(const Brdf& brdf) {
    Image table(kMerlSize.x, kMerlSize.y, 3);
    for (std::size_t i = 0; i < kMerlCount; ++i) {
        const double around = (double(i % kMerlAround) + 0.5) / kMerlAround * kPi;
        const double difference =
            (double(i / kMerlAround % kMerlDifference) + 0.5) / kMerlDifference * kPi / 2;
        const double root = (double(i / kMerlAround / kMerlDifference) + 0.5) / kMerlHalf;
        const double half = root * root * kPi / 2;
        // The halfway direction in the xz plane, light around it, and the view on its other side.
        const dvec3 apart(std::sin(difference) * std::cos(around), std::sin(difference) * std::sin(around),
                          std::cos(difference));
        const dvec3 toLight = turned(apart, std::cos(half), std::sin(half));
        const dvec3 toEye = turned({-apart.x, -apart.y, apart.z}, std::cos(half), std::sin(half));
        const vec3 value = toLight.z > 0 && toEye.z > 0 ? brdf(toLight, toEye) : vec3(-1);
        std::memcpy(&table.pixels[3 * i], &value, sizeof value);
    }
    return table;
}

// Shirley and Chiu's square of a disc, [-1, 1]² both.
dvec2 squareOfDisc(dvec2 p) {
    const double r = glm::length(p);
    if (r == 0) return dvec2(0);
    double angle = std::atan2(p.y, p.x);
    if (angle < -kPi / 4) angle += 2 * kPi;
    if (angle < kPi / 4) return {r, 4 / kPi * angle * r};
    if (angle < 3 * kPi / 4) return {-4 / kPi * (angle - kPi / 2) * r, r};
    if (angle < 5 * kPi / 4) return {-r, -4 / kPi * (angle - kPi) * r};
    return {4 / kPi * (angle - 3 * kPi / 2) * r, -r};
}
dvec2 discOfSquare(dvec2 q) {
    if (q == dvec2(0)) return dvec2(0);
    const bool isWide = std::abs(q.x) > std::abs(q.y);
    const double r = isWide ? q.x : q.y;
    const double angle = isWide ? kPi / 4 * q.y / q.x : kPi / 2 - kPi / 4 * q.x / q.y;
    return r * dvec2(std::cos(angle), std::sin(angle));
}

// Places beside the middles of texels, and the share of the one behind.
struct Between {
    int low;
    double f;
    explicit Between(double at) : low(int(std::floor(at))), f(at - low) {}
    double share(int step) const { return step ? f : 1 - f; }
    int clamped(int step, int count) const { return std::clamp(low + step, 0, count - 1); }
};

dvec3 lookUpMerl(const Image& table, const dvec3& toLight, const dvec3& toEye) {
    const dvec3 halfway = glm::normalize(toLight + toEye);
    const double half = std::acos(std::clamp(halfway.z, -1.0, 1.0)), phi = std::atan2(halfway.y, halfway.x);
    const dvec3 flat(std::cos(phi) * toLight.x + std::sin(phi) * toLight.y,
                     std::cos(phi) * toLight.y - std::sin(phi) * toLight.x, toLight.z);
    const dvec3 apart = turned(flat, std::cos(half), -std::sin(half));
    double around = std::atan2(apart.y, apart.x);
    if (around < 0) around += kPi;
    const Between i(kMerlHalf * std::sqrt(half / (kPi / 2)) - 0.5),
        j(kMerlDifference * std::acos(std::clamp(apart.z, -1.0, 1.0)) / (kPi / 2) - 0.5),
        k(kMerlAround * around / kPi - 0.5);
    dvec3 sum(0);
    double weights = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
        const std::size_t at = std::size_t(
            ((i.clamped(a, kMerlHalf) * kMerlDifference) + j.clamped(b, kMerlDifference)) * kMerlAround +
            (k.low + c + kMerlAround) % kMerlAround);
        const dvec3 value(table.pixels[3 * at], table.pixels[3 * at + 1], table.pixels[3 * at + 2]);
        if (std::min({value.x, value.y, value.z}) < 0) continue;
        const double weight = i.share(a) * j.share(b) * k.share(c) + 1e-8;
        sum += weight * value;
        weights += weight;
    }
    return weights > 0 ? sum / weights : dvec3(0);
}

// The block and texel around a pair of directions, and the three beside each towards which they lie.
struct Around {
    Between bx, by, tx, ty;
    int n, m;
    Around(TableForm form, int n, int m, const dvec3& toLight, const dvec3& toEye)
        : Around(squareFrom(toLight, form) * double(n) - 0.5, squareFrom(toEye, form) * double(m) - 0.5, n,
                 m) {}
    Around(dvec2 block, dvec2 texel, int n, int m)
        : bx(block.x), by(block.y), tx(texel.x), ty(texel.y), n(n), m(m) {}
    ivec2 block(int corner) const { return {bx.clamped(corner & 1, n), by.clamped(corner >> 1, n)}; }
    ivec2 texel(int corner) const { return {tx.clamped(corner & 1, m), ty.clamped(corner >> 1, m)}; }
    double share(int block, int texel) const {
        return bx.share(block & 1) * by.share(block >> 1) * tx.share(texel & 1) * ty.share(texel >> 1);
    }
};

// @param valueOf  of the corners' numbers of block and texel
template <class ValueOf>
dvec3 mixed(const Around& around, ValueOf valueOf) {
    dvec3 sum(0);
    for (int texel = 0; texel < 4; ++texel)
        for (int block = 0; block < 4; ++block)
            sum += around.share(block, texel) * dvec3(valueOf(block, texel));
    return sum;
}

dvec3 lookUpBlocks(const Image& table, TableForm form, int n, const dvec3& toLight, const dvec3& toEye) {
    const int m = table.width / n;
    const Around around(form, n, m, toLight, toEye);
    return mixed(around, [&](int block, int texel) {
        const ivec2 at = around.block(block) * m + around.texel(texel);
        const float* value = table.at(at.x, at.y);
        return vec3(value[0], value[1], value[2]);
    });
}

dvec3 directionOf(ivec2 at, int count, TableForm form) {
    return directionFrom((dvec2(at) + 0.5) / double(count), form);
}

} // namespace

Status checkTable(const Image& table, TableForm form, int blocks) {
    const ivec2 size = table.size();
    if (form == TableForm::Merl) {
        if (size == kMerlSize) return Done{};
        return Error{"has " + sizeText(size) + " texels; must have " + sizeText(kMerlSize) +
                     ", or be a file of MERL's format"};
    }
    if (size.x != size.y) return Error{"has " + sizeText(size) + " texels; must be as high as wide"};
    const int n = blocksOf(table, blocks);
    if (size.x % n != 0 || (blocks == 0 && n * n != size.x))
        return Error{"has " + std::to_string(size.x) + " texels a side; must have " +
                     (blocks > 0 ? "a multiple of " + std::to_string(n) + " for its blocks"
                                 : "a square number, or name its blocks")};
    return Done{};
}

dvec3 lookUp(const Image& table, TableForm form, int blocks, const dvec3& toLight, const dvec3& toEye) {
    if (toLight.z <= 0 || toEye.z <= 0) return dvec3(0);
    return form == TableForm::Merl ? lookUpMerl(table, toLight, toEye)
                                   : lookUpBlocks(table, form, blocksOf(table, blocks), toLight, toEye);
}

dvec3 lookUp(const Brdf& brdf, TableForm form, int blocks, int texels, const dvec3& toLight,
             const dvec3& toEye) {
    if (toLight.z <= 0 || toEye.z <= 0) return dvec3(0);
    const Around around(form, blocks, texels, toLight, toEye);
    dvec3 lights[4], eyes[4];
    for (int corner = 0; corner < 4; ++corner) {
        lights[corner] = directionOf(around.block(corner), blocks, form);
        eyes[corner] = directionOf(around.texel(corner), texels, form);
    }
    return mixed(around, [&](int block, int texel) { return brdf(lights[block], eyes[texel]); });
}

dvec2 squareFrom(const dvec3& direction, TableForm form) {
    if (form == TableForm::Projected) return 0.5 + 0.5 * dvec2(direction);
    const double aside = glm::length(dvec2(direction));
    const double r = std::sqrt(std::max(0.0, 1 - direction.z));
    return 0.5 + 0.5 * squareOfDisc(aside > 0 ? dvec2(direction) * (r / aside) : dvec2(0));
}

dvec3 directionFrom(dvec2 square, TableForm form) {
    const dvec2 q = 2.0 * square - 1.0;
    if (form == TableForm::Projected) {
        const double r = glm::length(q);
        const dvec2 p = r > kRim ? q * (kRim / r) : q;
        return {p.x, p.y, std::sqrt(1 - glm::dot(p, p))};
    }
    const dvec2 p = discOfSquare(q);
    const double r = glm::length(p), up = std::max(1 - r * r, 1e-6);
    const double aside = std::sqrt(1 - up * up);
    return r > 0 ? dvec3(p.x / r * aside, p.y / r * aside, up) : dvec3(0, 0, 1);
}

int blocksOf(const Image& table, int blocks) {
    return blocks > 0 ? blocks : int(std::lround(std::sqrt(double(table.width))));
}

Image tabulate(const Brdf& brdf, TableForm form, int blocks, int texels) {
    if (form == TableForm::Merl) return tabulateMerl(brdf);
    const int side = blocks * texels;
    Image table(side, side, 3);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const ivec2 at(x, y), block = at / texels, texel = at % texels;
            const vec3 value = brdf(directionOf(block, blocks, form), directionOf(texel, texels, form));
            std::memcpy(table.at(x, y), &value, sizeof value);
        }
    return table;
}

Result<std::shared_ptr<const Image>> decodeTable(std::span<const std::byte> bytes, const std::string& name,
                                                 TableForm form, int blocks) {
    if (form == TableForm::Merl && isMerl(bytes)) return decodeMerl(bytes, name);
    Result<std::shared_ptr<const Image>> picture = decodeColors(bytes, name);
    if (!picture) return picture;
    if (Status size = checkTable(**picture, form, blocks); !size)
        return Error{name + ": " + size.error().message};
    return picture;
}

Bytes encodeMerl(const Image& table) {
    const std::int32_t sizes[] = {kMerlHalf, kMerlDifference, kMerlAround};
    Bytes bytes(kMerlHeader + 3 * kMerlCount * sizeof(double));
    std::memcpy(bytes.data(), sizes, sizeof sizes);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < kMerlCount; ++i) {
            const double value = double(table.pixels[3 * i + c]) / kMerlScale[c];
            std::memcpy(bytes.data() + kMerlHeader + (c * kMerlCount + i) * sizeof value, &value,
                        sizeof value);
        }
    return bytes;
}

} // namespace lucent::scene
