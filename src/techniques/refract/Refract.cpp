#include "techniques/refract/Refract.h"

#include "base/Log.h"
#include "shaders/refract/Blocks.h"
#include "views/Glass.h"

#include <algorithm>

namespace lucent::refract {

namespace {

constexpr std::string_view kLayers[] = {"peel", "voxels", "front-back"};
constexpr std::string_view kSlices[] = {"256", "512"};
constexpr std::string_view kBounds[] = {"local", "global"};
constexpr std::string_view kPeelings[] = {"pass", "on-the-fly"};
constexpr std::string_view kTraces[] = {"pyramid", "bisection"};
constexpr std::string_view kNormals[] = {"stored", "neighbours", "delta1", "delta2"};
constexpr std::string_view kPathLengths[] = {"geometric", "optical"};

bool holds(const views::Bounds& bounds, vec3 place) {
    return glm::all(glm::greaterThanEqual(place, bounds.low)) &&
           glm::all(glm::lessThanEqual(place, bounds.high));
}

RefractBlock blockOf(const Inputs& in, ivec2 size) {
    RefractBlock block;
    block.view = views::viewBlock(in.eye, size);
    block.around = views::aroundBlock(in.surroundings);
    block.count = in.layers.count;
    if (in.light) {
        block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.light->rotation)));
        block.hasEnvironment = 1;
        block.intensity = in.light->intensity;
    }
    for (std::size_t i = 0; i < in.glass.size(); ++i) {
        const scene::Object& object = *in.glass[i]->object;
        block.glass[i] = views::glassBlock(object.material);
        if (in.eye.perspective && holds(views::boundsOf(object), in.eye.position)) block.atEye |= 1 << i;
    }
    const views::Bounds all = views::boundsOfAll(in.glass);
    block.low = vec4(all.low - in.eye.position, 0);
    block.high = vec4(all.high - in.eye.position, 0);
    return block;
}

bool looksAround(const Inputs& in, const Settings& settings) {
    return in.surroundings && in.surroundings->hasCubes() && in.show == scene::Aov::Color &&
           settings.surroundings == views::Around::Surroundings && settings.trace == Trace::Pyramid;
}

// What bisection leaves out of this picture.
void warnOfLimits(const Inputs& in, const Settings& settings) {
    if (in.opaque)
        warnOnce("refract: trace bisection sees no opaque objects through glass, only the environment");
    const auto& glass = in.glass;
    if (settings.layers != LayerMethod::Peel && std::any_of(glass.begin(), glass.end(), [&](const auto& one) {
            return one->object->material.clear() != glass[0]->object->material.clear();
        }))
        warnOnce("refract: layers " + std::string(kLayers[int(settings.layers)]) +
                 " tell objects not apart; light goes on in the one that it hits first");
}

// What is shown, of rays through glass or beside it.
std::vector<std::string> shownDefines(const Inputs& in) {
    std::vector<std::string> defines;
    if (in.show == scene::Aov::Direction) defines.push_back("SHOW_DIRECTION");
    if (in.show == scene::Aov::Layers) defines.push_back("SHOW_LAYERS");
    if (in.show == scene::Aov::Lost) defines.push_back("SHOW_LOST");
    defines.push_back(in.opaque ? "USE_SOLID" : "USE_BOX");
    return defines;
}

std::vector<std::string> definesOf(const Inputs& in, const Settings& settings) {
    std::vector<std::string> defines = shownDefines(in);
    const bool showsLight = defines.size() == 1; // by no switch
    if (showsLight && views::disperses(in.glass)) defines.push_back("USE_DISPERSION");
    const bool isExact = showsLight && settings.trace == Trace::Pyramid;
    if (isExact && settings.surroundings == views::Around::Environment) defines.push_back("ENVIRONMENT_ONLY");
    if (looksAround(in, settings)) defines.push_back("USE_AROUND");
    if (settings.pathLength == PathLength::Optical) defines.push_back("USE_OPTICAL_LENGTH");
    return defines;
}

const char* normalsDefine(Normals normals) {
    constexpr const char* kNames[] = {"NORMALS_STORED", "NORMALS_NEIGHBOURS", "NORMALS_DELTA 1",
                                      "NORMALS_DELTA 2"};
    return kNames[int(normals)];
}

} // namespace

