#include "frame/Compose.h"

#include "base/Log.h"
#include "frame/Inside.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace lucent::frame {

using graph::Format;
using graph::TextureId;

namespace {

// Of a first look.
constexpr int kCoarseSamples = 4;      // points that stand for a lamp
constexpr int kCoarseGrid = 64;        // rays a side, of caustics
constexpr float kCoarseEpsilon = 0.1f; // of scattering

TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
    return graph.import(texture.handle(), texture.desc(), texture.label());
}

using views::hasEnvironment;

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

std::vector<views::PosedMesh> Posed::visible(const std::vector<views::PosedMesh>& meshes) {
    std::vector<views::PosedMesh> list;
    std::copy_if(meshes.begin(), meshes.end(), std::back_inserter(list),
                 [](const views::PosedMesh& mesh) { return mesh.drawn.object->visible; });
    return list;
}

Result<Posed> posedOf(graph::FrameGraph& graph, gl::Context& context, const scene::Scene& scene,
                      views::ImageCache& images, const views::Waters& waters) {
    Result<std::vector<views::DrawnObject>> fields = views::drawnObjects(scene, images, true);
    if (!fields) return fields.error();
    Result<views::DrawnMeshes> meshes = views::drawnMeshes(scene, images, true, &waters);
    if (!meshes) return meshes.error();
    Posed posed{std::move(*fields), {}, {}};
    for (const auto& [drawn, list] :
         {std::pair{&meshes->solid, &posed.solid}, {&meshes->glass, &posed.glass}}) {
        Result<std::vector<views::PosedMesh>> stands =
            views::recordPose(graph, context, *drawn, scene.view.time);
        if (!stands) return stands.error();
        *list = std::move(*stands);
    }
    return posed;
}

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
        settings.refine = false;
    }
    return settings;
}

subsurface::Settings Compose::scatteringSettings(const Inputs& in) const {
    auto settings = in.scene.technique.at("subsurface").as<subsurface::Settings>();
    if (in.coarse) {
        settings.lightSamples = std::min(settings.lightSamples, kCoarseSamples);
        settings.epsilon = std::max(settings.epsilon, kCoarseEpsilon);
    }
    return settings;
}

// Layers have depths of their own, evenly spaced, so that glass may stand right before the eye.
views::Eye Compose::closeEye(const Inputs& in) {
    const ivec2 size = in.shown.desc().size;
    return views::makeEye(in.scene, float(size.x) / float(size.y), 1e-6f);
}

Status Compose::prepare(const Inputs& in) {
    unsure_ = false;
    caustic_.reset();
    if (caustics::Caustics::need(in.scene)) {
        Result<views::DrawnMeshes> all = views::drawnMeshes(in.scene, images_, true, &waters_);
        if (!all) return all.error();
        Result<caustics::Plan> plan =
            caustics_.plan(pool_, in.scene, in.eye, *all, in.drawn.fields, causticSettings(in));
        if (!plan) return plan.error();
        caustic_ = std::move(*plan);
    }
    scattering_.reset();
    if (subsurface::Subsurface::need(in.scene)) {
        Result<subsurface::Plan> plan =
            subsurface_.plan(pool_, in.scene, in.drawn.meshes.solid, scatteringSettings(in));
        if (!plan) return plan.error();
        scattering_ = std::move(*plan);
    }
    if (!replaces(in.scene, in.drawn)) {
        through_ = graph::Texture();
        layers_ = {};
        return Done{};
    }
    const graph::TextureDesc& desc = in.shown.desc();
    if (!through_ || through_.desc() != desc)
        through_ = graph::Texture(context_.device(), desc, "frame.through");
    return in.drawn.meshes.glass.empty() ? Done{} : countLayers(in);
}

bool Compose::peels(const Inputs& in) {
    return isNumbered(in.scene.view.show) ||
           in.scene.technique.at("refract").as<refract::Settings>().layers == refract::LayerMethod::Peel;
}

// Reads a picture back only for the first picture of these objects; slices are counted for each view.
Status Compose::countLayers(const Inputs& in) {
    std::vector<const views::MeshTextures*> meshes;
    for (const views::DrawnMesh& mesh : in.drawn.meshes.glass)
        meshes.push_back(mesh.mesh);
    if (meshes != counted_) layerCounter_.reset();
    counted_ = std::move(meshes);
    layerCounter_.poll();
    if (peels(in) ? layerCounter_.known() : layerCount_ > 0) return Done{};
    Result<int> count = views::countLayers(pool_, context_, closeEye(in), in.drawn.meshes.glass,
                                           in.scene.view.time, in.shown.desc().size);
    if (!count) return count.error();
    layerCount_ = std::max(1, *count);
    layerCounter_.start(layerCount_);
    return Done{};
}

