#include "frame/Compose.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace lucent::frame {

using graph::Format;
using graph::TextureId;

namespace {

// Of a first look.
constexpr int kCoarseSamples = 4; // points that stand for a lamp
constexpr int kCoarseGrid = 64;   // rays a side, of caustics

TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
    return graph.import(texture.handle(), texture.desc(), texture.label());
}

bool hasEnvironment(const scene::Scene& scene) { return scene.environment && scene.environment->enabled; }

// Those that the camera does not leave out.
std::vector<views::PosedMesh> seen(const std::vector<views::PosedMesh>& meshes) {
    std::vector<views::PosedMesh> list;
    std::copy_if(meshes.begin(), meshes.end(), std::back_inserter(list),
                 [](const views::PosedMesh& mesh) { return mesh.drawn.object->visible; });
    return list;
}

struct BackgroundBlock {
    views::ViewBlock view;
    mat4 mapFromWorld;
    float intensity;
    int padding[3] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(BackgroundBlock, view));
            list.insert(list.end(), {{"mapFromWorld", offsetof(BackgroundBlock, mapFromWorld)},
                                     {"intensity", offsetof(BackgroundBlock, intensity)}});
            return list;
        }();
        static const graph::BlockLayout layout{"BackgroundBlock", sizeof(BackgroundBlock), members};
        return layout;
    }
};

} // namespace

Result<Drawn> drawnOf(const scene::Scene& scene, views::ImageCache& images, const views::Waters& waters) {
    Result<std::vector<views::DrawnObject>> fields = views::drawnObjects(scene, images);
    if (!fields) return fields.error();
    Result<views::DrawnMeshes> meshes = views::drawnMeshes(scene, images, false, &waters);
    if (!meshes) return meshes.error();
    return Drawn{std::move(*fields), std::move(*meshes)};
}

caustics::Settings Compose::causticSettings(const Inputs& in) const {
    auto settings = in.scene.technique.at("caustics").as<caustics::Settings>();
    if (in.coarse) {
        settings.lightSamples = std::min(settings.lightSamples, kCoarseSamples);
        settings.grid = std::min(settings.grid, kCoarseGrid);
    }
    return settings;
}

// Layers have depths of their own, evenly spaced, so that glass may stand right before the eye.
views::Eye Compose::closeEye(const Inputs& in) {
    const ivec2 size = in.shown.desc().size;
    return views::makeEye(in.scene, float(size.x) / float(size.y), 1e-6f);
}

Status Compose::prepare(const Inputs& in) {
    caustic_.reset();
    if (!in.drawn.meshes.solid.empty() && caustics::Caustics::need(in.scene)) {
        Result<views::DrawnMeshes> all = views::drawnMeshes(in.scene, images_, true, &waters_);
        if (!all) return all.error();
        Result<caustics::Plan> plan = caustics_.plan(pool_, in.scene, in.eye, *all, causticSettings(in));
        if (!plan) return plan.error();
        caustic_ = std::move(*plan);
    }
    if (!replaces(in.scene, in.drawn)) {
        through_ = graph::Texture();
        return Done{};
    }
    const graph::TextureDesc& desc = in.shown.desc();
    if (!through_ || through_.desc() != desc)
        through_ = graph::Texture(context_.device(), desc, "frame.through");
    const std::vector<views::DrawnMesh>& glass = in.drawn.meshes.glass;
    if (layerCount_ > 0 || glass.empty()) return Done{};
    Result<int> count =
        views::countLayers(pool_, context_, closeEye(in), glass, in.scene.view.time, desc.size);
    if (!count) return count.error();
    layerCount_ = std::max(1, *count);
    return Done{};
}

Status Compose::record(graph::FrameGraph& graph, const Inputs& in) {
    if (in.drawn.count() == in.drawn.fields.size()) return Done{};
    // Every mesh is posed once, hidden ones too: they cast shadows and caustics.
    Result<views::DrawnMeshes> all = views::drawnMeshes(in.scene, images_, true, &waters_);
    if (!all) return all.error();
    const float time = in.scene.view.time;
    Result<std::vector<views::PosedMesh>> solids = views::recordPose(graph, context_, all->solid, time);
    if (!solids) return solids.error();
    Result<std::vector<views::PosedMesh>> glass = views::recordPose(graph, context_, all->glass, time);
    if (!glass) return glass.error();
    const TextureId surface = import(graph, in.surface), shown = import(graph, in.shown);
    graph.keep(shown);
    if (!in.drawn.meshes.solid.empty())
        if (Status s = recordSolids(graph, in, *solids, *glass, surface, shown); !s) return s;
    if (!in.drawn.meshes.glass.empty())
        return recordThrough(graph, in, seen(*solids), seen(*glass), surface, shown);
    if (replaces(in.scene, in.drawn)) return recordBackground(graph, in, surface, shown);
    return Done{};
}

