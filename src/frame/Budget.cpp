#include "frame/Budget.h"

#include "base/Text.h"
#include "frame/RendererState.h"
#include "light/Samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::frame {

namespace {

using scene::Aov;
using technique::Guest;
using technique::Knob;
using technique::KnobOf;

// The finer value has half the error: what it changes, times this, is all of it.
constexpr float kFinerHas = 2;
// By so much may the error of the whole picture exceed the sample's: lucent bench budget.
constexpr float kSafety = 1.25f;
constexpr int kSamplePixels = 1600; // 900 told 1.6 times too little of a field as rough as its texels
constexpr int kFewestCovered = 256; // fewer say too little
constexpr int kFinerBy = 4;         // a reference than what is held against it
constexpr int kOfTrials = 16;       // directions at most, where they are the same in all that is compared
// Samples of a pixel that have light samples of their own leave this power of their number of the error: five
// were measured to leave 0.37 to 0.52 of it, where independent ones would leave 0.45.
constexpr float kByPixelSamples = -0.4f;

const Param& paramOf(const Settings& settings, std::string_view id) {
    const auto& params = settings.table().params;
    const auto found =
        std::find_if(params.begin(), params.end(), [id](const Param& param) { return param.id == id; });
    assert(found != params.end() && "a knob names no parameter of its table");
    return *found;
}

void setValue(Settings& settings, std::string_view id, double value) {
    const Param& param = paramOf(settings, id);
    setComponent(param, static_cast<std::byte*>(settings.data()) + param.offset, 0, value);
}

double valueOf(const Settings& settings, std::string_view id) {
    const Param& param = paramOf(settings, id);
    return getComponent(param, static_cast<const std::byte*>(settings.data()) + param.offset, 0);
}

// As the scene itself has it.
double numberOf(const scene::Scene& scene, const KnobOf& of) {
    return valueOf(scene.technique.at(std::string(of.table)), of.knob->id);
}

// The cheaper of two values of a knob.
double cheaper(const Knob& knob, double a, double b) {
    return knob.costsLess ? std::max(a, b) : std::min(a, b);
}

void store(scene::Scene& scene, const KnobOf& of, double number, int placing) {
    Settings& settings = scene.technique.at(std::string(of.table));
    const auto set = [&](std::string_view id, double value) { setValue(settings, id, value); };
    set(of.knob->id, number);
    if (!of.knob->tied.empty()) set(of.knob->tied, of.knob->factor * number);
    if (!of.knob->placing.empty()) set(of.knob->placing, placing);
}

// Whether it is what a bake takes the place of.
bool isOfEnvironment(const KnobOf& of) {
    return of.table == views::samplingParams().name && of.knob->id == "directions";
}

bool covered(const Image& image, std::size_t pixel) { return image.pixels[4 * pixel + 3] > 0; }

// How many samples a number of them is held against at first.
double referenceFor(const Knob& knob, float maxError) {
    return std::clamp(std::floor(6 * kSafety / double(maxError)), knob.most / 32, knob.most);
}

// About kSamplePixels in the picture's shape; odd numbers keep in step with few patterns.
ivec2 sampleSizeFor(ivec2 size) {
    const double aspect = double(size.x) / size.y;
    return ivec2(int(std::sqrt(kSamplePixels * aspect)), int(std::sqrt(kSamplePixels / aspect))) | 1;
}

ivec2 trialSizeFor(ivec2 size) {
    const float longer = float(std::max(size.x, size.y));
    return glm::max(ivec2(vec2(size) * std::min(1.0f, float(Budget::kMostSide) / longer)), ivec2(1));
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

void turnDown(scene::Scene& scene, bool hasFewPixels) {
    for (const KnobOf& of : technique::knobs(scene)) {
        Settings& settings = scene.technique.at(std::string(of.table));
        const Knob& knob = *of.knob;
        const double number = cheaper(knob, numberOf(scene, of), hasFewPixels ? knob.coarsest : knob.coarse);
        setValue(settings, knob.id, number);
        if (!knob.tied.empty())
            setValue(settings, knob.tied, std::min(valueOf(settings, knob.tied), knob.factor * number));
    }
}

Budget::Budget(Renderer::State& of) : of_(of) {}
Budget::~Budget() = default;

// --- what there is to choose

// What mostly keeps the exact picture comes before what never does, and leaves it its share of the error.
std::vector<KnobOf> Budget::knobsOf(const scene::Scene& scene) const {
    const std::vector<Guest*> guests = of_.needed(scene);
    const bool shades =
        std::any_of(guests.begin(), guests.end(), [&](const Guest* guest) { return guest->shades(scene); });
    std::vector<KnobOf> list = technique::knobs(scene);
    std::erase_if(
        list, [&](const KnobOf& of) { return of.knob->steps.empty() || (isOfEnvironment(of) && !shades); });
    const auto isDear = [&](const KnobOf& of) { // to choose, beside what may be saved
        return !of.knob->showsOnFew || numberOf(scene, of) <= referenceFor(*of.knob, scene.quality.maxError);
    };
    if (frugal_) std::erase_if(list, isDear);
    std::stable_partition(list.begin(), list.end(), [](const KnobOf& of) { return of.knob->most > 0; });
    return list;
}

// Light itself, which may be found in several ways, not how one of them finds it.
bool Budget::matters(const scene::Scene& scene) const {
    const bool showsLight = scene.view.show == Aov::Color || scene.view.show == Aov::Illumination;
    return showsLight && !knobsOf(scene).empty();
}

void Budget::start(const scene::Scene& scene, bool dragged) {
    limited_ = true;
    dragged_ = dragged;
    baker_ = nullptr;
    if (!dragged) bake_ = Bake::None;
    for (Guest* guest : of_.needed(scene)) {
        scene::Scene baked = scene;
        guest->setBake(baked, true);
        if (!guest->bakes(baked)) continue;
        baker_ = guest;
        if (guest->isBaked(baked)) bake_ = Bake::Taken; // nothing is cheaper
    }
    if (!dragged) {
        begin(scene);
    } else if (!done()) { // the last choice was never made
        turned_.clear();
        next_ = 0;
        renderer_.reset();
    }
}

void Budget::begin(const scene::Scene& scene) {
    maxError_ = scene.quality.maxError;
    turned_.clear();
    for (const KnobOf& of : knobsOf(scene))
        turned_.push_back({of,
                           {of.knob->bends ? of.knob->most : of.knob->steps[0]},
                           std::numeric_limits<float>::infinity()});
    next_ = 0;
    beginKnob();
}

void Budget::forget() {
    limited_ = false;
    bake_ = Bake::None;
    turned_.clear();
    next_ = 0;
    renderer_.reset();
}

// The next one that there is to try.
void Budget::beginKnob() {
    for (; !done() && isBaked() && isOfEnvironment(turned_[next_].of); ++next_)
        turned_[next_].error = wanted(); // until it is known: admitsBake()
    drawn_.clear();
    errors_.clear();
    covered_.reset();
    size_ = ivec2(0);
    isDrawing_ = false;
    reference_ = 0;
    if (!done() || !renderer_) return;
    if (renderer_->sceneryFor == of_.sceneryFor)
        for (std::size_t i = 0; i < of_.members.size(); ++i)
            of_.members[i].guest->takeLight(*renderer_->members[i].guest, of_.scenery);
    renderer_.reset();
}

bool Budget::waits() const { return renderer_ && renderer_->running && !renderer_->submitted.empty(); }

// Of the knobs that are chosen.
float Budget::predicted() const {
    float squares = 0;
    for (std::size_t i = 0; i < next_; ++i)
        squares += turned_[i].error * turned_[i].error;
    return std::sqrt(squares);
}

// Of each knob the first half is drawing what its values are held against, which takes longest.
float Budget::share() const {
    if (done()) return 1;
    const float error = turned_[next_].error;
    const float ofKnob =
        std::isfinite(error) ? 0.5f + 0.5f * std::min(1.0f, wanted() / error) : 0.5f * shareOfTrial_;
    return (float(next_) + ofKnob) / float(turned_.size());
}

// Of the next knob: an even share of what those before it leave.
float Budget::wanted() const {
    const float all = maxError_ * maxError_, left = all - predicted() * predicted();
    return std::sqrt((left > 0 ? left : all) / float(turned_.size() - next_));
}

void Budget::apply(scene::Scene& scene) const {
    if (limited_ && done()) put(scene, nullptr, {});
}

// What is chosen, but for one knob that is tried.
void Budget::put(scene::Scene& scene, const Turned* tried, Value value) const {
    const bool bakes = tried && isOfEnvironment(tried->of) ? value.baked : isBaked();
    for (const Guest* guest : of_.needed(scene))
        guest->setBake(scene, bakes && guest == baker_);
    for (const Turned& turned : turned_) {
        if (bakes && isOfEnvironment(turned.of)) continue; // the scene's own are summed beside it
        const Value& it = &turned == tried ? value : turned.value;
        const double own = numberOf(scene, turned.of);
        store(scene, turned.of, frugal_ ? cheaper(*turned.of.knob, it.number, own) : it.number, it.placing);
    }
}

std::optional<Budget::Choice> Budget::choice() const {
    if (turned_.empty() || !done()) return std::nullopt;
    std::string text;
    for (const Turned& turned : turned_) {
        const Knob& knob = *turned.of.knob;
        if (isBaked() && isOfEnvironment(turned.of)) {
            text += std::string(baker_->bakeName()) + ", ";
            continue;
        }
        text += shortest(turned.value.number) + " " + std::string(knob.words);
        if (!knob.placings.empty())
            text += " " + std::string(knob.placings[std::size_t(turned.value.placing)]);
        text += ", ";
    }
    text += "error about " + shortest(std::round(predicted() * 1e4f) / 100) + " %";
    const bool keeps = predicted() < 1.001f * maxError_; // but for rounding
    return Choice{keeps ? text : text + ": nothing keeps the wanted error", predicted()};
}

// --- trials

// @return whether it is drawn
Result<bool> Budget::draw(const scene::Scene& scene, const Turned& turned, Trial trial) {
    using Effort = Renderer::State::Effort;
    static const views::Surroundings kNothing; // few pixels see nothing by way of others
    if (drawn_.count(trial) > 0) return true;
    if (!renderer_) {
        renderer_ = std::make_unique<Renderer::State>(of_.context, &of_.supplies);
        renderer_->shownAspect = of_.aspect();
        renderer_->keepsCubes = true; // they are the same in all that is compared
        for (std::size_t i = 0; i < of_.members.size(); ++i)
            renderer_->members[i].guest->shareBake(*of_.members[i].guest);
    }
    if (!isDrawing_) ++trials_;
    isDrawing_ = true;
    scene::Scene tried = scene;
    put(tried, &turned, trial.value);
    const int directions = of_.directionsOfSample(tried);
    views::samplingOf(tried).directions =
        turned.of.knob->showsOnFew ? directions : std::min(directions, kOfTrials);
    views::samplingOf(tried).pixelSamples = 1;
    tried.view.show = trial.show;
    renderer_->given = turned.of.knob->showsOnFew ? &kNothing : nullptr;
    const Result<Progress> progress =
        renderer_->advance(tried, trials_, size_, of_.atOnce ? Effort::Final : Effort::Unseen);
    if (!progress) return progress.error();
    shareOfTrial_ = progress->complete ? 0 : progress->share;
    if (!progress->complete) return false;
    isDrawing_ = false;
    Result<Image> image = renderer_->display(tried, true);
    if (!image) return image.error();
    drawn_[trial] = std::move(*image);
    return true;
}

// Finds the pixels that show an object. @return whether they are known
Result<bool> Budget::cover(const scene::Scene& scene, const Turned& turned) {
    if (covered_) return true;
    const bool few = turned.of.knob->showsOnFew;
    if (size_.x == 0) size_ = few ? sampleSizeFor(of_.size) : trialSizeFor(of_.size);
    const Trial depth{turned.value, Aov::Depth};
    const Result<bool> isDrawn = draw(scene, turned, depth);
    if (!isDrawn || !*isDrawn) return isDrawn;
    covered_.emplace();
    for (std::size_t i = 0; i < std::size_t(size_.x) * std::size_t(size_.y); ++i)
        if (covered(drawn_.at(depth), i)) covered_->push_back(i);
    if (!few || covered_->size() >= kFewestCovered || size_.x * 2 >= of_.size.x) return true;
    size_ = size_ * 2 + 1;
    covered_.reset();
    drawn_.clear();
    return false;
}

// RMSE over the mean of the finer picture.
float Budget::differenceOf(const Image& coarse, const Image& fine) const {
    double squares = 0, mean = 0;
    for (const std::size_t pixel : *covered_)
        for (std::size_t c = 4 * pixel; c < 4 * pixel + 3; ++c) {
            const double d = double(coarse.pixels[c]) - double(fine.pixels[c]);
            squares += d * d;
            mean += double(fine.pixels[c]);
        }
    const double count = 3 * double(covered_->size());
    return mean > 0 ? float(std::sqrt(squares / count) / (mean / count)) : 0;
}

// @return nothing while pictures are being drawn
Result<std::optional<float>> Budget::errorOf(const scene::Scene& scene, const Turned& turned, Value tried,
                                             Value finer) {
    const Aov show = scene.view.show;
    const bool bends = turned.of.knob->bends;
    std::vector<Trial> trials{{finer, show}, {tried, show}};
    if (bends)
        trials.insert(trials.end(), {{finer, Aov::Direction}, {finer, Aov::Layers}, {tried, Aov::Direction}});
    for (const Trial& trial : trials) {
        const Result<bool> isDrawn = draw(scene, turned, trial);
        if (!isDrawn) return isDrawn.error();
        if (!*isDrawn) return std::optional<float>();
    }
    const auto picture = [&](std::size_t i) -> const Image& { return drawn_.at(trials[i]); };
    if (bends && medianAngle(picture(4), picture(2), picture(3)) > kDegrees * maxError_)
        return std::optional(std::numeric_limits<float>::infinity());
    return std::optional(differenceOf(picture(1), picture(0)));
}

// What a number is held against: none that is nearly the same.
Budget::Value Budget::finerThan(const Turned& turned, double number) {
    const Knob& knob = *turned.of.knob;
    if (knob.most == 0) return {knob.steps[turned.step + 1]};
    // Its own error is a small part of the wanted one: error falls about as the number rises.
    if (reference_ == 0) reference_ = referenceFor(knob, maxError_);
    if (reference_ < kFinerBy * number) reference_ = std::min(knob.most, 2 * kFinerBy * number);
    return {reference_, std::max(0, int(knob.placings.size()) - 1)};
}

// What a bake costs at once, more and more directions would cost as well.
bool Budget::isWorthBaking(const scene::Scene& scene, const Turned& turned) const {
    if (!baker_ || bake_ != Bake::None || !isOfEnvironment(turned.of)) return false;
    const double share = double(covered_->size()) / (double(size_.x) * size_.y);
    const double pixels = share * of_.size.x * of_.size.y;
    return turned.of.knob->steps[turned.step] > baker_->directionsForBake(scene, pixels);
}

// What is left of an error among light samples in the mean over a pixel. Trials have one sample of it.
float Budget::leftOf(const scene::Scene& scene, const Turned& turned) const {
    const bool varies = turned.of.table == views::samplingParams().name && of_.variesLight(scene);
    return varies ? std::pow(float(of_.pixelSamples(scene)), kByPixelSamples) : 1;
}

// Of the next step, where the errors of the two before it leave no doubt whether it keeps the wanted one: how
// an error falls changes little from step to step (by factors of 0.77 to 1.12 in ten scenes of the gallery),
// unless it fell faster than it does in the end, or rose.
std::optional<float> Budget::foretold() const {
    constexpr float kEnd = 0.5f, kLeastFactor = 0.7f;
    if (errors_.size() < 2) return std::nullopt;
    const float before = errors_.back(), falls = before / errors_[errors_.size() - 2];
    const float next = before * falls;
    const bool isRegular = falls >= kEnd && falls <= 1;
    const bool isSure = next <= wanted() || kLeastFactor * next > wanted();
    return isRegular && isSure ? std::optional(next) : std::nullopt;
}

Status Budget::step(const scene::Scene& scene) {
    Turned& turned = turned_[next_];
    const Knob& knob = *turned.of.knob;
    const Result<bool> isCovered = cover(scene, turned);
    if (!isCovered) return isCovered.error();
    if (!*isCovered) return Done{};
    if (isWorthBaking(scene, turned)) {
        bake_ = Bake::Taken;
        beginKnob();
        return Done{};
    }
    const double number = knob.steps[turned.step];
    const Value finer = finerThan(turned, number);
    const float factor = knob.most == 0 ? kFinerHas : knob.showsOnFew ? kSafety : 1;
    const std::size_t last = knob.steps.size() - (knob.most == 0 ? 2 : 1);
    const std::optional<float> told = knob.most == 0 && turned.step == last ? foretold() : std::nullopt;
    float least = std::numeric_limits<float>::infinity();
    for (int placing = 0; placing < std::max(1, int(knob.placings.size())); ++placing) {
        if (told) {
            least = *told;
        } else {
            const Result<std::optional<float>> error = errorOf(scene, turned, {number, placing}, finer);
            if (!error) return error.error();
            if (!*error) return Done{};
            least = std::min(least, factor * leftOf(scene, turned) * **error);
        }
        if (least >= turned.error) continue;
        turned.error = least;
        turned.value = {number, placing};
    }
    errors_.push_back(least);
    const double own = numberOf(scene, turned.of);
    const bool isOwn = frugal_ && cheaper(knob, number, own) == own;
    if (least > wanted() && turned.step < last && !isOwn) {
        // Samples by so many as are surely needed: error falls no faster than their square.
        const double enough = knob.showsOnFew ? number * std::sqrt(double(least / wanted())) : number;
        ++turned.step;
        while (turned.step < last && knob.steps[turned.step] < enough)
            ++turned.step;
        return Done{};
    }
    ++next_;
    beginKnob();
    return Done{};
}

Result<bool> Budget::admitsBake(const scene::Scene& scene) {
    if (!limited_ || dragged_ || bake_ != Bake::Taken) return true;
    const auto turned = std::find_if(turned_.begin(), turned_.end(),
                                     [](const Turned& one) { return isOfEnvironment(one.of); });
    if (turned == turned_.end()) return true;
    const Result<bool> isCovered = cover(scene, *turned);
    if (!isCovered || !*isCovered) return isCovered;
    // As fine as the sum of directions that it stands for.
    const Value finer = finerThan(*turned, std::floor(3 * kSafety / double(maxError_)));
    Value baked = turned->value;
    baked.baked = true;
    const Result<std::optional<float>> error = errorOf(scene, *turned, baked, finer);
    if (!error) return error.error();
    if (!*error) return false;
    turned->error = **error;
    const bool keeps = predicted() <= maxError_;
    bake_ = keeps ? Bake::Kept : Bake::Refused;
    if (keeps)
        beginKnob();
    else
        begin(scene);
    return keeps;
}

} // namespace lucent::frame
