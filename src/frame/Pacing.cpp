// How the passes of a slice reach the GPU: in portions that take about as long as whoever looks on may wait.
#include "frame/RendererState.h"

#include <algorithm>
#include <limits>
#include <set>

namespace lucent::frame {

namespace {

// So that the GPU never waits for us, nor we long for it; browsers tell late that it has done something.
constexpr std::size_t kMostInFlight = 2, kMostDragged = 3;
constexpr double kBatchMs = 80;   // until a hand that comes down is followed,
constexpr double kDraggedMs = 20; // or one that moves: all in flight and a frame take a tenth of a second
constexpr int kFewest = 1 << 12, kFirst = 1 << 15; // pixels: of any pass, of one that was never drawn

} // namespace

// A few passes, at once.
Status Renderer::State::runGraph(const std::function<Status(graph::FrameGraph&)>& record) {
    graph::FrameGraph graph;
    if (Status recorded = record(graph); !recorded) return recorded;
    if (Status compiled = graph.compile(); !compiled) return compiled;
    graph.execute(pool);
    passes += graph.livePasses();
    if (std::string error = context.takeNoted(); !error.empty()) return Error{error, Fault::Machine};
    return Done{};
}

Status Renderer::State::begin(std::unique_ptr<Running> made, Running::Work work,
                              const std::function<Status(Running&)>& record) {
    const double before = nowMs();
    made->work = work;
    if (Status recorded = record(*made); !recorded) return recorded;
    if (Status compiled = made->graph.compile(); !compiled) return compiled;
    made->ms = nowMs() - before;
    running = std::move(made);
    return Done{};
}

// What has begun, until a slice of time is over.
Status Renderer::State::work(double until) {
    while (running && runSome(until))
        if (Status followed = follow(); !followed) return followed;
    return Done{};
}

std::size_t Renderer::State::mostInFlight() const { return dragged ? kMostDragged : kMostInFlight; }

// @return whether all passes have run
bool Renderer::State::runSome(double until) {
    if (atOnce) {
        const double before = nowMs();
        context.compile();
        running->graph.execute(pool);
        const bool isSlice = running->work == Running::Work::Slice;
        context.device().wait((!isSlice ? picture() : next > 0 ? scratch : sum).handle());
        running->ms += nowMs() - before; // waited for, so that what is reported as time is time
        return true;
    }
    for (;;) {
        retire(until);
        if (running->isSubmitted) return submitted.empty();
        if (context.hasUnready()) { // whoever looks on is not kept waiting for programs either
            if (!context.compile(until - nowMs()) || !submitted.empty()) return false;
            context.makeReady();
        }
        if (submitted.size() == mostInFlight() || nowMs() > until) return false;
        submit();
    }
}

// A GPU draws any pass in no time, until it has shown that it does not.
Renderer::State::Cost Renderer::State::costOf(const std::string& pass) const {
    const auto known = costs.find(pass);
    if (known != costs.end()) return known->second;
    return {context.caps().software ? kDraggedMs / kFirst : 1e-6, kFirst};
}

// How much of the time that its passes take together is over, about, [0,1].
float Renderer::State::shareOfRunning() const {
    return running->graph.share([this](const std::string& pass) { return costOf(pass).perPixel; });
}

// Gives the GPU what takes as long as a batch may, or one portion of a pass that was never drawn.
void Renderer::State::submit() {
    const double longest = dragged ? kDraggedMs : kBatchMs;
    const auto most = [&](const std::string& pass) {
        const Cost cost = costOf(pass);
        const int step = context.caps().software ? 2 * cost.pixels : std::numeric_limits<int>::max();
        return std::max(kFewest, int(std::min(double(step), longest / cost.perPixel)));
    };
    const double begun = nowMs();
    std::vector<Batch::Part> parts;
    double expected = 0;
    bool hasFirst = false;
    while (expected < longest) {
        const auto portion = running->graph.step(pool, most);
        running->isSubmitted = !portion;
        if (!portion) break;
        const int pixels = std::max(portion->pixels, kFewest);
        parts.push_back({portion->pass, pixels});
        const auto [known, isFirst] = costs.try_emplace(portion->pass, costOf(portion->pass));
        hasFirst |= isFirst;
        Cost& cost = known->second;
        cost.pixels = std::max(pixels, kFirst);
        expected += cost.perPixel * pixels;
    }
    if (!parts.empty()) submitted.push_back({std::move(parts), hasFirst, begun, expected, gl::Fence()});
}

// Takes what the GPU has done, and learns what it took; waits for it where nothing more can be given.
void Renderer::State::retire(double until) {
    constexpr double kLeastFactor = 0.25; // at once: what is done when it is first looked at took no time
    // A page looks once a frame: it may have been done soon after the last look. Where it looks less often
    // the GPU was what kept it.
    constexpr double kFrameMs = 1000.0 / 60;
    double expected = 0, begun = 0, ended = 0;
    bool hasFirst = false;
    std::vector<Batch::Part> parts;
    while (!submitted.empty()) {
        const double asked = nowMs();
        const bool waits = expected == 0 && (running->isSubmitted || submitted.size() == mostInFlight() ||
                                             context.hasUnready());
        if (!submitted.front().fence.passed(waits ? until - asked : 0)) {
            looked = nowMs();
            break;
        }
        Batch& done = submitted.front();
        if (expected == 0) begun = std::max(done.begun, retired);
        ended = std::max({begun, looked, asked - kFrameMs}) + (nowMs() - asked);
        expected += done.expected;
        hasFirst |= done.hasFirst;
        parts.insert(parts.end(), done.parts.begin(), done.parts.end());
        submitted.pop_front();
    }
    if (expected == 0) return;
    retired = ended;
    const double took = ended - begun;
    running->ms += took;
    // What compiling took says nothing of the pixels: it would cut the rest of a pass into crumbs.
    const double factor = std::clamp(took / expected, kLeastFactor, hasFirst ? 1.0 : 1e3);
    std::set<std::string> passes;
    for (const Batch::Part& part : parts)
        if (passes.insert(part.pass).second) costs.at(part.pass).perPixel *= factor;
}

// The picture has changed while its passes ran.
void Renderer::State::drop() {
    if (!running) return;
    running->graph.abandon(pool);
    running.reset();
    triangles.current = false;
    for (const Member& member : members)
        member.guest->forgetRecorded();
}

} // namespace lucent::frame
