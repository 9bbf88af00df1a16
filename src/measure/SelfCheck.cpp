#include "measure/SelfCheck.h"

#include "base/JsonWriter.h"
#include "frame/Renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::measure {

Studio::Studio(gl::Context& context)
    : context_(context), renderer_(std::make_unique<frame::Renderer>(context)) {}
Studio::~Studio() = default;

Image Studio::take(Result<Image> drawn, ivec2 size) {
    if (!drawn) {
        if (error_.empty()) error_ = drawn.error().message;
        Image nothing(size.x, size.y, 4);
        std::fill(nothing.pixels.begin(), nothing.pixels.end(), std::numeric_limits<float>::quiet_NaN());
        return nothing;
    }
    broken_ += int(std::count_if(drawn->pixels.begin(), drawn->pixels.end(),
                                 [](float value) { return !std::isfinite(value); }));
    return std::move(*drawn);
}

Image Studio::draw(const scene::Scene& scene, scene::Aov aov) {
    scene::Scene shown = scene;
    shown.view.show = aov;
    if (Status drawn = renderer_->finish(shown, ++revision_, shown.size); !drawn)
        return take(drawn.error(), shown.size);
    return take(renderer_->read(shown, aov), shown.size);
}

Image Studio::display(const scene::Scene& scene) {
    if (Status drawn = renderer_->finish(scene, ++revision_, scene.size); !drawn)
        return take(drawn.error(), scene.size);
    return take(renderer_->readDisplay(scene), scene.size);
}

// Written so that a NaN counts as farther than anything.
void Finding::take(double expected, double found) {
    if (any_ && std::abs(found - expected) <= std::abs(found_ - expected_)) return;
    if (any_ && std::isnan(found_)) return;
    any_ = true;
    expected_ = expected;
    found_ = found;
}

namespace {

Finding storedFloats(Studio& studio) {
    Image sent(64, 1, 4);
    for (int i = 0; i < 256; ++i)
        sent.pixels[std::size_t(i)] = std::ldexp(1 + float(i) / 3, i / 2 - 64) * (i % 2 ? -1.0f : 1.0f);
    gl::Device& device = studio.context().device();
    const graph::Texture texture(device, {.size = sent.size(), .format = graph::Format::RGBA32F},
                                 "measure.stored");
    device.upload(texture.handle(), 0, sent.pixels);
    const Image back = device.read(texture.handle());
    Finding finding;
    for (std::size_t i = 0; i < sent.pixels.size(); ++i)
        finding.take(1, back.pixels[i] / sent.pixels[i]);
    return finding;
}

Finding brokenValues(Studio& studio) {
    Finding finding;
    finding.take(0, studio.brokenValues());
    return finding;
}

constexpr Tolerance kExact{0, "nothing is rounded"};

constexpr Check kCommon[] = {
    {"Stored floats", "What goes into a 32-bit texture comes back, from 2^-64 to 2^70", kExact, storedFloats},
    {"No NaN, no infinity behind", "Values that are none, in all pictures so far", kExact, brokenValues},
};

} // namespace

std::span<const Check> closedForms() {
    static const auto all = [] {
        std::vector<Check> list;
        for (const Forms* forms : techniqueForms())
            list.insert(list.end(), forms->checks.begin(), forms->checks.end());
        list.insert(list.end(), std::begin(kCommon), std::end(kCommon));
        return list;
    }();
    return all;
}

bool CheckResult::passed() const {
    return message.empty() && std::abs(found - expected) <= check.tolerance.value; // false for NaN
}

SelfCheck::SelfCheck(gl::Context& context, std::span<const Check> checks)
    : context_(context), checks_(checks), studio_(context), capabilities_(context) {}

bool SelfCheck::step() {
    if (results_.size() < checks_.size()) {
        const Check& check = checks_[results_.size()];
        const Finding finding = check.measure(studio_);
        results_.push_back({check, finding.expected(), finding.found(), studio_.takeError()});
        return true;
    }
    return capabilities_.step();
}

float SelfCheck::progress() const {
    const std::size_t done = results_.size() + capabilities_.rows().size();
    return float(done) / float(checks_.size() + Capabilities::kCount);
}

bool SelfCheck::passed() const {
    return results_.size() == checks_.size() &&
           std::all_of(results_.begin(), results_.end(), [](const CheckResult& one) { return one.passed(); });
}

std::string SelfCheck::json() const {
    JsonWriter json;
    json.beginObject().key("device").raw(context_.caps().json()).key("passed").value(passed());
    json.key("checks").beginArray();
    for (const CheckResult& one : results_) {
        json.beginObject().key("name").value(one.check.name).key("meaning").value(one.check.meaning);
        json.key("expected").value(one.expected).key("found").value(one.found);
        json.key("tolerance")
            .value(one.check.tolerance.value)
            .key("reason")
            .value(one.check.tolerance.reason);
        json.key("passed").value(one.passed());
        if (!one.message.empty()) json.key("message").value(one.message);
        json.end();
    }
    json.end().key("capabilities").beginArray();
    for (const Capability& one : capabilities()) {
        json.beginObject().key("name").value(one.name).key("extension").value(one.extension);
        json.key("present").value(one.present).key("amount").value(one.amount);
        json.key("use").value(one.use).key("fallback").value(one.fallback);
        json.key("measured").value(one.measured).key("measure").value(one.measure).end();
    }
    json.end().end();
    return json.text();
}

} // namespace lucent::measure
