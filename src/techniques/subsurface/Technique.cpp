#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/subsurface/Subsurface.h"

#include <algorithm>

namespace lucent::subsurface {

namespace {

using graph::TextureId;
using scene::Aov;

Settings settingsOf(const scene::Scene& scene) {
    Settings settings = scene.technique.at("subsurface").as<Settings>();
    if (scene.view.matt) settings.method = Method::Lambert;
    return settings;
}

class SubsurfaceGuest : public technique::Guest {
public:
    explicit SubsurfaceGuest(const technique::Store& store) : store_(store), subsurface_(store.context) {}

    Status prepare(const technique::Picture& picture) override {
        plan_.reset();
        Result<Plan> plan = subsurface_.plan(picture.readings, store_.pool, picture.scene,
                                             meshesOf(scattering(picture.drawables)),
                                             settingsOf(picture.scene), picture.isPreview);
        if (!plan) return plan.error();
        if (picture.readings.areThere()) plan_ = std::move(*plan);
        return Done{};
    }

    bool shades(const scene::Scene& scene) const override {
        const Aov show = scene.view.show;
        return Subsurface::need(scene) &&
               (show == Aov::Color || show == Aov::Radiosity || show == Aov::Irradiance);
    }
    bool keepsLight(const scene::Scene& scene) const override { return shades(scene); }
    views::Bounds lit(const technique::Picture& picture) const override {
        return boundsOfAll(scattering(picture.drawables));
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        const technique::Picture& picture = passes.picture;
        if (slice.clears) views::recordNothing(passes.graph, "before what scatters", slice.target);
        if (!plan_) return Done{};
        const Aov show = picture.scene.view.show;
        return subsurface_.light(passes.graph,
                                 {.scene = picture.scene,
                                  .eye = picture.eye,
                                  .size = picture.size,
                                  .solids = meshesOf(scattering(passes.posed)),
                                  .casters = changingLight(picture.scene, passes.posed),
                                  .surface = passes.surface,
                                  .samples = slice.samples,
                                  .table = slice.table,
                                  .first = slice.first,
                                  .end = slice.end,
                                  .placed = slice.placed,
                                  .occlusion = slice.occlusion,
                                  .flux = slice.flux,
                                  .fluxOn = slice.fluxOn,
                                  .radiosity = show == Aov::Radiosity,
                                  .irradiance = show == Aov::Irradiance},
                                 *plan_, settingsOf(picture.scene));
    }

    Status scatter(const technique::Passes& passes, TextureId shown) override {
        const technique::Picture& picture = passes.picture;
        const Aov show = picture.scene.view.show;
        const bool showsFlux = show == Aov::Radiosity || show == Aov::Irradiance;
        if (!plan_ || (show != Aov::Color && !showsFlux)) return Done{};
        const std::vector<views::DrawnMesh> solids = meshesOf(scattering(passes.posed));
        const bool painted = std::any_of(solids.begin(), solids.end(),
                                         [](const views::DrawnMesh& mesh) { return mesh.paint.has_value(); });
        TextureId matt;
        if (painted && !showsFlux) {
            Result<TextureId> copied = recordMatt(passes.graph, shown, picture.size);
            if (!copied) return copied.error();
            matt = *copied;
        }
        return subsurface_.record(
            passes.graph,
            {.scene = picture.scene,
             .eye = picture.eye,
             .solids = solids,
             .casters = changingLight(picture.scene, passes.posed),
             .surface = passes.surface,
             .environment = picture.environment,
             .target = shown,
             .radiosity = show == Aov::Radiosity,
             .irradiance = show == Aov::Irradiance,
             .size = picture.size,
             .matt = matt,
             .pictureOf = [this](const views::LampPoint& lamp) { return store_.images.image(lamp.picture); }},
            *plan_, settingsOf(picture.scene));
    }