// As many layers as there were, and a question about what is behind them. Those that are kept are asked about
// once.
Result<views::Layers> Compose::recordPeeled(graph::FrameGraph& graph, const Inputs& in,
                                            const std::vector<views::PosedMesh>& glass, TextureId solid,
                                            int most, views::KeptLayers* kept) {
    const int count = std::min(layerCounter_.drawn(), most);
    const bool stands = kept && kept->current && kept->count == count;
    const bool asks = !stands && count == layerCounter_.drawn();
    unsure_ = asks && layerCounter_.waits();
    unanswered_ = 0;
    Result<views::Layers> layers =
        views::recordLayers(graph, context_, closeEye(in), glass, in.shown.desc().size, count, solid,
                            asks ? layerCounter_.ask() : views::LayerQueries{}, kept);
    if (kept && unsure_) kept->current = false; // to be drawn and asked about again
    return layers;
}

// Layers stay while all surfaces do and the eye does: light and materials may change.
views::KeptLayers* Compose::keptLayers(const Inputs& in) {
    SurfaceKey key = surfaceKey(in.scene, in.shown.desc().size, waters_.changes());
    if (layered_ != key) layers_.current = false;
    layered_ = std::move(key);
    return &layers_;
}

Result<bool> Compose::settle(const Inputs& in) {
    constexpr int kPatience = 8; // frames
    if (layerCounter_.poll()) return true;
    if (!layerCounter_.waits()) return unsure_;
    if (++unanswered_ < kPatience) return false;
    const int drawn = layerCounter_.drawn();
    layerCounter_.reset();
    if (Status s = countLayers(in); !s) return s.error();
    unsure_ = false;
    return layerCounter_.drawn() > drawn;
}

Status Compose::record(graph::FrameGraph& graph, const Inputs& in) {
    if (!isNeeded(in.scene, in.drawn)) return Done{};
    // Every mesh is posed once, hidden ones too: they cast shadows and caustics.
    Result<views::DrawnMeshes> all = views::drawnMeshes(in.scene, images_, true, &waters_);
    if (!all) return all.error();
    const float time = in.scene.view.time;
    Result<std::vector<views::PosedMesh>> solids = views::recordPose(graph, context_, all->solid, time);
    if (!solids) return solids.error();
    Result<std::vector<views::PosedMesh>> glass = recordGlass(graph, in.scene, all->glass);
    if (!glass) return glass.error();
    if (isNumbered(in.scene.view.show)) return recordInside(graph, in, *solids, *glass);
    const TextureId surface = import(graph, in.surface), shown = import(graph, in.shown);
    graph.keep(shown);
    if (!in.drawn.meshes.solid.empty())
        if (Status s = recordSolids(graph, in, *solids, *glass, surface, shown); !s) return s;
    if (!in.drawn.meshes.glass.empty())
        return recordThrough(graph, in, Posed::visible(*solids), Posed::visible(*glass), surface, shown);
    if (replaces(in.scene, in.drawn)) return recordBackground(graph, in, surface, shown);
    return Done{};
}

// Triangles stay where they are while their objects do.
Result<std::vector<views::PosedMesh>> Compose::recordGlass(graph::FrameGraph& graph,
                                                           const scene::Scene& scene,
                                                           const std::vector<views::DrawnMesh>& glass) {
    std::vector<views::ObjectKey> standing;
    for (const views::DrawnMesh& mesh : glass)
        standing.push_back(views::objectKey(*mesh.object, scene.view.time));
    if (standing != triangled_ || watersThen_ != waters_.changes()) triangles_.current = false;
    triangled_ = std::move(standing);
    watersThen_ = waters_.changes();
    return views::recordPose(graph, context_, glass, scene.view.time, &triangles_);
}

bool Compose::isNeeded(const scene::Scene& scene, const Drawn& drawn) {
    return drawn.count() > drawn.fields.size() || (!drawn.fields.empty() && caustics::Caustics::need(scene));
}

bool Compose::replaces(const scene::Scene& scene, const Drawn& drawn) {
    const bool background = hasEnvironment(scene) && scene.view.show == scene::Aov::Color;
    if (isNumbered(scene.view.show)) return isNeeded(scene, drawn);
    return !drawn.meshes.glass.empty() || (background && !drawn.meshes.solid.empty());
}

