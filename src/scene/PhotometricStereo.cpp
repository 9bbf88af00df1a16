#include "scene/PhotometricStereo.h"

#include "base/Text.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

namespace lucent::scene {
namespace {

constexpr std::size_t kLeastPhotos = 3, kMostPhotos = 512;

// --- light files

// The next line without its ends; nothing at the end of the text.
std::optional<std::string_view> nextLine(std::string_view& text) {
    if (text.empty()) return std::nullopt;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
        line.remove_suffix(1);
    return line;
}

// Takes the last word of a line.
std::string_view lastWord(std::string_view& line) {
    const std::size_t end = line.find_last_not_of(" \t") + 1;
    const std::size_t begin = line.substr(0, end).find_last_of(" \t") + 1;
    const std::string_view word = line.substr(begin, end - begin);
    line = line.substr(0, begin);
    return word;
}

// "FILE X Y Z"; a name may hold blanks.
std::optional<LitPhoto> readPhoto(std::string_view line) {
    LitPhoto photo;
    for (const int axis : {2, 1, 0}) {
        const std::optional<double> number = numberIn(lastWord(line));
        if (!number) return std::nullopt;
        photo.light[axis] = *number;
    }
    const std::size_t begin = line.find_first_not_of(" \t"), end = line.find_last_not_of(" \t") + 1;
    const double length = glm::length(photo.light);
    if (begin >= end || !(length > 0)) return std::nullopt;
    photo.light /= length;
    photo.file = line.substr(begin, end - begin);
    std::replace(photo.file.begin(), photo.file.end(), '\\', '/');
    return photo;
}

using Matrix = glm::dmat3;

// How far directions are from lying in a plane: 0 there, 1 where all axes are told equally well.
double spreadOf(std::span<const LitPhoto> photos) {
    Matrix sum(0);
    for (const LitPhoto& photo : photos)
        sum += glm::outerProduct(photo.light, photo.light);
    return 27 * glm::determinant(sum / double(photos.size()));
}

} // namespace

Result<std::vector<LitPhoto>> parseLightFile(std::span<const std::byte> bytes, const std::string& name) {
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::string_view first = nextLine(text).value_or("");
    const double count = numberIn(first).value_or(0);
    if (count < kLeastPhotos || count > kMostPhotos || count != std::floor(count))
        return Error{name + ":1: is " + inQuotes(first.substr(0, 40)) +
                     "; must be the number of photographs, " + std::to_string(kLeastPhotos) + " to " +
                     std::to_string(kMostPhotos)};
    std::vector<LitPhoto> photos;
    for (int number = 2; photos.size() < std::size_t(count); ++number) {
        const auto line = nextLine(text);
        if (!line)
            return Error{name + ": lists " + std::to_string(photos.size()) + " photographs; must list " +
                         std::to_string(int(count)) + ", as its first line says"};
        if (line->empty()) continue;
        auto photo = readPhoto(*line);
        if (!photo)
            return Error{name + ":" + std::to_string(number) + ": is " + inQuotes(line->substr(0, 40)) +
                         "; must be a file and three numbers, where its light comes from"};
        photos.push_back(std::move(*photo));
    }
    if (!(spreadOf(photos) > 1e-6))
        return Error{name + ": all lights lie in one plane; must come from around the surface"};
    return photos;
}

// --- one pixel

// Its luminances under all lights and what a matt surface makes of them.
struct PhotometricStereo::Pixel {
    std::span<const dvec3> lights;
    std::vector<double> values, weights, spare;
    dvec3 surface{0}; // rho n
    double bright = 0;

    double residual(std::size_t k) const { return values[k] - glm::dot(lights[k], surface); }

    // The value that three of four do not reach.
    double upperQuartile() {
        spare = values;
        const auto place = spare.begin() + std::ptrdiff_t(spare.size() * 3 / 4);
        std::nth_element(spare.begin(), place, spare.end());
        return *place;
    }

