#include "techniques/relief/Budget.h"

#include "base/Text.h"
#include "techniques/relief/Transfer.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace lucent::relief {

using graph::Format;
using graph::TextureDesc;
using views::EnvironmentSampling;

namespace {

// By so much may the error of the whole picture exceed the sample's: lucent bench budget.
constexpr float kSafety = 1.25f;

constexpr int kSamplePixels = 1600; // 900 told 1.6 times too little of a field as rough as its texels
constexpr int kFewestCovered = 256; // fewer say too little
// Steps of a factor of the square root of two.
constexpr int kDirections[] = {8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256, 362, 512, 724, 1024, 1448, 2048};
constexpr int kLampSamples[] = {1, 2, 3, 4, 6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256};
constexpr int kMostDirections = 4096, kMostLampSamples = 1024; // of the reference
constexpr int kFinerBy = 4;                                    // a reference than what is held against it

// A transfer that keeps less is rare, and finding that out costs more than directions do: lucent bench
// environment.
constexpr float kTransferReach = 0.004f;

using views::hasEnvironment;

using views::hasLargeLamp;

// The scene's own.
Means meansOf(const scene::Scene& scene) {
    return {scene.technique.at("relief").as<Settings>(), views::samplingOf(scene)};
}

// Light itself, which may be found in several ways, not how one of them finds it.
bool showsLight(const scene::Scene& scene) {
    return scene.view.show == scene::Aov::Color || scene.view.show == scene::Aov::Illumination;
}

// Lights whose own error is a small part of the wanted one: error falls about as the number rises.
int referenceCount(float wanted, int most) { return std::clamp(int(6 / wanted), most / 32, most); }

// About `count` pixels in the picture's shape; odd numbers keep in step with few patterns.
ivec2 sampleSizeFor(ivec2 size, int count) {
    const double aspect = double(size.x) / size.y;
    return ivec2(int(std::sqrt(count * aspect)), int(std::sqrt(count / aspect))) | 1;
}

// The number half-way, by ratio, between one that does not keep the error and the next that does.
int between(int fewer, int more) { return int(std::lround(std::sqrt(double(fewer) * more))); }

} // namespace

std::string Budget::Found::text() const {
    const bool equal = means.light.environment == EnvironmentSampling::Equal;
    std::string text;
    if (environment && means.method == Method::Transfer)
        text = "transfer, ";
    else if (environment)
        text = std::to_string(means.light.directions) + " directions " +
               (equal ? "evenly, " : "by importance, ");
    if (largeLamp) text += std::to_string(means.light.lamp) + " samples a lamp, ";
    text += "error about " + shortest(std::round(predicted * 1e4f) / 100) + " %";
    return kept ? text : text + ": nothing keeps the wanted error";
}

bool Budget::matters(const scene::Scene& scene) const {
    return Relief::need(scene) && (hasEnvironment(scene) || hasLargeLamp(scene)) && showsLight(scene);
}

void Budget::forget() {
    limited_ = choosing_ = false;
    last_.reset();
}

// Transfers that are there already are the cheapest. Without them rays must do until something is chosen.
void Budget::start(const scene::Scene& scene, ivec2 size, bool dragged) {
    limited_ = true;
    dragged_ = dragged;
    choosing_ = false;
    applied_ = meansOf(scene);
    applied_.method = Method::Transfer;
    applied_.terms = kMostTerms;
    if (!dragged) begin(scene, size);
    if (hasEnvironment(scene) && transfers_.ready(scene, applied_)) return;
    if (dragged && last_) {
        applied_ = last_->means;
    } else {
        applied_ = meansOf(scene);
        applied_.method = Method::Hierarchy;
        choosing_ = !dragged;
    }
}

void Budget::begin(const scene::Scene& scene, ivec2 size) {
    wanted_ = scene.quality.maxError / kSafety;
    size_ = size;
    sampleSize_ = sampleSizeFor(size, kSamplePixels);
    choice_ = {meansOf(scene), 0, true, hasEnvironment(scene), hasLargeLamp(scene)};
    choice_.means.method = Method::Hierarchy;
    reference_ = choice_.means;
    reference_.light.environment = EnvironmentSampling::Importance; // nearer for the same number
    reference_.light.directions = referenceCount(wanted_, kMostDirections);
    reference_.light.lamp = hasLargeLamp(scene) ? referenceCount(wanted_, kMostLampSamples) : 1;
    next_ = 0;
    lampDifference_.clear();
    mayTransfer_ = wanted_ >= kTransferReach;
    phase_ = Phase::Surface;
}

