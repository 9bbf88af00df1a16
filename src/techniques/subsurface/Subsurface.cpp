#include "techniques/subsurface/Subsurface.h"

#include "base/Log.h"
#include "shaders/subsurface/Blocks.h"
#include "techniques/subsurface/Entering.h"
#include "techniques/subsurface/Splatting.h"
#include "techniques/subsurface/TemporalHistory.h"
#include "techniques/subsurface/Volume.h"
#include "views/Layers.h"

#include <algorithm>

namespace lucent::subsurface {

using graph::TextureId;

namespace {

constexpr std::string_view kMethods[] = {"multires", "splat", "diffusion", "lambert"};
constexpr std::string_view kProfiles[] = {"dipole", "multipole", "burley"};
constexpr std::string_view kGeometries[] = {"planar", "offset"};
constexpr std::string_view kSplats[] = {"bound", "paper"};
constexpr std::string_view kExits[] = {"whole", "paper"};
constexpr std::string_view kBlurEnergies[] = {"kept", "paper"};

// Not a picture but the light at the surface.
bool showsLight(const Inputs& in) { return in.radiosity || in.irradiance; }

// Whether light is summed on layers of objects: lamps without size light what they see, but not by way of
// glass and mirrors.
bool isOnLayers(const scene::Scene& scene) {
    return views::hasEnvironment(scene) || views::hasLargeLamp(scene) ||
           std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
               return object.material.isRefractive() || object.material.isMirror();
           });
}

SubsurfaceShadeBlock shadeBlock(const Inputs& in, const views::DrawnMesh& mesh, float unit,
                                const Settings& settings) {
    const scene::Material& material = mesh.object->material;
    SubsurfaceShadeBlock block{.view = views::viewBlock(in.eye, in.size),
                               .ior = material.translucent().surfaceIor(),
                               .roughness = material.translucent().roughness,
                               .mean = 1,
                               .object = mesh.index,
                               .unit = unit};
    if (settings.exit == Exit::Whole)
        block.mean = float(diffusion::meanTransmittance(material.translucent().surfaceIor()));
    if (in.environment != graph::TextureHandle::None) {
        block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.scene.environment->rotation)));
        block.intensity = in.scene.environment->intensity;
    }
    return block;
}