bool Compose::replaces(const scene::Scene& scene, const Drawn& drawn) {
    const bool background = hasEnvironment(scene) && scene.view.show == scene::Aov::Color;
    return !drawn.meshes.glass.empty() || (background && !drawn.meshes.solid.empty());
}

Status Compose::recordBackground(graph::FrameGraph& graph, const Inputs& in, TextureId surface,
                                 TextureId shown) {
    Result<const gl::Program*> program = context_.program("frame/background");
    if (!program) return program.error();
    Result<graph::TextureHandle> environment = environmentMap(in.scene);
    if (!environment) return environment.error();
    const scene::Environment& light = *in.scene.environment;
    const BackgroundBlock block{.view = views::viewBlock(in.eye, in.shown.desc().size),
                                .mapFromWorld = mat4(glm::transpose(rotationFromDegrees(light.rotation))),
                                .intensity = light.intensity};
    const TextureId target = import(graph, through_);
    graph.keep(target);
    graph.addPass("frame.background", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the environment behind everything else");
        pass.sample(surface);
        pass.sample(shown);
        pass.write(target);
        return [=, program = *program, map = *environment](const graph::Resources& resources,
                                                           graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uSurface", resources[surface]},
                                        {"uShown", resources[shown]},
                                        {"uEnvironment", map}}});
        };
    });
    return Done{};
}

Status Compose::recordSolids(graph::FrameGraph& graph, const Inputs& in,
                             const std::vector<views::PosedMesh>& solids,
                             const std::vector<views::PosedMesh>& glass, TextureId surface, TextureId shown) {
    const ivec2 size = in.shown.desc().size;
    TextureId flux;
    if (caustic_) {
        Result<TextureId> irradiance = caustics_.record(graph,
                                                        {.scene = in.scene,
                                                         .eye = in.eye,
                                                         .glass = glass,
                                                         .solids = solids,
                                                         .surface = surface,
                                                         .size = size},
                                                        *caustic_, causticSettings(in));
        if (!irradiance) return irradiance.error();
        flux = *irradiance;
    }
    std::vector<views::PosedMesh> casters = solids;
    casters.insert(casters.end(), glass.begin(), glass.end());
    Result<graph::TextureHandle> environment = environmentMap(in.scene);
    if (!environment) return environment.error();
    auto settings = in.scene.technique.at("brdf").as<brdf::Settings>();
    if (in.coarse) settings.lightSamples = std::min(settings.lightSamples, kCoarseSamples);
    return brdf_.record(graph,
                        {.scene = in.scene,
                         .eye = in.eye,
                         .solids = seen(solids),
                         .casters = casters,
                         .surface = surface,
                         .flux = flux,
                         .environment = *environment,
                         .target = shown,
                         .show = in.scene.view.show,
                         .size = size},
                        settings);
}

Status Compose::recordThrough(graph::FrameGraph& graph, const Inputs& in,
                              const std::vector<views::PosedMesh>& solids,
                              const std::vector<views::PosedMesh>& glass, TextureId surface,
                              TextureId shown) {
    const ivec2 size = in.shown.desc().size;
    const views::Eye eye = closeEye(in);
    const int most = in.scene.technique.at("refract").as<refract::Settings>().maxLayers;
    TextureId solid;
    if (!in.drawn.fields.empty() || !solids.empty()) {
        solid = graph.create("views.solid", {.size = size, .format = Format::RGBA32F});
        if (Status s =
                views::recordSolid(graph, context_, eye, in.drawn.fields, solids, surface, solid, size);
            !s)
            return s;
    }
    Result<views::Layers> layers =
        views::recordLayers(graph, context_, eye, glass, size, std::min(layerCount_, most), solid);
    if (!layers) return layers.error();
    Result<graph::TextureHandle> environment = environmentMap(in.scene);
    if (!environment) return environment.error();
    const TextureId target = import(graph, through_);
    graph.keep(target);
    return refract_.record(graph,
                           {.eye = eye,
                            .glass = glass,
                            .layers = *layers,
                            .opaque = solid ? shown : TextureId{},
                            .solid = solid,
                            .environment = *environment,
                            .light = hasEnvironment(in.scene) ? &*in.scene.environment : nullptr,
                            .target = target,
                            .show = in.scene.view.show},
                           size);
}

Result<graph::TextureHandle> Compose::environmentMap(const scene::Scene& scene) {
    if (!hasEnvironment(scene)) return graph::TextureHandle::None;
    return images_.image(scene.environment->map);
}

void Compose::clear() {
    through_ = graph::Texture();
    caustic_.reset();
    waters_.clear();
    forget();
}

} // namespace lucent::frame