// What the techniques work on, in place of the picture.
Status Compose::recordInside(graph::FrameGraph& graph, const Inputs& in,
                             const std::vector<views::PosedMesh>& solids,
                             const std::vector<views::PosedMesh>& glass) {
    const scene::View& view = in.scene.view;
    const ivec2 size = in.shown.desc().size;
    const TextureId target = import(graph, through_);
    graph.keep(target);
    if (view.show == scene::Aov::CausticMap) {
        if (!caustic_ || view.layer > int(caustic_->lights.size())) {
            recordNothing(graph, "no lamp has that many points that throw light by way of glass or mirrors",
                          target);
            return Done{};
        }
        const caustics::Inputs inputs{in.scene, in.eye, glass, solids, {}, size, in.drawn.fields};
        Result<caustics::Map> map = caustics_.recordMap(
            graph, inputs, caustic_->lights[std::size_t(view.layer - 1)], causticSettings(in));
        return map ? recordMapView(graph, context_, *map, target, size) : map.error();
    }
    if (in.drawn.meshes.glass.empty()) {
        recordNothing(graph, "nothing that is seen refracts", target);
        return Done{};
    }
    Result<views::Layers> layers =
        recordPeeled(graph, in, Posed::visible(glass), {}, views::kMostLayers, nullptr);
    return layers ? recordLayerView(graph, context_, *layers, view.layer, view.show, target) : layers.error();
}

Result<std::optional<caustics::Energy>> Compose::energy(const Inputs& in) {
    if (!caustic_) return std::optional<caustics::Energy>();
    Result<views::DrawnMeshes> all = views::drawnMeshes(in.scene, images_, true, &waters_);
    if (!all) return all.error();
    Result<std::vector<views::DrawnObject>> fields = views::drawnObjects(in.scene, images_);
    if (!fields) return fields.error();
    Result<caustics::Energy> energy =
        caustics_.measure(pool_, in.scene, in.eye, *all, *fields, *caustic_, causticSettings(in));
    if (!energy) return energy.error();
    return std::optional(*energy);
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

Result<TextureId> Compose::recordCaustics(graph::FrameGraph& graph, const Inputs& in, const Posed& posed,
                                          TextureId surface) {
    if (!caustic_) return TextureId{};
    return caustics_.record(graph,
                            {.scene = in.scene,
                             .eye = in.eye,
                             .glass = posed.glass,
                             .solids = posed.solid,
                             .surface = surface,
                             .size = in.shown.desc().size,
                             .fields = in.drawn.fields},
                            *caustic_, causticSettings(in));
}

// What is not summed up sample by sample: mirrors, and light that is scattered inside.
Status Compose::recordSolids(graph::FrameGraph& graph, const Inputs& in,
                             const std::vector<views::PosedMesh>& solids,
                             const std::vector<views::PosedMesh>& glass, TextureId surface, TextureId shown) {
    const ivec2 size = in.shown.desc().size;
    std::vector<views::PosedMesh> casters = solids;
    casters.insert(casters.end(), glass.begin(), glass.end());
    const scene::Aov show = in.scene.view.show;
    const bool isLight = show == scene::Aov::Radiosity || show == scene::Aov::Irradiance;
    if (show != scene::Aov::Color && !isLight) return Done{};
    std::vector<views::PosedMesh> mirrors, seen = Posed::visible(solids);
    std::copy_if(seen.begin(), seen.end(), std::back_inserter(mirrors),
                 [](const views::PosedMesh& mesh) { return mesh.drawn.object->material.isMirror(); });
    Result<graph::TextureHandle> environment = environmentMap(in.scene);
    if (!environment) return environment.error();
    if (!isLight)
        if (Status s = brdf_.recordMirrors(graph, {.scene = in.scene,
                                                   .eye = in.eye,
                                                   .size = size,
                                                   .mirrors = mirrors,
                                                   .surface = surface,
                                                   .environment = *environment,
                                                   .target = shown});
            !s)
            return s;
    if (!scattering_) return Done{};
    const bool painted = std::any_of(
        seen.begin(), seen.end(), [](const views::PosedMesh& mesh) { return mesh.drawn.paint.has_value(); });
    TextureId matt;
    if (painted && !isLight) {
        Result<TextureId> copied = recordMatt(graph, shown, size);
        if (!copied) return copied.error();
        matt = *copied;
    }
    return recordScattering(graph, in, seen, casters, surface, matt, shown);
}

// Painted objects as if they were opaque: what is drawn into cannot be read as well.
Result<TextureId> Compose::recordMatt(graph::FrameGraph& graph, TextureId shown, ivec2 size) {
    Result<const gl::Program*> program = context_.program("frame/copy");
    if (!program) return program.error();
    TextureId matt;
    graph.addPass("frame.matt", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("painted objects are matt where they are not translucent");
        pass.sample(shown);
        matt = pass.createColor("frame.matt", {.size = size, .format = Format::RGBA32F});
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .textures = {{"uShown", resources[shown]}}});
        };
    });
    return matt;
}

