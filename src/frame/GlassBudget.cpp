#include "frame/GlassBudget.h"

#include "base/Text.h"
#include "frame/Renderer.h"
#include "light/Samples.h"
#include "techniques/brdf/Brdf.h"

#include <algorithm>
#include <cmath>

namespace lucent::frame {

namespace {

// Cheapest first. The last one is only drawn to be compared with.
constexpr int kPoints[] = {1, 4, 16, 64, 256};
constexpr int kGrids[] = {32, 64, 128, 256, 512};
constexpr int kTexelsPerRay = 4; // along a side of the map, as the techniques' defaults have it
constexpr int kLayers[] = {2, 4, 8, 16};
constexpr float kFinerHas =
    2; // the finer candidate has half the error: what it changes, times this, is all of it

bool hasLargeLamp(const scene::Scene& scene) {
    return views::lampPoints(scene, 4).size() > views::lampPoints(scene, 1).size();
}

template <class Settings>
Settings& settingsOf(scene::Scene& scene, const char* technique) {
    return *static_cast<Settings*>(scene.technique.at(technique).data());
}

bool covered(const Image& image, std::size_t pixel) { return image.pixels[4 * pixel + 3] > 0; }

// RMSE over the mean of the finer picture, over what it covers.
float differenceOf(const Image& coarse, const Image& fine) {
    double squares = 0, mean = 0;
    for (std::size_t i = 0; i < fine.pixels.size() / 4; ++i)
        for (std::size_t c = 4 * i; c < 4 * i + 3 && covered(fine, i); ++c) {
            const double d = double(coarse.pixels[c]) - double(fine.pixels[c]);
            squares += d * d;
            mean += double(fine.pixels[c]);
        }
    double count = 0;
    for (std::size_t i = 0; i < fine.pixels.size() / 4; ++i)
        count += covered(fine, i) ? 3 : 0;
    return count > 0 && mean > 0 ? float(std::sqrt(squares / count) / (mean / count)) : 0;
}

// Median angle between directions where both pictures know one and glass is seen, degrees.
float medianAngle(const Image& coarse, const Image& fine, const Image& layers) {
    std::vector<float> angles;
    for (std::size_t i = 0; i < fine.pixels.size() / 4; ++i) {
        if (layers.pixels[4 * i] == 0 || !covered(fine, i)) continue;
        const auto direction = [&](const Image& image) {
            return vec3(image.pixels[4 * i], image.pixels[4 * i + 1], image.pixels[4 * i + 2]);
        };
        const vec3 a = direction(coarse), b = direction(fine);
        angles.push_back(covered(coarse, i)
                             ? glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)))
                             : 180);
    }
    if (angles.empty()) return 0;
    const auto middle = angles.begin() + std::ptrdiff_t(angles.size() / 2);
    std::nth_element(angles.begin(), middle, angles.end());
    return *middle;
}

} // namespace

std::string GlassBudget::Choice::text() const {
    std::string text;
    if (lightSamples > 0) text += std::to_string(lightSamples) + " points a lamp, ";
    if (grid > 0) text += std::to_string(grid) + " rays a side, ";
    if (maxLayers > 0) text += std::to_string(maxLayers) + " layers, ";
    text += "error about " + shortest(std::round(predicted * 1e4f) / 100) + " %";
    return kept ? text : text + ": nothing keeps the wanted error";
}

scene::Scene GlassBudget::Choice::applied(const scene::Scene& scene) const {
    scene::Scene applied = scene;
    auto& caustics = settingsOf<caustics::Settings>(applied, "caustics");
    if (lightSamples > 0)
        caustics.lightSamples = settingsOf<brdf::Settings>(applied, "brdf").lightSamples = lightSamples;
    if (grid > 0) {
        caustics.grid = grid;
        caustics.mapSize = mapSize;
    }
    if (maxLayers > 0) settingsOf<refract::Settings>(applied, "refract").maxLayers = maxLayers;
    return applied;
}

GlassBudget::GlassBudget(gl::Context& context) : context_(context) {}
GlassBudget::~GlassBudget() = default;

bool GlassBudget::matters(const scene::Scene& scene) {
    const bool shades = need(scene, "brdf").has_value();
    return need(scene, "refract") || need(scene, "caustics") || (shades && hasLargeLamp(scene));
}

void GlassBudget::start(const scene::Scene& scene, ivec2 size) {
    const float longer = float(std::max(size.x, size.y));
    size_ = glm::max(ivec2(vec2(size) * std::min(1.0f, float(kMostSide) / longer)), ivec2(1));
    choice_ = {};
    const bool shades = need(scene, "brdf").has_value();
    int parts = 0;
    if (shades && hasLargeLamp(scene)) choice_.lightSamples = kPoints[0], ++parts;
    if (need(scene, "caustics"))
        choice_.grid = kGrids[0], choice_.mapSize = kTexelsPerRay * kGrids[0], ++parts;
    if (need(scene, "refract")) choice_.maxLayers = views::kMostLayers, ++parts;
    wanted_ = scene.quality.maxError / std::sqrt(float(std::max(1, parts)));
    begin(Phase::Points);
}