// Draws objects of which all are painted, or none.
//
// @param paint  what is painted on them where the camera sees them; or none
Status recordShade(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                   const std::vector<views::DrawnMesh>& objects, const Radiosity& leaving,
                   TextureId highlight, TextureId paint, const Settings& settings) {
    if (objects.empty()) return Done{};
    const bool hasSky = in.environment != graph::TextureHandle::None && !showsLight(in);
    std::vector<std::string> defines;
    if (highlight) defines.push_back("USE_LAMPS");
    if (hasSky) defines.push_back("USE_SKY");
    if (showsLight(in)) defines.push_back("SHOW_RADIOSITY");
    if (paint) defines.push_back("PAINTED");
    const gl::Program* program = context.program("subsurface/shade", defines);
    std::vector<graph::Block> blocks;
    for (const views::DrawnMesh& mesh : objects)
        blocks.push_back(shadeBlock(in, mesh, leaving.unit, settings));
    const TextureId radiosity = leaving.light, matt = paint ? in.matt : TextureId{};
    graph.addPass("subsurface.shade", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(std::to_string(objects.size()) + (paint ? " painted" : "") +
                    " object(s) in which light scatters" +
                    (hasSky ? "; they mirror the environment past everything" : ""));
        pass.sample(in.surface);
        pass.sample(radiosity);
        if (highlight) pass.sample(highlight);
        if (paint) pass.sample(paint);
        if (matt) pass.sample(matt);
        pass.write(in.target);
        return [=, surface = in.surface, environment = in.environment](const graph::Resources& resources,
                                                                       graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uRadiosity", resources[radiosity]}};
            if (highlight) textures.push_back({"uHighlight", resources[highlight]});
            if (hasSky) textures.push_back({"uEnvironment", environment});
            if (paint) textures.push_back({"uPaint", resources[paint]});
            if (matt) textures.push_back({"uMatt", resources[matt]});
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

// Shows what is painted on objects in place of their light.
Status recordLayer(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                   const std::vector<views::DrawnMesh>& painted, PaintLayer layer) {
    const bool entering = layer == PaintLayer::Blur || layer == PaintLayer::Glow;
    Result<TextureId> map = entering ? views::recordEnteringMap(graph, context, in.eye, painted, in.size)
                                     : views::recordLeaving(graph, context, in.eye, painted, in.size);
    if (!map) return map.error();
    const gl::Program* program = context.program("subsurface/layer");
    std::vector<graph::Block> blocks;
    for (const views::DrawnMesh& mesh : painted)
        blocks.push_back(PaintLayerBlock{.object = mesh.index, .layer = int(layer)});
    graph.addPass("subsurface.layer", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what is painted on " + std::to_string(painted.size()) +
                    " object(s), in place of their light");
        pass.sample(in.surface);
        pass.sample(*map);
        pass.write(in.target);
        return [blocks, surface = in.surface, paint = *map, program](const graph::Resources& resources,
                                                                     graph::Commands& commands) {
            for (const graph::Block& block : blocks)
                commands.draw({.program = program,
                               .block = block,
                               .textures = {{"uSurface", resources[surface]}, {"uPaint", resources[paint]}}});
        };
    });
    return Done{};
}

// --- plan

// Over a light's view of an object that is not turned; by steps of a fifth, so that tables stay while it
// turns.
double widerTurned(const scene::Object& object) {
    const float wider = views::boundsOf(object).radius() / views::boundsOf(unmoved(object)).radius();
    return std::exp2(std::ceil(4 * std::log2(double(wider)) - 0.01) / 4);
}

Wanted wantedOf(const views::DrawnMesh& mesh, const Settings& settings) {
    const scene::Object& object = *mesh.object;
    Wanted wanted{.media = diffusion::mediaOf(object.material), .wish = {}};
    KernelWish& wish = wanted.wish;
    wish.shape = settings.profile;
    wish.thickness = object.material.translucent().thickness;
    wish.epsilon = settings.epsilon;
    wish.size = 2 * views::boundsOf(unmoved(object)).radius();
    // In octaves, so that tables stay while someone paints.
    if (mesh.paint) wish.sharpest = std::exp2(std::max(0.0f, std::ceil(std::log2(mesh.paint->sharpest))));
    const bool bound = settings.splats == Splats::Bound;
    if (!bound) wanted.paper = settings.mostSplats;
    wanted.width = wish.size * widerTurned(object);
    wish.leastSpacing = bound ? wanted.width / (kTilt * settings.mostSplats) : 0;
    wish.split = bound && settings.method == Method::Multires;
    const bool layered = settings.profile == diffusion::Shape::Multipole && wanted.media[0].isLayered();
    wish.shares = settings.dipoleGeometry == DipoleGeometry::Offset &&
                  settings.profile != diffusion::Shape::Burley && !layered; // layers have no poles
    return wanted;
}

// The dissertation's number of splats, as many of them as there may be.
void usePapersSplats(Kernel& kernel, const Wanted& wanted, const std::string& name) {
    const double wish = papersSplats(wanted.media, wanted.wish, wanted.width);
    const double splats = std::min(wish, double(*wanted.paper));
    if (splats < wish)
        warnOnce("subsurface: eq. 6.17 and 6.18 ask for " + std::to_string(std::llround(wish)) +
                 " splats a side of object \"" + name + "\"; " + std::to_string(*wanted.paper) +
                 " are drawn");
    kernel.bands.front().spacing = wanted.width / splats;
}

std::shared_ptr<const Profiled> profileOf(gl::Context& context, const Wanted& wanted,
                                          const std::string& name) {
    auto profiled = std::make_shared<Profiled>();
    profiled->of = wanted;
    profiled->kernel = kernelOf(wanted.media, wanted.wish);
    if (wanted.paper) usePapersSplats(profiled->kernel, wanted, name);
    constexpr double kPoleError = 1e-4; // of the profile's largest value: 24 poles at most
    if (wanted.wish.shares && profiled->kernel.blur == 0)
        for (std::size_t c = 0; c < 3; ++c)
            profiled->poles[c] = diffusion::polesOf(
                wanted.media[c], wanted.wish.shape == diffusion::Shape::Multipole ? wanted.wish.thickness : 0,
                kPoleError);
    for (const Band& band : profiled->kernel.bands) {
        const graph::TextureDesc desc{.size = {int(band.table.size()), 1}, .format = graph::Format::RGBA32F};
        profiled->tables.emplace_back(context.device(), desc, "subsurface.table");
        context.device().upload(profiled->tables.back().handle(), 0, band.table);
    }
    return profiled;
}

// Says how light is blurred that reaches less far than points lie apart.
void warnOfBlur(const Profiled& profile, const std::string& name) {
    if (profile.kernel.blur > 0)
        warnOnce("subsurface: object \"" + name + "\" is " + std::to_string(profile.of.wish.size) +
                 " m wide and its light reaches less far than mostSplats can tell apart; it is blurred by " +
                 std::to_string(profile.kernel.blur) + " m");
}

// Says what of M_d is not drawn.
void warnOfPaint(const views::DrawnMesh& mesh, const Grid& grid, const Settings& settings) {
    const views::Paint& paint = *mesh.paint;
    const std::string object = "subsurface: object \"" + mesh.object->name + "\" is painted with ";
    if (settings.method == Method::Diffusion) {
        if (paint.isBlurred()) warnOnce(object + "blur, which method diffusion does not draw");
    } else if (paint.sharpest > grid.sharpness.most) {
        warnOnce(object + "less blur than mostSplats can tell apart; M_d counts as " +
                 std::to_string(grid.sharpness.most) + " at most");
    }
}

} // namespace