    // Least squares by the weights; false where they tell too little.
    bool fit() {
        Matrix matrix(0);
        dvec3 right(0);
        double sum = 0;
        for (std::size_t k = 0; k < values.size(); ++k) {
            matrix += weights[k] * glm::outerProduct(lights[k], lights[k]);
            right += weights[k] * values[k] * lights[k];
            sum += weights[k];
        }
        if (!(glm::determinant(matrix / std::max(sum, 1e-30)) > 1e-7)) return false;
        surface = glm::inverse(matrix) * right;
        return true;
    }

    void solve() {
        constexpr double kShadow = 0.1; // of the bright values
        constexpr int kRounds = 20, kTrims = 3;
        bright = upperQuartile();
        surface = {0, 0, bright};
        if (!(bright > 1e-4)) return; // black
        std::vector<char> lit(values.size());
        for (std::size_t k = 0; k < values.size(); ++k)
            weights[k] = lit[k] = values[k] > kShadow * bright;
        if (!fit()) {
            std::fill(weights.begin(), weights.end(), 1.0);
            std::fill(lit.begin(), lit.end(), char(1));
            fit();
        }
        for (int round = 0; round < kRounds; ++round) {
            for (std::size_t k = 0; k < values.size(); ++k)
                weights[k] = lit[k] ? 1 / std::max(std::abs(residual(k)), 1e-3 * bright) : 0;
            if (!fit()) break;
        }
        for (int trim = 0; trim < kTrims; ++trim)
            if (!fitMatt(lit)) break;
    }

    // Once more with the values that the fit explains; those that shone on nothing that faces them are
    // shadows.
    bool fitMatt(std::span<const char> lit) {
        spare.clear();
        for (std::size_t k = 0; k < values.size(); ++k)
            if (lit[k]) spare.push_back(std::abs(residual(k)));
        const auto middle = spare.begin() + std::ptrdiff_t(spare.size() / 2);
        std::nth_element(spare.begin(), middle, spare.end());
        const double albedo = glm::length(surface);
        const double wide = std::clamp(3 * 1.4826 * *middle, 0.02 * albedo, 0.1 * albedo);
        const dvec3 before = surface;
        const std::vector<double> old = weights;
        for (std::size_t k = 0; k < values.size(); ++k)
            weights[k] = std::abs(residual(k)) <= wide && glm::dot(lights[k], surface) > 0;
        if (fit()) return true;
        surface = before;
        weights = old;
        return false;
    }
};

// --- all pixels

PhotometricStereo::PhotometricStereo(std::vector<dvec3> lights, std::size_t mostBytes)
    : lights_(std::move(lights)), mostBytes_(mostBytes) {}

void PhotometricStereo::begin(const Image& photo, const std::string& name) {
    first_ = name;
    photoSize_ = photo.size();
    const auto sizeAt = [&](int factor) { return (photoSize_ + factor - 1) / factor; };
    const auto bytesAt = [&](int factor) {
        return std::size_t(sizeAt(factor).x) * std::size_t(sizeAt(factor).y) * lights_.size() * 3 * 2;
    };
    while (bytesAt(reduction_) > mostBytes_ && reduction_ < std::max(photoSize_.x, photoSize_.y))
        ++reduction_;
    const ivec2 size = sizeAt(reduction_);
    maps_.normals = maps_.albedo = Image(size.x, size.y, 3);
    maps_.residual = Image(size.x, size.y, 1);
    values_.resize(bytesAt(reduction_) / 2);
}

Status PhotometricStereo::add(const Image& photo, const std::string& name) {
    if (added_ == 0) begin(photo, name);
    if (photo.size() != photoSize_)
        return Error{name + ": is " + std::to_string(photo.width) + " x " + std::to_string(photo.height) +
                     " pixels; must be " + std::to_string(photoSize_.x) + " x " +
                     std::to_string(photoSize_.y) + ", as " + first_};
    const ivec2 size = maps_.normals.size();
    std::uint16_t* value = values_.data() + 3 * added_;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x, value += 3 * lights_.size()) {
            const ivec2 from = reduction_ * ivec2(x, y), to = glm::min(from + reduction_, photoSize_);
            vec3 sum(0);
            for (int v = from.y; v < to.y; ++v)
                for (int u = from.x; u < to.x; ++u) {
                    const float* pixel = photo.at(u, v);
                    sum += photo.channels < 3 ? vec3(pixel[0]) : vec3(pixel[0], pixel[1], pixel[2]);
                }
            sum /= float((to.x - from.x) * (to.y - from.y));
            for (int c = 0; c < 3; ++c)
                value[c] = glm::packHalf1x16(std::clamp(sum[c], 0.0f, 65504.0f));
        }
    ++added_;
    return Done{};
}