Status Compose::recordScattering(graph::FrameGraph& graph, const Inputs& in,
                                 const std::vector<views::PosedMesh>& solids,
                                 const std::vector<views::PosedMesh>& casters, TextureId surface,
                                 TextureId matt, TextureId shown) {
    Result<graph::TextureHandle> environment = environmentMap(in.scene);
    if (!environment) return environment.error();
    return subsurface_.record(graph,
                              {.scene = in.scene,
                               .eye = in.eye,
                               .solids = solids,
                               .casters = casters,
                               .surface = surface,
                               .environment = *environment,
                               .target = shown,
                               .radiosity = in.scene.view.show == scene::Aov::Radiosity,
                               .irradiance = in.scene.view.show == scene::Aov::Irradiance,
                               .size = in.shown.desc().size,
                               .matt = matt},
                              *scattering_, scatteringSettings(in));
}

Status Compose::recordThrough(graph::FrameGraph& graph, const Inputs& in,
                              const std::vector<views::PosedMesh>& solids,
                              const std::vector<views::PosedMesh>& glass, TextureId surface,
                              TextureId shown) {
    const ivec2 size = in.shown.desc().size;
    const views::Eye eye = closeEye(in);
    const auto settings = in.scene.technique.at("refract").as<refract::Settings>();
    if (Status s = refract::check(settings); !s) return s;
    if (settings.layers == refract::LayerMethod::Voxels)
        if (Status s = checkVoxels(in, eye, settings); !s) return s;
    TextureId solid;
    if (!in.drawn.fields.empty() || !solids.empty()) {
        solid = graph.create("views.solid", {.size = size, .format = Format::RGBA32F});
        if (Status s =
                views::recordSolid(graph, context_, eye, in.drawn.fields, solids, surface, solid, size);
            !s)
            return s;
    }
    Result<views::Layers> layers =
        settings.layers == refract::LayerMethod::Peel
            ? recordPeeled(graph, in, glass, solid, settings.maxLayers, keptLayers(in))
            : views::recordLayers(graph, context_, eye, glass, size, 1, solid);
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
                            .show = in.scene.view.show,
                            .count = layerCount_},
                           size, settings);
}

// Says when surfaces lie too close for the slices. It reads a picture back, so it looks again only when the
// number of layers has changed, or the slices.
Status Compose::checkVoxels(const Inputs& in, const views::Eye& eye, const refract::Settings& settings) {
    const int key = layerCount_ + 64 * int(settings.slices) + 128 * int(settings.bounds);
    if (voxelsChecked_ == key) return Done{};
    Result<views::VoxelCount> count =
        views::countVoxels(pool_, context_, eye, in.drawn.meshes.glass, in.scene.view.time,
                           in.shown.desc().size, refract::voxelSettings(settings));
    if (!count) return count.error();
    if (count->sharing > 0)
        warnOnce("refract: refractive surfaces lie closer than a slice of depth: " +
                 std::to_string(count->sharing) + " of " + std::to_string(count->surfaces) +
                 " in all pixels share slices with others; rays take them as lying in one place");
    voxelsChecked_ = key;
    return Done{};
}

Result<graph::TextureHandle> Compose::environmentMap(const scene::Scene& scene) {
    if (!hasEnvironment(scene)) return graph::TextureHandle::None;
    return images_.image(scene.environment->map);
}

void Compose::clear() {
    through_ = graph::Texture();
    caustic_.reset();
    scattering_.reset();
    subsurface_.clear();
    waters_.clear();
    voxelsChecked_ = 0;
    layerCounter_.reset();
    counted_.clear();
    triangles_ = {};
    layers_ = {};
    unsure_ = false;
    forget();
}

} // namespace lucent::frame