const ParamTable& Subsurface::params() {
    static const Param list[] = {
        declare(&Settings::method,
                {.id = "method",
                 .label = "Method",
                 .group = Group::Subsurface,
                 .doc =
                     "How light is summed: near and far light apart, far light with few points and on few "
                     "pixels; every splat on every pixel, as in the dissertation; by solving diffusion "
                     "in cells of the body itself, which is right behind bodies and in thin parts too; or, "
                     "for comparison, lambert: as if light left where it entered.",
                 .choices = kMethods}),
        declare(
            &Settings::profile,
            {.id = "profile",
             .label = "Profile",
             .group = Group::Subsurface,
             .doc =
                 "How light that entered at one place fades around it: by a dipole; by a multipole, for "
                 "slabs of the material's thickness and for its layers; or by Burley's normalised diffusion.",
             .choices = kProfiles}),
        declare(&Settings::dipoleGeometry,
                {.id = "dipoleGeometry",
                 .label = "Dipole geometry",
                 .group = Group::Subsurface,
                 .doc =
                     "Where the sources of dipole and multipole stand on a curved surface: planar, by the "
                     "distance alone; offset, along the normal where light entered, which leaves less light "
                     "behind a body.",
                 .choices = kGeometries}),
        declare(
            &Settings::epsilon,
            {.id = "epsilon",
             .label = "Error",
             .min = 1e-4,
             .max = 0.5,
             .low = 1e-3,
             .high = 0.1,
             .logarithmic = true,
             .group = Group::Subsurface,
             .doc =
                 "How far the light that leaves may be from the integral that the sum of splats stands for: "
                 "it decides how far splats reach and how many there are. Smaller is smoother and slower."}),
        declare(&Settings::splats,
                {.id = "splats",
                 .label = "Number of splats",
                 .group = Group::Subsurface,
                 .doc =
                     "By the bound on what a lattice of points misses; or by the dissertation's eq. 6.17 and "
                     "6.18, which ask for many more.",
                 .choices = kSplats}),
        declare(&Settings::mostSplats,
                {.id = "mostSplats",
                 .label = "Most splats",
                 .min = 16,
                 .max = 1024,
                 .low = 32,
                 .high = 512,
                 .logarithmic = true,
                 .group = Group::Subsurface,
                 .doc = "Along a side of a light's view. Where more were needed light is "
                        "blurred until these suffice."}),
        declare(&Settings::exit,
                {.id = "exit",
                 .label = "Fresnel on exit",
                 .group = Group::Subsurface,
                 .doc = "Whole: what arrives below the surface leaves it; paper: the surface keeps its mean "
                        "reflection a second time, as in the dissertation's eq. 6.13.",
                 .choices = kExits}),
        declare(&Settings::blurEnergy,
                {.id = "blurEnergy",
                 .label = "Energy of painted blur",
                 .group = Group::Light,
                 .doc =
                     "Kept: as much leaves however far it spreads; paper: as the dissertation's eq. 7.4 has "
                     "it, where twice the spread is four times the light.",
                 .choices = kBlurEnergies}),
        declare(
            &Settings::cells,
            {.id = "cells",
             .label = "Cells",
             .min = 8,
             .max = 128,
             .low = 16,
             .high = 96,
             .group = Group::Subsurface,
             .doc =
                 "Along the longest side of a body, of method diffusion: details of light finer than a cell "
                 "are lost, and thinner parts shine alike on both sides."}),
        declare(&Settings::temporal,
                {.id = "temporal",
                 .label = "Temporal history",
                 .group = Group::Subsurface,
                 .doc = "Mixes what leaves with what left there in the picture before, so that few splats "
                        "flicker less where things turn. It changes no single picture, and none that is "
                        "drawn again as it was."}),
    };
    static const ParamTable table = tableOf<Settings>("subsurface", list, "Subsurface scattering");
    return table;
}