void PhotometricStereo::solveRow(int y) {
    constexpr double kLeastZ = 0.05;
    const std::size_t count = lights_.size();
    Pixel pixel{lights_, std::vector<double>(count), std::vector<double>(count), {}};
    std::vector<dvec3> colors(count);
    const std::uint16_t* value =
        values_.data() + std::size_t(y) * std::size_t(maps_.normals.width) * count * 3;
    for (int x = 0; x < maps_.normals.width; ++x) {
        for (std::size_t k = 0; k < count; ++k, value += 3) {
            for (int c = 0; c < 3; ++c)
                colors[k][c] = double(glm::unpackHalf1x16(value[c]));
            pixel.values[k] = (colors[k].x + colors[k].y + colors[k].z) / 3;
        }
        pixel.solve();
        const bool isBlack = !(pixel.bright > 1e-4);
        dvec3 normal = isBlack ? dvec3(0, 0, 1) : glm::normalize(pixel.surface);
        normal = glm::normalize(dvec3(normal.x, normal.y, std::max(normal.z, kLeastZ)));
        dvec3 albedo(0);
        double shades = 0, squares = 0, used = 0;
        for (std::size_t k = 0; k < count && !isBlack; ++k) {
            const bool isMatt = pixel.weights[k] > 0;
            const double shade = std::max(glm::dot(normal, lights_[k]), 0.0);
            left_ += !isMatt;
            if (!isMatt) continue;
            albedo += shade * colors[k];
            shades += shade * shade;
            squares += pixel.residual(k) * pixel.residual(k);
            ++used;
        }
        const double all = glm::length(pixel.surface);
        const double share = used > 0 && all > 0 ? squares / used / (all * all) : 0;
        squares_ += share;
        lit_ += !isBlack;
        for (int c = 0; c < 3; ++c) {
            maps_.normals.at(x, y)[c] = float(normal[c] / 2 + 0.5);
            maps_.albedo.at(x, y)[c] = shades > 0 ? float(albedo[c] / shades) : 0;
        }
        *maps_.residual.at(x, y) = float(std::sqrt(share));
    }
}

void PhotometricStereo::finish() {
    std::vector<float> sorted = maps_.albedo.pixels;
    const auto place = sorted.begin() + std::ptrdiff_t(double(sorted.size() - 1) * 0.999);
    std::nth_element(sorted.begin(), place, sorted.end());
    const float white = std::max(*place, 1e-6f);
    for (float& value : maps_.albedo.pixels)
        value = std::clamp(value / white, 0.0f, 1.0f);
    const double lit = std::max(double(lit_), 1.0);
    maps_.rms = float(std::sqrt(squares_ / lit));
    maps_.leftOut = float(double(left_) / (lit * double(lights_.size())));
}

double PhotometricStereo::step(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    const int rows = maps_.normals.height;
    if (added_ < lights_.size()) return 0;
    while (row_ < rows) {
        solveRow(row_++);
        if (row_ == rows) finish();
        if (Clock::now() >= end) break;
    }
    return double(row_) / rows;
}

} // namespace lucent::scene
