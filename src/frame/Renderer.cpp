#include "frame/RendererState.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using scene::Aov;

Renderer::Renderer(gl::Context& context) : state_(std::make_unique<State>(context)) {}
Renderer::~Renderer() = default;

Result<Progress> Renderer::advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size,
                                   bool coarse) {
    return state_->advance(scene, revision, size,
                           coarse ? State::Effort::Coarse : State::Effort::Progressive);
}

Status Renderer::finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size) {
    for (;;) {
        Result<Progress> progress = state_->advance(scene, revision, size, State::Effort::Final);
        if (!progress) return progress.error();
        if (progress->complete) return Done{};
    }
}
Status Renderer::present(const scene::Scene& scene) {
    State& s = *state_;
    assert(s.shown && "present() before the first advance()");
    s.context.device().setScreenSize(s.size);
    return s.runGraph([&](graph::FrameGraph& graph) {
        const TextureDesc screen{.size = s.size, .format = Format::RGBA8};
        return s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                               false);
    });
}

Status Renderer::present(const scene::Scene& scene, const Beside& beside) {
    State& s = *state_;
    assert(s.shown && "present() before the first advance()");
    assert(beside.truth.size() == s.size && beside.truth.channels == 4);
    s.takeTruth(beside);
    s.context.device().setScreenSize(beside.screen);
    const graph::Texture linear(s.context.device(), {.size = s.size, .format = Format::RGBA32F},
                                "frame.linear");
    return s.runGraph([&](graph::FrameGraph& graph) { return s.recordBeside(graph, scene, beside, linear); });
}

bool Renderer::drop(int object, const views::WaterDrop& drop) {
    views::Waters& waters = state_->compose.waters();
    if (!waters.of(object)) return false;
    waters.fall(object, drop);
    return true;
}

void Renderer::wait() { state_->context.device().wait(state_->picture().handle()); }

Result<Image> Renderer::read(const scene::Scene& scene, Aov aov) {
    State& s = *state_;
    if (scene.view.show == aov && s.complete()) return s.display(scene, true);
    scene::Scene other = scene;
    other.view.show = aov;
    s.started = false;
    if (Status finished = finish(other, s.revision, s.size); !finished) return finished.error();
    s.started = false; // what is shown now belongs to the copy
    return s.display(other, true);
}

Result<Image> Renderer::readDisplay(const scene::Scene& scene) {
    Result<Image> image = state_->display(scene, false);
    if (!image) return image;
    for (std::size_t i = 0; i < image->pixels.size(); i += 4) {
        const float coverage = image->pixels[i + 3];
        for (int channel = 0; channel < 3 && coverage > 0; ++channel)
            image->pixels[i + channel] = std::min(1.0f, image->pixels[i + channel] / coverage);
    }
    return image;
}

Result<std::optional<caustics::Energy>> Renderer::energy(const scene::Scene& scene) {
    const Drawn drawn; // the maps show what is hidden as well
    const views::Eye eye = views::makeEye(scene, float(state_->size.x) / float(state_->size.y));
    const scene::Scene used = state_->chosen(scene);
    return state_->compose.energy(state_->composeInputs(used, eye, drawn));
}

Stats Renderer::stats() const {
    Stats stats = state_->stats;
    stats.bytes = state_->context.device().textureBytes() + state_->context.device().indexBytes();
    stats.settings = state_->choiceText();
    stats.predicted = std::max(state_->choice ? state_->choice->predicted : 0,
                               state_->glassChoice ? state_->glassChoice->predicted : 0);
    return stats;
}

void Renderer::release() {
    State& s = *state_;
    for (graph::Texture* texture :
         {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.scratch, &s.lightTable, &s.truth})
        *texture = graph::Texture();
    s.shownKey.reset();
    s.compose.clear();
    s.transfers.clear();
    s.images.clear();
    s.pool.trim();
    s.pool.trim();
    s.started = false;
}

} // namespace lucent::frame
