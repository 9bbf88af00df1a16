#include "measure/Capabilities.h"

#include "gl/Timer.h"
#include "graph/Device.h"
#include "shaders/measure/Blocks.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>

namespace lucent::measure {

using graph::Format;
using graph::Texture;
using graph::TextureHandle;

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr int kColumns = 256; // of a ramp
constexpr int kTerms = 64;    // of a sum
constexpr double kWorkMs = 8; // of a draw that is timed: far above the cost of starting one
constexpr int kMostWork = 1 << 18;
constexpr double kPatienceMs = 3000; // until a timer query is taken not to answer

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

double rampAt(int column) { return double(65536 + 257 * column) / 65536; }

// Draws one question of measure/probe.frag; false when the device cannot.
bool ask(gl::Context& context, const char* question, TextureHandle target, ProbeBlock block,
         TextureHandle source = TextureHandle::None, bool add = false) {
    const gl::Program* program = context.program("measure/probe", {question});
    block.one = 1;
    block.columns = kColumns;
    graph::Draw draw;
    draw.program = program;
    draw.blend = add ? graph::Blend::Add : graph::Blend::None;
    draw.block = block;
    if (source != TextureHandle::None) draw.textures.push_back({"uSource", source});
    context.device().runPass({.label = question, .colors = {{.texture = target}}},
                             [&](graph::Commands& commands) { commands.draw(draw); });
    return context.takeError().empty();
}

// Largest relative difference to a row of values; NaN when one is not a number.
double worstRelative(const Image& image, const std::vector<double>& expected) {
    double worst = 0;
    for (std::size_t column = 0; column < expected.size(); ++column) {
        const double error = std::abs(image.at(int(column), 0)[0] / expected[column] - 1);
        if (!(error <= worst)) worst = error;
    }
    return worst;
}

// A row of colours drawn by one question; empty when the device cannot.
Image row(gl::Context& context, const char* question, Format format,
          TextureHandle source = TextureHandle::None) {
    const Texture target(context.device(), {.size = {kColumns, 1}, .format = format}, "measure.row");
    if (!ask(context, question, target.handle(), {.count = 1}, source)) return {};
    Image image = context.device().read(target.handle());
    return context.takeError().empty() ? std::move(image) : Image();
}

// Largest relative error of a value that is drawn, stored and read back.
double storeError(gl::Context& context, Format format) {
    const Image stored = row(context, "RAMP", format);
    if (stored.empty()) return kUnknown;
    std::vector<double> expected;
    for (int column = 0; column < kColumns; ++column)
        expected.push_back(rampAt(column));
    return worstRelative(stored, expected);
}

// Largest difference between a filtered ramp from 0 to 1 and the same computed in the shader.
double filterDifference(gl::Context& context, Format format) {
    const Texture source(context.device(), {.size = {2, 1}, .format = format, .linear = true},
                         "measure.pair");
    const std::vector<float> pair{0, 0, 0, 0, 1, 1, 1, 1};
    if (format == Format::RGBA32F) {
        context.device().upload(source.handle(), 0, pair);
    } else {
        std::vector<std::uint16_t> halves(pair.size());
        std::transform(pair.begin(), pair.end(), halves.begin(), glm::packHalf1x16);
        context.device().upload(source.handle(), 0, halves);
    }
    const Image filtered = row(context, "FILTER", Format::RGBA32F, source.handle());
    const Image byHand = row(context, "BY_HAND", Format::RGBA32F, source.handle());
    if (filtered.empty() || byHand.empty()) return kUnknown;
    double worst = 0;
    for (std::size_t i = 0; i < filtered.pixels.size(); ++i) {
        const double difference = std::abs(filtered.pixels[i] - byHand.pixels[i]);
        if (!(difference <= worst)) worst = difference;
    }
    return worst;
}

// Largest relative difference between a sum that the device blends and one that passes hand on.
double blendDifference(gl::Context& context) {
    const graph::TextureDesc desc{.size = {kColumns, 1}, .format = Format::RGBA32F};
    const Texture blended(context.device(), desc, "measure.blended");
    Texture sum(context.device(), desc, "measure.sum"), next(context.device(), desc, "measure.next");
    for (int term = 0; term < kTerms; ++term) {
        const bool first = term == 0;
        if (!ask(context, "ADD", blended.handle(), {.count = term}, TextureHandle::None, !first) ||
            !ask(context, "ADD", next.handle(), {.count = term, .readsSum = !first},
                 first ? TextureHandle::None : sum.handle()))
            return kUnknown;
        std::swap(sum, next);
    }
    const Image handedOn = context.device().read(sum.handle());
    const std::vector<double> expected = [&] {
        std::vector<double> values;
        for (int column = 0; column < kColumns; ++column)
            values.push_back(handedOn.at(column, 0)[0]);
        return values;
    }();
    const double worst = worstRelative(context.device().read(blended.handle()), expected);
    return context.takeError().empty() ? worst : kUnknown;
}

// The smallest step above 1.
double precision(gl::Context& context) {
    const Image step = row(context, "STEP", Format::RGBA32F);
    return step.empty() ? kUnknown : step.pixels.front();
}

Capability drawFloats(gl::Context& context) {
    return {"Draw into 32-bit floats",
            "EXT_color_buffer_float",
            context.caps().colorBufferFloat,
            "",
            "visible points, layers of glass, caustic maps and other sums of light",
            "none: without it Lucent says so and does not start",
            storeError(context, Format::RGBA32F),
            "largest relative error of a value drawn and read back"};
}

Capability drawHalves(gl::Context& context) {
    return {"Draw into 16-bit floats",
            "EXT_color_buffer_float",
            context.caps().colorBufferFloat,
            "",
            "layers of glass are counted in them; coefficients of relief's transfer method",
            "not needed: it comes with 32-bit floats",
            storeError(context, Format::RGBA16F),
            "largest relative error of a value drawn and read back: what half the memory costs, each pass"};
}

Capability filterHalves(gl::Context& context) {
    return {"Filter 16-bit floats",
            "",
            true,
            "",
            "colour maps",
            "not needed: every device has it",
            filterDifference(context, Format::RGBA16F),
            "largest difference to filtering in the shader, of a step from 0 to 1"};
}

Capability filterFloats(gl::Context& context) {
    const bool present = context.caps().floatLinear;
    return {"Filter 32-bit floats",
            "OES_texture_float_linear",
            present,
            "",
            "not used yet: heights and coverage are filtered in the shader",
            "filtering in the shader, in use on every device",
            present ? filterDifference(context, Format::RGBA32F) : kUnknown,
            "largest difference to filtering in the shader, of a step from 0 to 1"};
}

Capability blendFloats(gl::Context& context) {
    const bool present = context.caps().floatBlend;
    return {
        "Blend 32-bit floats",
        "EXT_float_blend",
        present,
        "",
        "light adds up in caustic maps and, by subsurface scattering, in the picture; where glass begins "
        "and ends, for voxels",
        "caustic maps of 16-bit floats: a glass ball's caustic loses 0.7 % of its light; subsurface "
        "scattering is gathered; voxels of glass take a pass more; layers of glass by peeling are the same",
        present ? blendDifference(context) : kUnknown,
        "largest relative difference between both sums of 64 terms"};
}

Capability drawBuffers(gl::Context& context) {
    return {"Targets of one pass",
            "",
            true,
            std::to_string(context.caps().maxDrawBuffers),
            "layers of glass and moved vertices are drawn into two or three targets at once, voxels into up "
            "to eight",
            "with fewer than eight voxels of glass take more passes to the same picture",
            kUnknown,
            ""};
}

Capability textureSize(gl::Context& context) {
    return {"Side of a texture",
            "",
            true,
            std::to_string(context.caps().maxTextureSize) + " texels",
            "height maps and colour maps up to this size",
            "none: larger maps are refused with a message",
            kUnknown,
            ""};
}

Capability highPrecision(gl::Context& context) {
    return {"High precision in shaders",
            "",
            context.caps().fragmentBits >= 23,
            std::to_string(context.caps().fragmentBits) + " bits",
            "all shaders",
            "none: the table above shows what fewer bits cost",
            precision(context),
            "smallest step above 1; 2^-23 = 1.19e-7 for 32-bit floats"};
}

} // namespace