// The next part in which there is something to choose.
void GlassBudget::begin(Phase phase) {
    phase_ = phase;
    next_ = 0;
    finer_ = Image();
    if (phase_ == Phase::Points && choice_.lightSamples == 0) phase_ = Phase::Grid;
    if (phase_ == Phase::Grid && choice_.grid == 0) phase_ = Phase::Layers;
    if (phase_ == Phase::Layers && choice_.maxLayers == 0) phase_ = Phase::Done;
    if (phase_ == Phase::Done) trial_.reset();
}

Status GlassBudget::step(const scene::Scene& scene) {
    switch (phase_) {
    case Phase::Points:
        return tryPoints(scene);
    case Phase::Grid:
        return tryGrid(scene);
    case Phase::Layers:
        return tryLayers(scene);
    case Phase::Done:
        break;
    }
    return Done{};
}

Result<Image> GlassBudget::draw(const scene::Scene& scene, const Choice& choice, scene::Aov show) {
    if (!trial_) trial_ = std::make_unique<Renderer>(context_);
    scene::Scene trial = choice.applied(scene);
    trial.quality.maxError = 0;
    trial.view.show = show;
    if (Status finished = trial_->finish(trial, ++trials_, size_); !finished) return finished.error();
    return trial_->read(trial, show);
}

Result<float> GlassBudget::errorOf(const scene::Scene& scene, const Choice& coarse, const Choice& fine) {
    if (finer_.pixels.empty()) {
        Result<Image> image = draw(scene, coarse, scene::Aov::Color);
        if (!image) return image.error();
        finer_ = std::move(*image);
    }
    Result<Image> image = draw(scene, fine, scene::Aov::Color);
    if (!image) return image.error();
    const float error = kFinerHas * differenceOf(finer_, *image);
    finer_ = std::move(*image);
    return error;
}

void GlassBudget::add(float error) {
    choice_.predicted = std::sqrt(choice_.predicted * choice_.predicted + error * error);
    if (error > wanted_) choice_.kept = false;
}

Status GlassBudget::tryPoints(const scene::Scene& scene) {
    Choice fine = choice_;
    fine.lightSamples = kPoints[next_ + 1];
    const Result<float> error = errorOf(scene, choice_, fine);
    if (!error) return error.error();
    if (*error > wanted_ && next_ + 2 < std::size(kPoints)) {
        choice_.lightSamples = kPoints[++next_];
        return Done{};
    }
    add(*error);
    begin(Phase::Grid);
    return Done{};
}

Status GlassBudget::tryGrid(const scene::Scene& scene) {
    Choice fine = choice_;
    fine.grid = kGrids[next_ + 1];
    fine.mapSize = kTexelsPerRay * fine.grid;
    const Result<float> error = errorOf(scene, choice_, fine);
    if (!error) return error.error();
    if (*error > wanted_ && next_ + 2 < std::size(kGrids)) {
        choice_.grid = kGrids[++next_];
        choice_.mapSize = kTexelsPerRay * choice_.grid;
        return Done{};
    }
    add(*error);
    begin(Phase::Layers);
    return Done{};
}

// All layers are the finer picture: what has fewer must keep the directions and the light.
Status GlassBudget::tryLayers(const scene::Scene& scene) {
    Image exact[3], fewer[2];
    const scene::Aov shown[] = {scene::Aov::Color, scene::Aov::Direction, scene::Aov::Layers};
    for (int i = 0; i < 3; ++i) {
        Result<Image> image = draw(scene, choice_, shown[i]);
        if (!image) return image.error();
        exact[i] = std::move(*image);
    }
    for (const int layers : kLayers) {
        Choice candidate = choice_;
        candidate.maxLayers = layers;
        for (int i = 0; i < 2; ++i) {
            Result<Image> image = draw(scene, candidate, shown[i]);
            if (!image) return image.error();
            fewer[i] = std::move(*image);
        }
        const float error = differenceOf(fewer[0], exact[0]),
                    degrees = medianAngle(fewer[1], exact[1], exact[2]);
        if (error > wanted_ || degrees > kDegrees * scene.quality.maxError) continue;
        choice_.maxLayers = layers;
        choice_.degrees = degrees;
        add(error);
        break;
    }
    begin(Phase::Done);
    return Done{};
}

} // namespace lucent::frame