Status check(const Settings& settings) {
    const std::string place = "technique.refract.";
    const bool isPeeled = settings.layers == LayerMethod::Peel;
    const std::string layers = "layers " + std::string(kLayers[int(settings.layers)]);
    if (!isPeeled && settings.trace == Trace::Pyramid)
        return Error{place + "trace is pyramid with " + layers +
                     ", which know neither objects nor sides; must be bisection"};
    if (!isPeeled && settings.normals == Normals::Stored)
        return Error{place + "normals is stored with " + layers +
                     ", which store none; must be neighbours, delta1 or delta2"};
    if (settings.trace == Trace::Pyramid && settings.normals != Normals::Stored)
        return Error{place + "normals is " + std::string(kNormals[int(settings.normals)]) +
                     " with trace pyramid; must be stored"};
    return Done{};
}

bool acts(const Settings& settings, std::string_view id) {
    if (id == "slices" || id == "bounds" || id == "peeling") return settings.layers == LayerMethod::Voxels;
    if (id == "normals") return settings.trace == Trace::Bisection;
    if (id == "maxLayers") return settings.layers != LayerMethod::FrontBack;
    return true;
}

views::VoxelSettings voxelSettings(const Settings& settings) {
    return {.slices = settings.slices == Slices::Few ? 256 : 512,
            .local = settings.bounds == Extent::Local,
            .onTheFly = settings.peeling == Peeling::OnTheFly};
}

const ParamTable& Refract::params() {
    static const Param list[] = {
        declare(&Settings::layers,
                {.id = "layers",
                 .label = "Layer method",
                 .group = Group::Refraction,
                 .doc = "How surfaces behind each other are found: peeled one after the other, with their "
                        "normals; as the thesis has it, by slices of depth that two passes fill, which "
                        "tells no objects apart; or only the first and the last one.",
                 .choices = kLayers}),
        declare(
            &Settings::maxLayers,
            {.id = "maxLayers",
             .label = "Layers",
             .min = 1,
             .max = views::kMostLayers,
             .low = 1,
             .high = views::kMostLayers,
             .group = Group::Refraction,
             .doc =
                 "How many surfaces of clear things behind each other are drawn, at most. As many as there "
                 "are suffice; 2 is the cheap end, a way in and a way out."}),
        declare(&Settings::slices, {.id = "slices",
                                    .label = "Slices",
                                    .group = Group::Refraction,
                                    .doc = "Of voxels: into how many slices depth is cut.",
                                    .choices = kSlices}),
        declare(&Settings::bounds,
                {.id = "bounds",
                 .label = "Slice bounds",
                 .group = Group::Refraction,
                 .doc = "Of voxels: a pixel's own first and last surface, or those of all.",
                 .choices = kBounds}),
        declare(&Settings::peeling,
                {.id = "peeling",
                 .label = "Slice peeling",
                 .group = Group::Refraction,
                 .doc = "Of voxels: once, in a pass of their own, or at every step of a ray.",
                 .choices = kPeelings}),
        declare(&Settings::trace,
                {.id = "trace",
                 .label = "Ray tracing",
                 .group = Group::Refraction,
                 .doc = "How rays are intersected with surfaces: by pyramids of depths that skip what is "
                        "empty, exactly; or "
                        "by the thesis's five halvings a layer, which follow no total reflection and see no "
                        "opaque objects.",
                 .choices = kTraces}),
        declare(&Settings::normals,
                {.id = "normals",
                 .label = "Normals",
                 .group = Group::Refraction,
                 .doc = "Of bisection: those of the surfaces, which only peeled layers hold; from the depths "
                        "of the pixels around; or from those one or two pixels away.",
                 .choices = kNormals}),
        declare(&Settings::pathLength,
                {.id = "pathLength",
                 .label = "Absorption length",
                 .group = Group::Refraction,
                 .doc = "Along which length light is absorbed: the way itself, or, as the thesis has it, "
                        "that times the index of refraction.",
                 .choices = kPathLengths}),
        declare(&Settings::surroundings, views::aroundText()),
    };
    static const ParamTable table = tableOf<Settings>("refract", list, "Layers and ray tracing");
    return table;
}

std::optional<std::string> Refract::need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects)
        if (object.visible && !object.isField() && object.material.isRefractive())
            return "object \"" + object.name + "\" lets light through";
    return std::nullopt;
}