// A draw that was timed twice: by its query and by waiting for its last pixel.
struct Capabilities::TimedWork {
    explicit TimedWork(gl::Context& context) : timer(context) {}
    gl::Timer timer;
    double realMs = 0, since = 0;
};

Capabilities::Capabilities(gl::Context& context) : context_(context) {}
Capabilities::~Capabilities() = default;

// Draws more and more until it takes long enough, then with a query around it. Nothing without queries.
std::unique_ptr<Capabilities::TimedWork> Capabilities::startWork() {
    auto work = std::make_unique<TimedWork>(context_);
    if (!work->timer.available()) return nullptr;
    const Texture target(context_.device(), {.size = {64, 64}, .format = Format::RGBA32F}, "measure.work");
    const auto run = [&](int count) {
        const double before = now();
        ask(context_, "WORK", target.handle(), {.count = count});
        context_.device().wait(target.handle());
        return now() - before;
    };
    int count = 64;
    while (run(count) < kWorkMs && count < kMostWork)
        count *= 2;
    work->since = now();
    work->timer.begin();
    ask(context_, "WORK", target.handle(), {.count = count});
    work->timer.end();
    context_.device().wait(target.handle());
    work->realMs = now() - work->since;
    return work;
}

bool Capabilities::finishTimers() {
    std::optional<double> told;
    if (work_) {
        told = work_->timer.milliseconds();
        if (!told && now() - work_->since < kPatienceMs) return false;
    }
    const bool used = context_.caps().timerQuery && !context_.caps().software; // as Stopwatch does
    rows_.push_back(
        {"Timer queries", "EXT_disjoint_timer_query", context_.caps().timerQuery, "",
         "the benchmark, unless the driver is software; the viewer's times are those of finished pictures",
         used ? "waiting for a picture's last pixel, in use in the viewer only"
              : "waiting for a picture's last pixel, in use everywhere",
         told ? *told / work_->realMs : kUnknown,
         "share of a draw's real time that a query tells; far below 1: it times submission only"});
    work_.reset();
    return true;
}

bool Capabilities::step() {
    constexpr Capability (*kRows[])(gl::Context&) = {drawFloats,  drawHalves,  filterHalves, filterFloats,
                                                     blendFloats, drawBuffers, textureSize,  highPrecision};
    static_assert(std::size(kRows) + 1 == kCount);
    if (rows_.size() < std::size(kRows)) {
        rows_.push_back(kRows[rows_.size()](context_));
        if (rows_.size() == std::size(kRows)) work_ = startWork();
        return true;
    }
    if (rows_.size() == kCount) return false;
    return !finishTimers();
}

} // namespace lucent::measure
