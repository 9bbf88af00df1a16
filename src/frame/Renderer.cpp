#include "frame/RendererState.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using scene::Aov;

std::string_view nameOf(Task task) {
    constexpr std::string_view kNames[] = {"Choosing settings", "Drawing reflection probes", "Drawing",
                                           "Antialiasing"};
    return kNames[std::size_t(task)];
}

Renderer::Renderer(gl::Context& context) : state_(std::make_unique<State>(context)) {}
Renderer::~Renderer() = default;

Result<Progress> Renderer::advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size, bool coarse,
                                   int downscale) {
    assert(downscale == 1 || (downscale > 1 && coarse));
    state_->screen = size;
    return state_->advance(scene, revision, glm::max(size / downscale, ivec2(1)),
                           coarse ? State::Effort::Coarse : State::Effort::Progressive);
}

Status Renderer::finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size) {
    state_->screen = size;
    for (;;) {
        Result<Progress> progress = state_->advance(scene, revision, size, State::Effort::Final);
        if (!progress) return progress.error();
        if (progress->complete) return Done{};
    }
}
void Renderer::setDefaultError(float error) { state_->defaultError = error; }

bool Renderer::canPresent() const { return state_->kept.light || state_->presentable || state_->averaged; }

Status Renderer::present(const scene::Scene& scene, const scene::Camera* from) {
    State& s = *state_;
    assert(s.shown && "present() before the first advance()");
    s.context.device().setScreenSize(s.screen);
    s.reprojected = false;
    std::optional<views::Eye> eye;
    if (from) {
        scene::Scene moved = scene;
        moved.camera = *from;
        eye = s.middleEyeOf(moved);
    }
    return s.runGraph([&](graph::FrameGraph& graph) {
        return s.recordDisplay(graph, scene, s.importScreen(graph), false, eye ? &*eye : nullptr);
    });
}

Status Renderer::present(const scene::Scene& scene, const Beside& beside, const scene::Camera* from) {
    State& s = *state_;
    assert(beside.image.channels == 4);
    if (Status drawn = present(scene, from); !drawn) return drawn;
    s.takeOther(beside);
    return s.runGraph([&](graph::FrameGraph& graph) { return s.recordBeside(graph, scene, beside); });
}

bool Renderer::isReprojected() const { return state_->reprojected; }

bool Renderer::drop(int object, const views::WaterDrop& drop) {
    if (!state_->waters.of(object)) return false;
    state_->waters.fall(object, drop);
    return true;
}

void Renderer::wait() { state_->context.device().wait(state_->finished().handle()); }

Result<Image> Renderer::read(const scene::Scene& scene, Aov aov) {
    State& s = *state_;
    if (scene.view.show == aov && s.complete()) return s.display(scene, true);
    scene::Scene other = scene;
    other.view.show = aov;
    s.started = false;
    if (Status finished = finish(other, s.revision, s.screen); !finished) return finished.error();
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

Result<technique::Balance> Renderer::balance(const scene::Scene& scene, std::string_view technique) {
    State& s = *state_;
    const auto found = std::find_if(s.members.begin(), s.members.end(), [&](const State::Member& member) {
        return member.technique->name == technique;
    });
    if (found == s.members.end()) return technique::Balance{};
    Result<State::Moment> moment = s.momentOf(scene);
    if (!moment) return moment.error();
    return found->guest->balance(s.pictureOf(*moment));
}

Stats Renderer::stats() const {
    Stats stats = state_->stats;
    stats.bytes = state_->context.device().textureBytes() + state_->context.device().indexBytes();
    const auto choice = state_->budget.choice();
    stats.settings = choice ? choice->text : "";
    stats.predicted = choice ? choice->predicted : 0;
    return stats;
}

void Renderer::release() {
    State& s = *state_;
    s.drop();
    s.submitted.clear();
    s.budget.forget();
    for (graph::Texture* texture : {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.scratch, &s.lightTable,
                                    &s.through, &s.mean, &s.other, &s.depth})
        *texture = graph::Texture();
    s.kept = {};
    s.shownKey.reset();
    s.triangles = {};
    s.waters.clear();
    s.elsewhere.reset();
    s.surroundings = {};
    s.cubesFor.reset();
    s.flatFor.reset();
    for (graph::Texture* texture : {&s.aroundRadiance, &s.aroundSolid, &s.flatPictures})
        *texture = graph::Texture();
    for (const State::Member& member : s.members)
        member.guest->clear();
    s.images.clear();
    s.shadows.clear();
    s.pool.trim();
    s.pool.trim();
    s.started = false;
}

} // namespace lucent::frame