Status Budget::step(const scene::Scene& scene) {
    if (Status advanced = advance(scene); !advanced) return advanced;
    if (phase_ != Phase::Done) return Done{};
    last_ = choice_;
    applied_ = choice_.means;
    choosing_ = false;
    return Done{};
}

Status Budget::advance(const scene::Scene& scene) {
    switch (phase_) {
    case Phase::Surface:
        return drawSurface(scene);
    case Phase::Reference:
        return drawReference(scene);
    case Phase::Lamps:
        return tryLamps(scene);
    case Phase::Environment:
        return tryEnvironment(scene);
    case Phase::Done:
        break;
    }
    return Done{};
}

void Budget::apply(scene::Scene& scene) const {
    if (!limited_) return;
    *static_cast<Settings*>(scene.technique.at("relief").data()) = applied_;
    views::samplingOf(scene) = applied_.light;
}

std::optional<technique::Chooser::Choice> Budget::choice() const {
    if (!last_) return std::nullopt;
    return Choice{last_->text(), last_->predicted};
}

Result<bool> Budget::admitsTransfer(const scene::Scene& scene, const RecordTransfers& record) {
    if (!limited_ || dragged_) return true;
    const Result<float> error = errorOfTransfer(scene, record);
    if (!error) return error.error();
    last_ = choice_;
    last_->means = applied_;
    last_->predicted = *error;
    if (*error <= scene.quality.maxError) return true;
    mayTransfer_ = false;
    next_ = 0;
    choice_.means.method = applied_.method = Method::Hierarchy;
    choice_.predicted = 0;
    lampDifference_.clear();
    phase_ = Phase::Surface;
    choosing_ = true;
    return false;
}

// --- samples

Status Budget::drawSurface(const scene::Scene& scene) {
    Result<views::Drawables> drawables = views::drawablesOf(scene, images_);
    if (!drawables) return drawables.error();
    const TextureDesc desc{.size = sampleSize_, .format = Format::RGBA32F};
    if (!surface_ || surface_.desc() != desc)
        surface_ = graph::Texture(context_.device(), desc, "budget.surface");
    graph::FrameGraph graph;
    const graph::TextureId target = graph.import(surface_.handle(), desc, surface_.label());
    graph.keep(target);
    const views::Eye eye = views::makeEye(scene, float(size_.x) / float(size_.y));
    const views::Drawables fields = filtered(visible(*drawables), &views::Drawable::field);
    if (Status s = views::recordSurface(graph, context_, eye, fields, target, sampleSize_); !s) return s;
    if (Status s = graph.compile(); !s) return s;
    graph.execute(pool_);
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    const Image surface = context_.device().read(surface_.handle());
    covered_.clear();
    for (std::size_t i = 0; i < surface.pixels.size() / 4; ++i)
        if (surface.pixels[4 * i + 3] > 0) covered_.push_back(i);
    if (covered_.empty()) {
        phase_ = Phase::Done; // nothing is seen, or too little to matter
    } else if (covered_.size() < kFewestCovered && sampleSize_.x * 2 < size_.x) {
        sampleSize_ = sampleSize_ * 2 + 1;
    } else {
        phase_ = Phase::Reference;
    }
    return Done{};
}

double Budget::meanOf(const Image& image) const {
    double sum = 0;
    for (std::size_t pixel : covered_)
        for (std::size_t c = 0; c < 3; ++c)
            sum += image.pixels[4 * pixel + c];
    return sum / (3.0 * double(covered_.size()));
}

Status Budget::drawReference(const scene::Scene& scene) {
    const Result<Image> base = draw(scene, reference_, Part::Nothing);
    if (!base) return base.error();
    mean_ = meanOf(*base);
    for (const Part part : {Part::Lamps, Part::Environment}) {
        Result<Image> image = draw(scene, reference_, part);
        if (!image) return image.error();
        mean_ += meanOf(*image) - meanOf(*base);
        exact_[int(part)] = std::move(*image);
    }
    phase_ = hasLargeLamp(scene) ? Phase::Lamps : Phase::Environment;
    return Done{};
}