    std::vector<std::string> leftOut(const technique::Picture& picture) const override {
        std::vector<std::string> lines;
        for (const views::DrawnMesh& mesh : meshesOf(scattering(picture.drawables)))
            if (mesh.paint && mesh.paint->isBlurred() &&
                settingsOf(picture.scene).method == Method::Diffusion)
                lines.push_back("blur painted on object \"" + mesh.object->name +
                                "\": method diffusion spreads light as the material says");
        return lines;
    }
    void forgetRecorded() override { subsurface_.forgetRecorded(); }
    void clear() override {
        plan_.reset();
        subsurface_.clear();
    }

private:
    // Those whose pixels are drawn here.
    static views::Drawables scattering(views::Drawables list) {
        return filtered(std::move(list), [](const views::Drawable& one) { return scatters(*one.object); });
    }

    // Painted objects as if they were opaque: what is drawn into cannot be read as well.
    Result<TextureId> recordMatt(graph::FrameGraph& graph, TextureId shown, ivec2 size) {
        const gl::Program* program = store_.context.program("subsurface/matt");
        TextureId matt;
        graph.addPass("subsurface.matt", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("painted objects are matt where they are not translucent");
            pass.sample(shown);
            matt = pass.createColor("subsurface.matt", {.size = size, .format = graph::Format::RGBA32F});
            return [=](const graph::Resources& resources, graph::Commands& commands) {
                commands.draw({.program = program, .textures = {{"uShown", resources[shown]}}});
            };
        });
        return matt;
    }

    technique::Store store_;
    Subsurface subsurface_;
    std::optional<Plan> plan_;
};

bool isMethod(const scene::Scene& scene, std::initializer_list<Method> methods) {
    return std::find(methods.begin(), methods.end(), settingsOf(scene).method) != methods.end();
}
bool sums(const scene::Scene& scene) { return isMethod(scene, {Method::Multires, Method::Splat}); }
bool solves(const scene::Scene& scene) { return isMethod(scene, {Method::Diffusion}); }

constexpr double kErrors[] = {0.1, 0.04, 0.016, 0.0064};
constexpr double kCells[] = {24, 48, 96};
constexpr technique::Knob kKnobs[] = {
    {.id = "epsilon",
     .coarse = 0.1,
     .costsLess = true,
     .steps = kErrors,
     .words = "error of splats",
     .acts = sums},
    {.id = "mostSplats", .coarse = 64, .acts = sums},
    {.id = "cells", .coarse = 24, .steps = kCells, .words = "cells", .acts = solves},
};
constexpr Aov kAovs[] = {Aov::Radiosity};
constexpr Group kFirst[] = {Group::Mode, Group::Subsurface, Group::Light, Group::View};

bool anyScatters(const scene::Scene& scene) { return Subsurface::need(scene).has_value(); }
const technique::NotDrawn kLimits[] = {
    {"painted blur", "method diffusion spreads light as the material says; multires and splat draw it",
     [](const scene::Scene& scene) {
         return solves(scene) &&
                std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
                    return object.painting &&
                           std::any_of(object.painting->strokes.begin(), object.painting->strokes.end(),
                                       [](const scene::Stroke& stroke) {
                                           return stroke.brush.map == scene::PaintMap::Blur;
                                       });
                });
     },
     scene::PaintMap::Blur},
    {"layers and thickness of a translucent material", "method diffusion solves the body itself",
     [](const scene::Scene& scene) {
         return solves(scene) && std::any_of(scene.objects.begin(), scene.objects.end(), [](const auto& one) {
                    return scatters(one) && (!one.material.translucent().layers.empty() ||
                                             one.material.translucent().thickness > 0);
                });
     }},
    {"light that scatters once inside objects", "diffusion leaves it out (dissertation ch. 6)", anyScatters},
    {"objects in what translucent surfaces mirror", "they mirror lamps and the environment past everything",
     [](const scene::Scene& scene) {
         return anyScatters(scene) && scene.objects.size() > 1 && views::hasEnvironment(scene);
     }},
    {"light that scattering objects send each other", "they receive lamps and the environment",
     [](const scene::Scene& scene) {
         return std::count_if(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
                    return !object.isField() && object.material.isScattering();
                }) > 1;
     }},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "subsurface",
    .need = Subsurface::need,
    .shades = scatters,
    .acts = [](const lucent::Settings& settings,
               std::string_view id) { return acts(settings.as<Settings>(), id); },
    .aovs = kAovs,
    .knobs = kKnobs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "subsurface", .place = 3, .first = kFirst},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<SubsurfaceGuest>(store);
    },
};

} // namespace lucent::subsurface
