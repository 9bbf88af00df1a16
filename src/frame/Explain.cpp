// What is drawn and why, in words.
#include "frame/RendererState.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;

namespace {

std::string linesOf(const std::vector<std::string>& lines, const char* none) {
    std::string text;
    for (const std::string& line : lines)
        text += "  " + line + "\n";
    return text.empty() ? std::string("  ") + none + "\n" : text;
}

} // namespace

std::vector<std::string> Renderer::State::leftOut(const technique::Picture& picture) const {
    const scene::Scene& scene = picture.scene;
    std::vector<std::string> lines;
    if (visible(picture.drawables).size() < 2)
        lines.push_back("views.depth: one visible object cannot hide another");
    const auto hidden = std::count_if(scene.objects.begin(), scene.objects.end(),
                                      [](const scene::Object& object) { return !object.visible; });
    if (hidden > 0) lines.push_back(std::to_string(hidden) + " object(s): hidden from the camera");
    for (const Member& member : members)
        for (std::string& line : member.guest->leftOut(picture))
            lines.push_back(std::move(line));
    if (!scene.environment)
        lines.push_back("environment: the scene names none");
    else if (!scene.environment->enabled)
        lines.push_back("environment: switched off");
    if (scene.lights.empty()) lines.push_back("point and distant lights: the scene names none");
    if (scene.quality.maxError > 0 && !budget.matters(scene))
        lines.push_back("quality.maxError: no setting of this scene trades error for time");
    return lines;
}

// Settings that are chosen, and bakes that are there: how many coefficients are used shows only then.
Result<Renderer::State::Moment> Renderer::State::readyMoment(const scene::Scene& scene) {
    for (;;) {
        while (planning)
            if (Status planned = plan(scene); !planned) return planned.error();
        Result<Moment> moment = momentOf(scene);
        if (!moment) return moment.error();
        const Result<bool> baked = ready(*moment);
        if (!baked) return baked.error();
        if (*baked) return moment;
    }
}

Result<std::string> Renderer::explain(const scene::Scene& scene, ivec2 size) {
    State& s = *state_;
    s.shownKey.reset(); // explained as if nothing were there yet
    s.shadows.clear();
    ++s.scenery;
    s.screen = size;
    s.start(scene, s.revision + 1, size, State::Effort::Final);
    for (bool still = false; !still;) {
        const Result<bool> advanced = s.waters.advance(scene);
        if (!advanced) return advanced.error();
        still = *advanced;
    }
    const Result<State::Moment> moment = s.readyMoment(scene);
    if (!moment) return moment.error();
    s.placeLights(*s.pictured);
    s.cubesFor.reset();
    s.flatFor.reset();
    if (Status r = s.survey(*moment); !r) return r.error();
    const technique::Picture picture = s.pictureOf(*moment);
    graph::FrameGraph graph;
    const TextureDesc screen{.size = size, .format = Format::RGBA8};
    const bool geometric = views::isGeometric(scene.view.show);
    if (!geometric)
        if (const Result<bool> r = s.prepare(picture); !r) return r.error();
    const int shown = std::min(int(s.lights.size()), views::mostSamplesAtOnce(s.context, size));
    if (Status r = s.recordSlice(graph, picture, shown); !r) return r.error();
    s.composed = s.replaces(picture);
    if (!geometric)
        if (Status r = s.recordRest(graph, picture); !r) return r.error();
    const graph::Texture mean(s.context.device(), {.size = size, .format = Format::RGBA32F}, "frame.mean");
    if (s.pixelSamples(scene) > 1)
        if (Status r = s.recordMean(graph, State::import(graph, mean)); !r) return r.error();
    if (Status r = s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                                   false);
        !r)
        return r.error();
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    s.started = false;
    s.triangles.current = s.surveyed = false;
    s.asides.clear();
    for (const State::Member& member : s.members)
        member.guest->forgetRecorded();

    const auto choice = s.budget.choice();
    std::string text = choice ? "quality.maxError chose\n  " + choice->text + "\n" : "";
    text += "techniques\n";
    for (const State::Member& member : s.members)
        if (const auto reason = member.technique->need(scene))
            text += "  " + std::string(member.technique->name) + ": " + *reason + "\n";
    text += "reflection probes\n" + linesOf(s.aroundLines(), "no ray leaves what the camera shows");
    text += "passes, in the order they run\n" + graph.dump();
    text += "textures that stay\n";
    const auto line = [&](const std::string& label, std::size_t bytes) {
        text += "  " + label + ", " + std::to_string(bytes) + " bytes\n";
    };
    for (const graph::Texture* texture : {&s.surface, &s.shownSurface, &s.shown, &s.sum, &s.lightTable})
        line(texture->label() + " " + std::to_string(texture->desc().size.x) + "x" +
                 std::to_string(texture->desc().size.y) + " " + graph::name(texture->desc().format),
             texture->desc().bytes());
    line("heights, pyramids, meshes and maps of the objects", s.images.bytes());
    if (s.shadows.bytes() > 0) line("shadow views", s.shadows.bytes());
    for (const State::Member& member : s.members)
        for (const auto& [label, bytes] : member.guest->bytes())
            line(label, bytes);
    text += "left out\n" + linesOf(s.leftOut(picture), "nothing");
    return text + "not drawn\n" + linesOf(technique::notDrawn(scene), "nothing that the scene asks for");
}

} // namespace lucent::frame
