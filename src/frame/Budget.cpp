#include "frame/Budget.h"

#include "base/Text.h"
#include "frame/Renderer.h"
#include "light/Samples.h"

#include <algorithm>
#include <cmath>

namespace lucent::frame {

namespace {

using technique::Knob;
using technique::KnobOf;

constexpr float kFinerHas =
    2; // the finer value has half the error: what it changes, times this, is all of it

struct Place {
    const Param* param;
    void* data;
};

// Where a parameter lives in a scene.
Place placeOf(scene::Scene& scene, std::string_view table, std::string_view id) {
    Settings& settings = scene.technique.at(std::string(table));
    const auto& params = settings.table().params;
    const auto found =
        std::find_if(params.begin(), params.end(), [id](const Param& param) { return param.id == id; });
    assert(found != params.end() && "a knob names no parameter of its table");
    return {&*found, static_cast<std::byte*>(settings.data()) + found->offset};
}

void set(scene::Scene& scene, const KnobOf& of, double value) {
    const auto store = [&](std::string_view id, double number) {
        const Place place = placeOf(scene, of.table, id);
        setComponent(*place.param, place.data, 0, number);
    };
    store(of.knob->id, value);
    if (!of.knob->tied.empty()) store(of.knob->tied, of.knob->factor * value);
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

void turnDown(scene::Scene& scene) {
    for (const KnobOf& of : technique::knobs(scene)) {
        const Place place = placeOf(scene, of.table, of.knob->id);
        const double own = getComponent(*place.param, place.data, 0), coarse = of.knob->coarse;
        setComponent(*place.param, place.data, 0,
                     of.knob->costsLess ? std::max(own, coarse) : std::min(own, coarse));
    }
}

Budget::Budget(gl::Context& context) : context_(context) {}
Budget::~Budget() = default;

// Those that have something to choose.
std::vector<KnobOf> Budget::knobsOf(const scene::Scene& scene) const {
    std::vector<KnobOf> list = technique::knobs(scene);
    std::erase_if(list, [this](const KnobOf& of) {
        return of.knob->steps.empty() || (of.isSampling && leavesSampling_);
    });
    return list;
}

bool Budget::matters(const scene::Scene& scene) const {
    return scene.view.show == scene::Aov::Color && !knobsOf(scene).empty();
}

void Budget::start(const scene::Scene& scene, ivec2 size, bool dragged) {
    limited_ = true;
    if (dragged) return;
    const float longer = float(std::max(size.x, size.y));
    size_ = glm::max(ivec2(vec2(size) * std::min(1.0f, float(kMostSide) / longer)), ivec2(1));
    turned_.clear();
    for (const KnobOf& of : knobsOf(scene)) {
        scene::Scene own = scene;
        const Param& param = *placeOf(own, of.table, of.knob->id).param;
        turned_.push_back({of, 0, of.knob->isExactAtMost ? param.max : of.knob->steps[0]});
    }
    next_ = 0;
    finer_ = Image();
    predicted_ = 0;
    kept_ = true;
    wanted_ = scene.quality.maxError / std::sqrt(float(std::max<std::size_t>(1, turned_.size())));
}

void Budget::forget() {
    limited_ = false;
    turned_.clear();
    next_ = 0;
    trial_.reset();
}

Status Budget::step(const scene::Scene& scene) {
    Turned& turned = turned_[next_];
    return turned.of.knob->isExactAtMost ? tryFewer(scene, turned) : tryNext(scene, turned);
}

// The scene with what is chosen so far; for trials, which keep no error themselves.
scene::Scene Budget::trialOf(const scene::Scene& scene) const {
    scene::Scene trial = scene;
    apply(trial);
    trial.quality.maxError = 0;
    views::samplingOf(trial).pixelSamples = 1;
    return trial;
}

void Budget::apply(scene::Scene& scene) const {
    if (!limited_) return;
    for (const Turned& turned : turned_)
        set(scene, turned.of, turned.value);
}

Result<Image> Budget::draw(scene::Scene trial, scene::Aov show) {
    if (!trial_) trial_ = std::make_unique<Renderer>(context_);
    trial.view.show = show;
    if (Status finished = trial_->finish(trial, ++trials_, size_); !finished) return finished.error();
    return trial_->read(trial, show);
}

// A knob is as it stays; its error joins the others'.
void Budget::finish(float error) {
    predicted_ = std::sqrt(predicted_ * predicted_ + error * error);
    if (error > wanted_) kept_ = false;
    finer_ = Image();
    if (++next_ == turned_.size()) trial_.reset();
}

Status Budget::tryNext(const scene::Scene& scene, Turned& turned) {
    const auto& steps = turned.of.knob->steps;
    if (finer_.pixels.empty()) {
        Result<Image> image = draw(trialOf(scene), scene::Aov::Color);
        if (!image) return image.error();
        finer_ = std::move(*image);
    }
    scene::Scene finer = trialOf(scene);
    set(finer, turned.of, steps[turned.step + 1]);
    Result<Image> image = draw(std::move(finer), scene::Aov::Color);
    if (!image) return image.error();
    const float error = kFinerHas * differenceOf(finer_, *image);
    if (error > wanted_ && turned.step + 2 < steps.size()) {
        turned.value = steps[++turned.step];
        finer_ = std::move(*image);
        return Done{};
    }
    finish(error);
    return Done{};
}

// The most is the exact picture: what has fewer must keep the directions and the light.
Status Budget::tryFewer(const scene::Scene& scene, Turned& turned) {
    Image exact[3], fewer[2];
    const scene::Aov shown[] = {scene::Aov::Color, scene::Aov::Direction, scene::Aov::Layers};
    for (int i = 0; i < 3; ++i) {
        Result<Image> image = draw(trialOf(scene), shown[i]);
        if (!image) return image.error();
        exact[i] = std::move(*image);
    }
    float kept = 0;
    for (const double value : turned.of.knob->steps) {
        scene::Scene trial = trialOf(scene);
        set(trial, turned.of, value);
        for (int i = 0; i < 2; ++i) {
            Result<Image> image = draw(trial, shown[i]);
            if (!image) return image.error();
            fewer[i] = std::move(*image);
        }
        const float error = differenceOf(fewer[0], exact[0]),
                    degrees = medianAngle(fewer[1], exact[1], exact[2]);
        if (error > wanted_ || degrees > kDegrees * scene.quality.maxError) continue;
        turned.value = value;
        kept = error;
        break;
    }
    finish(kept);
    return Done{};
}

std::optional<technique::Chooser::Choice> Budget::choice() const {
    if (turned_.empty() || !done()) return std::nullopt;
    std::string text;
    for (const Turned& turned : turned_)
        text += shortest(turned.value) + " " + std::string(turned.of.knob->words) + ", ";
    text += "error about " + shortest(std::round(predicted_ * 1e4f) / 100) + " %";
    return Choice{kept_ ? text : text + ": nothing keeps the wanted error", predicted_};
}

} // namespace lucent::frame