// The depths that bisection goes by.
Result<views::DepthLayers> Refract::depthsOf(graph::FrameGraph& graph, const Inputs& in, ivec2 size,
                                             const Settings& settings) const {
    switch (settings.layers) {
    case LayerMethod::Voxels:
        return views::recordVoxels(graph, context_, in.eye, in.glass, size,
                                   std::min(in.count, settings.maxLayers), voxelSettings(settings));
    case LayerMethod::FrontBack:
        return views::recordFrontBack(graph, context_, in.eye, in.glass, size);
    case LayerMethod::Peel:
        break;
    }
    return views::recordDepths(graph, context_, in.eye, in.glass, size, in.layers);
}

Status Refract::record(graph::FrameGraph& graph, const Inputs& in, ivec2 size,
                       const Settings& settings) const {
    if (Status s = check(settings); !s) return s;
    if (in.glass.size() > views::kMostGlass)
        return Error{"refract: " + std::to_string(in.glass.size()) + " refractive objects; must be at most " +
                         std::to_string(views::kMostGlass),
                     Fault::Machine};
    RefractBlock block = blockOf(in, size);
    std::vector<std::string> defines = definesOf(in, settings);
    views::DepthLayers depths;
    const bool bisects = settings.trace == Trace::Bisection;
    if (bisects) {
        warnOfLimits(in, settings);
        Result<views::DepthLayers> found = depthsOf(graph, in, size, settings);
        if (!found) return found.error();
        depths = *found;
        block.depths = depths.bounds;
        block.depthCount = depths.count;
        defines.push_back("USE_BISECTION");
        defines.push_back(normalsDefine(settings.normals));
        for (std::string& define : views::depthDefines(depths))
            defines.push_back(std::move(define));
    }
    const gl::Program* program = context_.program("refract/refract", defines);
    std::vector<std::string> besideDefines = shownDefines(in);
    besideDefines.push_back("BESIDE");
    const gl::Program* beside = context_.program("refract/refract", besideDefines);
    const views::Layers layers = in.layers;
    const graph::TextureId opaque = in.opaque, solid = in.solid, target = in.target;
    const bool counts = bisects && in.show == scene::Aov::Layers; // and looks at nothing else
    std::vector<graph::Binding> around;
    if (looksAround(in, settings))
        around = {{"uAround", in.surroundings->radiance}, {"uAroundSolid", in.surroundings->solid}};
    // Rays are followed where there is glass only: the depth test knows before a pixel is begun.
    const bool parts = layers.depth && in.show != scene::Aov::Layers;
    graph.addPass("refract.trace", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("rays of the eye through " + std::to_string(bisects ? depths.count : layers.count) +
                    " surfaces of " + std::to_string(in.glass.size()) + " refractive object(s)");
        if (bisects) views::sampleDepths(pass, depths);
        if (bisects && !counts) {
            pass.sample(depths.deepest);
            pass.sample(layers.images);
            views::sampleTriangles(pass, layers.triangles);
        }
        if (!bisects) views::sampleLayers(pass, layers);
        if (opaque && !counts) {
            pass.sample(opaque);
            pass.sample(solid);
        }
        pass.write(target);
        if (parts) pass.write(layers.depth);
        return
            [=, environment = in.environment](const graph::Resources& resources, graph::Commands& commands) {
                std::vector<graph::Binding> textures;
                if (bisects) textures = views::depthBindings(resources, depths);
                if (bisects && !counts) {
                    for (const graph::Binding& binding : views::triangleBindings(resources, layers.triangles))
                        textures.push_back(binding);
                    textures.push_back({"uDeepest", resources[depths.deepest]});
                    textures.push_back({"uLayers", resources[layers.images]});
                }
                if (!bisects) textures = views::layerBindings(resources, layers);
                if (environment != graph::TextureHandle::None)
                    textures.push_back({"uEnvironment", environment});
                textures.insert(textures.end(), around.begin(), around.end());
                if (opaque && !counts) {
                    textures.push_back({"uShown", resources[opaque]});
                    textures.push_back({"uSolid", resources[solid]});
                }
                graph::Draw draw{.program = program, .block = block, .textures = std::move(textures)};
                if (!parts) return commands.draw(draw);
                draw.depthWrite = false;
                draw.depthTest = graph::DepthTest::Greater;
                commands.draw(draw);
                draw.program = beside;
                draw.depthTest = graph::DepthTest::LessEqual;
                commands.draw(draw);
            };
    });
    return Done{};
}

} // namespace lucent::refract