bool scatters(const scene::Object& object) {
    return object.visible && !object.isField() && object.material.isScattering() &&
           !scene::isPrecomputed(object);
}

bool acts(const Settings& settings, std::string_view id) {
    const bool sums = settings.method == Method::Multires || settings.method == Method::Splat;
    return id != "temporal" || sums;
}

std::optional<std::string> Subsurface::need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects)
        if (scatters(object)) return "light scatters inside object \"" + object.name + "\"";
    return std::nullopt;
}

Plan::Plan() : state_(std::make_unique<State>()) {}
Plan::Plan(Plan&&) noexcept = default;
Plan& Plan::operator=(Plan&&) noexcept = default;
Plan::~Plan() = default;

Result<Plan> Subsurface::plan(views::Readings& readings, graph::TexturePool& pool, const scene::Scene& scene,
                              const std::vector<views::DrawnMesh>& meshes, const Settings& settings,
                              bool isPreview) {
    Plan plan;
    plan.state_->onLayers = isOnLayers(scene);
    std::vector<std::shared_ptr<const Profiled>> used;
    for (const views::DrawnMesh& mesh : meshes) {
        if (settings.method == Method::Lambert) continue;
        Plan::State::Object object{.index = mesh.index, .profile = nullptr, .layers = {}};
        const Wanted wanted = wantedOf(mesh, settings);
        const auto known = std::find_if(profiles_.begin(), profiles_.end(),
                                        [&](const auto& profile) { return profile->of == wanted; });
        object.profile = known != profiles_.end() ? *known : profileOf(context_, wanted, mesh.object->name);
        if (known == profiles_.end()) profiles_.push_back(object.profile);
        used.push_back(object.profile);
        const Layout layout = layoutOf(*object.profile, mesh, settings, context_.caps().maxTextureSize);
        if (!isPreview) warnOfBlur(*object.profile, mesh.object->name);
        if (!isPreview && mesh.paint) warnOfPaint(mesh, layout.grid, settings);
        // Cells lie along the world's axes, points along the object's own.
        const bool inCells = settings.method == Method::Diffusion;
        if (inCells || plan.state_->onLayers) {
            const Cells cells = cellsOf(views::boundsOf(*mesh.object), settings.cells);
            const Grid along = layout.alongAxes().grid;
            object.axes = inCells ? axesOf(cells) : axesOf(*mesh.object, along.most);
            for (std::size_t axis = 0; axis < 3; ++axis)
                object.sizes[axis] = inCells ? pixelsOf(object.axes[axis], *mesh.object, cells, context_)
                                             : pixelsOf(object.axes[axis], *mesh.object, along);
            const Result<std::array<int, 3>> layers =
                countLayers(readings, pool, mesh, scene.view.time, object.axes, object.sizes, !inCells);
            if (!layers) return layers.error();
            object.layers = *layers;
        }
        plan.state_->objects.push_back(std::move(object));
    }
    profiles_ = std::move(used); // of the last scene only
    if (settings.method != Method::Diffusion)
        volumes_.reset();
    else if (!volumes_)
        volumes_ = std::make_shared<Volumes>();
    if (!settings.temporal || !acts(settings, "temporal"))
        history_.reset();
    else if (!history_)
        history_ = std::make_shared<TemporalHistory>();
    return plan;
}