// The sample of the picture by one part of the lights.
Result<Image> Budget::draw(const scene::Scene& scene, const Means& means, Part part,
                           const RecordTransfers* transfers) {
    Result<views::Drawables> drawables = views::drawablesOf(scene, images_);
    if (!drawables) return drawables.error();
    const std::vector<views::DrawnField> fields = fieldsOf(visible(*drawables));
    std::vector<views::LampPoint> lights;
    if (part != Part::Nothing)
        lights = views::lightSamples(scene, {.lamp = means.light.lamp,
                                             .directions = means.light.directions,
                                             .environment = means.light.environment});
    std::erase_if(lights, [&](const views::LampPoint& light) {
        return light.isEnvironment != (part == Part::Environment);
    });
    const int count = int(lights.size());
    const Image table = views::sampleTable(lights);
    gl::Device& device = context_.device();
    const graph::Texture lightTable(device, {.size = table.size(), .format = Format::RGBA32F},
                                    "budget.lights");
    device.upload(lightTable.handle(), 0, table.pixels);
    const TextureDesc desc{.size = sampleSize_, .format = Format::RGBA32F};
    graph::Texture sum(device, desc, "budget.sum"), target(device, desc, "budget.target");
    const views::Eye eye = views::makeEye(scene, float(size_.x) / float(size_.y));
    for (int first = 0; first == 0 || first < count; first += Relief::kMostLightsAtOnce) {
        graph::FrameGraph graph;
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), texture.desc(), texture.label());
        };
        std::vector<Transferred> transferred(transfers ? fields.size() : 0);
        if (transfers && first == 0) {
            auto recorded = (*transfers)(graph);
            if (!recorded) return recorded.error();
            transferred = std::move(*recorded);
        }
        const graph::TextureId targetId = import(target);
        graph.keep(targetId);
        const Inputs in{.eye = eye,
                        .objects = fields,
                        .scene = scene,
                        .lights = lights,
                        .surface = import(surface_),
                        .sum = import(sum),
                        .target = targetId,
                        .lightTable = import(lightTable),
                        .first = first,
                        .end = std::min(count, first + Relief::kMostLightsAtOnce),
                        .placed = transfers ? 0 : count,
                        .transferred = std::move(transferred),
                        .show = scene::Aov::Color,
                        .size = sampleSize_};
        if (Status s = relief_.record(graph, in, means); !s) return s.error();
        if (Status s = graph.compile(); !s) return s.error();
        graph.execute(pool_);
        std::swap(sum, target);
    }
    Image image = device.read(sum.handle());
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    return image;
}

// What a sample of one part of the lights differs by from the exact one.
Result<std::vector<float>> Budget::differenceOf(const scene::Scene& scene, const Means& means, Part part,
                                                const RecordTransfers* transfers) {
    const Result<Image> image = draw(scene, means, part, transfers);
    if (!image) return image.error();
    const Image& exact = exact_[int(part)];
    std::vector<float> difference;
    for (std::size_t pixel : covered_)
        for (std::size_t c = 4 * pixel; c < 4 * pixel + 3; ++c)
            difference.push_back(image->pixels[c] - exact.pixels[c]);
    return difference;
}

// RMSE over the mean of all light; that of the environment with what the lamps chosen before it leave.
Result<float> Budget::errorOf(const scene::Scene& scene, const Means& means, Part part,
                              const RecordTransfers* transfers) {
    Result<std::vector<float>> difference = differenceOf(scene, means, part, transfers);
    if (!difference) return difference.error();
    double sum = 0;
    for (std::size_t i = 0; i < difference->size(); ++i) {
        const double d = double((*difference)[i]) + (lampDifference_.empty() ? 0 : lampDifference_[i]);
        sum += d * d / double(difference->size());
    }
    return float(std::sqrt(sum) / std::max(mean_, 1e-20));
}

Result<float> Budget::errorOfTransfer(const scene::Scene& scene, const RecordTransfers& record) {
    while (phase_ == Phase::Surface || phase_ == Phase::Reference)
        if (Status stepped = step(scene); !stepped) return stepped.error();
    if (covered_.empty()) return 0.0f;
    // As fine as the sum of directions that a transfer stands for.
    if (Status refined = refine(scene, Part::Environment, reference_.light.directions,
                                std::min(kMostDirections / kFinerBy, int(3 / wanted_)), kMostDirections);
        !refined)
        return refined.error();
    return errorOf(scene, applied_, Part::Environment, &record);
}

// --- candidates, cheapest first

