// What is drawn and why, in words.
#include "frame/RendererState.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;

std::string Renderer::State::leftOut(const scene::Scene& scene, const Drawn& drawn) const {
    const std::vector<views::DrawnObject>& objects = drawn.fields;
    std::string text;
    const auto line = [&](const std::string& what) { text += "  " + what + "\n"; };
    if (drawn.count() < 2) line("views.depth: one visible object cannot hide another");
    const auto hidden = std::count_if(scene.objects.begin(), scene.objects.end(),
                                      [](const scene::Object& object) { return !object.visible; });
    if (hidden > 0) line(std::to_string(hidden) + " object(s): hidden from the camera");
    if (drawn.meshes.glass.empty()) line("refract: no object that is seen lets light through");
    const auto& inside = scene.technique.at("subsurface").as<subsurface::Settings>();
    for (const views::DrawnMesh& mesh : drawn.meshes.solid)
        if (mesh.paint && mesh.paint->isBlurred() && inside.method == subsurface::Method::Diffusion)
            line("blur painted on object \"" + mesh.object->name +
                 "\": method diffusion spreads light as the material says");
    if (std::none_of(objects.begin(), objects.end(),
                     [](const auto& o) { return o.alpha != graph::TextureHandle::None; }))
        line("alpha: no object has an alpha image");
    if (!scene.environment)
        line("environment: the scene names none");
    else if (!scene.environment->enabled)
        line("environment: switched off");
    if (scene.lights.empty()) line("point and distant lights: the scene names none");
    if (scene.quality.maxError > 0 && !Budget::matters(scene) && !GlassBudget::matters(scene))
        line("quality.maxError: every light is a point or a direction, and hierarchy is exact for them");
    return text;
}

Result<std::string> Renderer::explain(const scene::Scene& scene, ivec2 size) {
    State& s = *state_;
    s.shownKey.reset(); // explained as if nothing were there yet
    s.start(scene, s.revision + 1, size, State::Effort::Final);
    while (s.planning)
        if (Status planned = s.plan(scene); !planned) return planned.error();
    for (bool still = false; !still;) {
        const Result<bool> advanced = s.compose.waters().advance(scene);
        if (!advanced) return advanced.error();
        still = *advanced;
    }
    Result<Drawn> drawn = drawnOf(scene, s.images, s.compose.waters());
    if (!drawn) return drawn.error();
    const views::Eye eye = views::makeEye(scene, float(size.x) / float(size.y));
    while (s.stages.back().transfer) { // how many coefficients are used shows once they are there
        const Result<bool> ready = s.makeTransfers(drawn->fields);
        if (!ready) return ready.error();
        if (!*ready) continue;
        s.lightTransfers(scene, drawn->fields);
        break;
    }
    graph::FrameGraph graph;
    const TextureDesc screen{.size = size, .format = Format::RGBA8};
    const bool geometric = isGeometric(scene.view.show);
    const scene::Scene used = s.chosen(scene);
    const Compose::Inputs in = s.composeInputs(used, eye, *drawn);
    if (!geometric)
        if (Status r = s.compose.prepare(in); !r) return r.error();
    const int shown = std::min(int(s.lights.size()), views::mostSamplesAtOnce(s.context, size));
    if (Status r = s.recordSlice(graph, scene, eye, *drawn, shown); !r) return r.error();
    s.composed = Compose::replaces(scene, *drawn) && !geometric;
    if (!geometric)
        if (Status r = s.compose.record(graph, in); !r) return r.error();
    if (Status r = s.recordDisplay(graph, scene, graph.import(graph::TextureHandle::Screen, screen, "screen"),
                                   false);
        !r)
        return r.error();
    if (Status compiled = graph.compile(); !compiled) return compiled.error();
    s.started = false;
    s.compose.forgetRecorded();

    const std::string chose = s.choiceText();
    std::string text = chose.empty() ? "" : "quality.maxError chose\n  " + chose + "\n";
    text += "techniques\n";
    for (const char* technique : {"relief", "caustics", "brdf", "subsurface", "refract"})
        if (const auto reason = need(scene, technique))
            text += std::string("  ") + technique + ": " + *reason + "\n";
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
    if (s.transfers.bytes() > 0)
        line("relief.coefficients, the transfers of all objects", s.transfers.bytes());
    const std::string left = s.leftOut(scene, *drawn);
    return text + "left out\n" + (left.empty() ? "  nothing\n" : left);
}

} // namespace lucent::frame