// @param turns  the axes turn with the object
Result<std::array<int, 3>> Subsurface::countLayers(views::Readings& readings, graph::TexturePool& pool,
                                                   const views::DrawnMesh& mesh, float time,
                                                   const std::array<views::Eye, 3>& axes,
                                                   const std::array<ivec2, 3>& sizes, bool turns) {
    Counted now{.key = views::objectKey(turns ? unmoved(*mesh.object) : *mesh.object, time),
                .sizes = sizes,
                .layers = {}};
    Counted& known = counted_[mesh.index];
    if (!mesh.water && known.key == now.key && known.sizes == now.sizes) return known.layers;
    const views::Drawables alone{std::make_shared<views::DrawnMesh>(mesh)};
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const std::string question =
            "subsurface, object " + std::to_string(mesh.index) + " axis " + std::to_string(i);
        const Result<int> count =
            views::countLayers(readings, question, pool, context_, axes[i], alone, time, now.sizes[i]);
        if (!count) return count.error();
        now.layers[i] = *count;
    }
    if (readings.areThere()) known = now;
    return now.layers;
}

void Subsurface::clear() {
    entering_.reset();
    counted_.clear();
    profiles_.clear();
    volumes_.reset();
    history_.reset();
}

Status Subsurface::light(graph::FrameGraph& graph, const Arriving& in, const Plan& plan,
                         const Settings& settings) {
    if (!entering_) entering_ = std::make_shared<Entering>();
    return entering_->add(graph, context_, in, *plan.state_, settings);
}

void Subsurface::forgetRecorded() {
    if (entering_) entering_->forget();
}

Status Subsurface::record(graph::FrameGraph& graph, const Inputs& in, const Plan& plan,
                          const Settings& settings) const {
    std::vector<views::DrawnMesh> objects = in.solids;
    const PaintLayer layer = in.scene.view.paintLayer;
    if (layer != PaintLayer::None && !showsLight(in)) {
        const auto rest = std::stable_partition(objects.begin(), objects.end(),
                                                [](const views::DrawnMesh& mesh) { return !mesh.paint; });
        const std::vector<views::DrawnMesh> painted(rest, objects.end());
        objects.erase(rest, objects.end());
        if (!painted.empty())
            if (Status s = recordLayer(graph, context_, in, painted, layer); !s) return s;
    }
    if (objects.empty() || !entering_) return Done{};
    const Entered* seen = entering_->seen();
    const auto import = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    Result<Radiosity> radiosity =
        in.irradiance || settings.method == Method::Lambert ? Radiosity{import(seen->light[seen->now]), 1}
        : settings.method == Method::Diffusion
            ? recordVolumes(graph, context_, in, *plan.state_, *entering_, settings, *volumes_)
            : recordRadiosity(graph, context_, in, *plan.state_, *entering_, settings);
    if (radiosity && history_ && radiosity->places)
        radiosity = recordSteady(graph, context_, in, *plan.state_, *radiosity, settings, history_);
    if (!radiosity) return radiosity.error();
    TextureId highlight;
    if (seen && !showsLight(in)) highlight = import(seen->other[seen->now]);
    std::vector<views::DrawnMesh> plain, painted;
    for (const views::DrawnMesh& mesh : objects)
        (mesh.paint && !in.irradiance ? painted : plain).push_back(mesh);
    if (Status s = recordShade(graph, context_, in, plain, *radiosity, highlight, {}, settings); !s) return s;
    if (painted.empty()) return Done{};
    Result<TextureId> paint = views::recordLeaving(graph, context_, in.eye, painted, in.size);
    if (!paint) return paint.error();
    return recordShade(graph, context_, in, painted, *radiosity, highlight, *paint, settings);
}

} // namespace lucent::subsurface
