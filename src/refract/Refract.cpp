#include "refract/Refract.h"

#include "views/Glass.h"

#include <cstddef>

namespace lucent::refract {

namespace {

struct RefractBlock {
    views::ViewBlock view;
    mat4 mapFromWorld{1};
    views::GlassBlock glass[views::kMostGlass + 1];
    int count = 0, hasEnvironment = 0;
    float intensity = 1;
    int around = 0;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(RefractBlock, view));
            const auto glass = views::glassMembers(offsetof(RefractBlock, glass));
            list.insert(list.end(), glass.begin(), glass.end());
            list.insert(list.end(), {{"mapFromWorld", offsetof(RefractBlock, mapFromWorld)},
                                     {"count", offsetof(RefractBlock, count)},
                                     {"hasEnvironment", offsetof(RefractBlock, hasEnvironment)},
                                     {"intensity", offsetof(RefractBlock, intensity)},
                                     {"around", offsetof(RefractBlock, around)}});
            return list;
        }();
        static const graph::BlockLayout layout{"RefractBlock", sizeof(RefractBlock), members};
        return layout;
    }
};

bool holds(const views::Bounds& bounds, vec3 place) {
    return glm::all(glm::greaterThanEqual(place, bounds.low)) &&
           glm::all(glm::lessThanEqual(place, bounds.high));
}

RefractBlock blockOf(const Inputs& in, ivec2 size) {
    RefractBlock block;
    block.view = views::viewBlock(in.eye, size);
    block.count = in.layers.count;
    if (in.light) {
        block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.light->rotation)));
        block.hasEnvironment = 1;
        block.intensity = in.light->intensity;
    }
    for (std::size_t i = 0; i < in.glass.size(); ++i) {
        const scene::Object& object = *in.glass[i].drawn.object;
        block.glass[i] = views::glassBlock(object.material);
        if (in.eye.perspective && holds(views::boundsOf(object), in.eye.position)) block.around |= 1 << i;
    }
    return block;
}

} // namespace

const ParamTable& Refract::params() {
    static const Param list[] = {
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
    };
    static const ParamTable table = tableOf<Settings>("refract", list);
    return table;
}

std::optional<std::string> Refract::need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects)
        if (object.visible && !object.isField() && object.material.isRefractive())
            return "object \"" + object.name + "\" lets light through";
    return std::nullopt;
}

Status Refract::record(graph::FrameGraph& graph, const Inputs& in, ivec2 size) const {
    if (in.glass.size() > views::kMostGlass)
        return Error{"refract: " + std::to_string(in.glass.size()) + " refractive objects; must be at most " +
                         std::to_string(views::kMostGlass),
                     Fault::Machine};
    std::vector<std::string> defines;
    if (in.show == scene::Aov::Direction) defines.push_back("SHOW_DIRECTION");
    if (in.show == scene::Aov::Layers) defines.push_back("SHOW_LAYERS");
    if (views::disperses(in.glass)) defines.push_back("USE_DISPERSION");
    if (in.opaque) defines.push_back("USE_SOLID");
    Result<const gl::Program*> program = context_.program("refract/refract", defines);
    if (!program) return program.error();
    const views::Layers layers = in.layers;
    const graph::TextureId opaque = in.opaque, solid = in.solid, target = in.target;
    graph.addPass("refract.trace", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("rays of the eye through " + std::to_string(layers.count) + " surfaces of " +
                    std::to_string(in.glass.size()) + " refractive object(s)");
        views::sampleLayers(pass, layers);
        if (opaque) {
            pass.sample(opaque);
            pass.sample(solid);
        }
        pass.write(target);
        return [=, program = *program, block = blockOf(in, size),
                environment = in.environment](const graph::Resources& resources, graph::Commands& commands) {
            auto textures = views::layerBindings(resources, layers);
            if (environment != graph::TextureHandle::None) textures.push_back({"uEnvironment", environment});
            if (opaque) {
                textures.push_back({"uOpaque", resources[opaque]});
                textures.push_back({"uSolid", resources[solid]});
            }
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

} // namespace lucent::refract