Status Budget::tryLamps(const scene::Scene& scene) {
    // Beside an environment they leave it half the squared error.
    const float wanted = hasEnvironment(scene) ? wanted_ / std::sqrt(2.0f) : wanted_;
    const auto attempt = [&](int count) -> Result<float> {
        if (Status refined = refine(scene, Part::Lamps, reference_.light.lamp, count, kMostLampSamples);
            !refined)
            return refined.error();
        Means means = reference_;
        means.light.lamp = count;
        return errorOf(scene, means, Part::Lamps);
    };
    const int count = kLampSamples[next_];
    Result<float> error = attempt(count);
    if (!error) return error.error();
    const bool last = next_ + 1 == std::size(kLampSamples);
    if (*error > wanted && !last) {
        ++next_;
        return Done{};
    }
    choice_.means.light.lamp = count;
    choice_.kept = *error <= wanted;
    const int fewer = next_ > 0 ? between(kLampSamples[next_ - 1], count) : count;
    if (choice_.kept && fewer < count && fewer > kLampSamples[next_ - 1]) {
        const Result<float> less = attempt(fewer);
        if (!less) return less.error();
        if (*less <= wanted) {
            choice_.means.light.lamp = fewer;
            error = less;
        }
    }
    choice_.predicted = *error * kSafety;
    next_ = 0;
    phase_ = Phase::Done;
    if (!hasEnvironment(scene)) return Done{};
    Means means = reference_;
    means.light.lamp = choice_.means.light.lamp;
    auto difference = differenceOf(scene, means, Part::Lamps);
    if (!difference) return difference.error();
    lampDifference_ = std::move(*difference);
    phase_ = Phase::Environment;
    return Done{};
}

// The better of the two ways to place `count` directions. @return its error
Result<float> Budget::tryDirections(const scene::Scene& scene, int count, EnvironmentSampling& better) {
    if (Status refined =
            refine(scene, Part::Environment, reference_.light.directions, count, kMostDirections);
        !refined)
        return refined.error();
    float best = std::numeric_limits<float>::infinity();
    for (EnvironmentSampling sampling : {EnvironmentSampling::Equal, EnvironmentSampling::Importance}) {
        Means means = reference_;
        means.light.environment = sampling;
        means.light.directions = count;
        const Result<float> error = errorOf(scene, means, Part::Environment);
        if (!error) return error.error();
        if (*error >= best) continue;
        best = *error;
        better = sampling;
    }
    return best;
}

Status Budget::tryEnvironment(const scene::Scene& scene) {
    // What a transfer costs at once, more and more directions would cost as well.
    const double pixels =
        double(size_.x) * size_.y * double(covered_.size()) / (sampleSize_.x * sampleSize_.y);
    const int directions = kDirections[next_];
    if (mayTransfer_ && directions * pixels > transferRays(scene)) {
        choice_.means.method = Method::Transfer;
        choice_.means.terms = kMostTerms;
        choice_.predicted = wanted_ * kSafety; // it takes the terms that keep it
        phase_ = Phase::Done;
        return Done{};
    }
    Means& chosen = choice_.means;
    Result<float> error = tryDirections(scene, directions, chosen.light.environment);
    if (!error) return error.error();
    const bool last = next_ + 1 == std::size(kDirections);
    if (*error > wanted_ && !last) {
        ++next_;
        return Done{};
    }
    chosen.light.directions = directions;
    choice_.kept = *error <= wanted_;
    if (choice_.kept && next_ > 0) {
        const int fewer = between(kDirections[next_ - 1], directions);
        EnvironmentSampling sampling = chosen.light.environment;
        const Result<float> less = tryDirections(scene, fewer, sampling);
        if (!less) return less.error();
        if (*less <= wanted_) {
            chosen.light.directions = fewer;
            chosen.light.environment = sampling;
            error = less;
        }
    }
    choice_.predicted = *error * kSafety;
    phase_ = Phase::Done;
    return Done{};
}

// Makes the reference of a part finer than a candidate by far, so that none is held against the like of
// itself.
Status Budget::refine(const scene::Scene& scene, Part part, int& count, int candidate, int most) {
    if (count >= std::min(most, kFinerBy * candidate)) return Done{};
    count = std::min(most, 2 * kFinerBy * candidate);
    Result<Image> image = draw(scene, reference_, part);
    if (!image) return image.error();
    exact_[int(part)] = std::move(*image);
    return Done{};
}

double Budget::transferRays(const scene::Scene& scene) const {
    double rays = 0;
    for (const scene::Object& object : scene.objects)
        if (object.visible && object.isField())
            rays += lucent::relief::transferRays(object.field().texels(), kMostTerms);
    return rays;
}

} // namespace lucent::relief
