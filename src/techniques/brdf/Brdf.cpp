#include "techniques/brdf/Brdf.h"

#include "shaders/brdf/Blocks.h"

namespace lucent::brdf {

namespace {

// Of the objects [first, first + kMostMatter) of the scene.
MattBlock mattBlock(const Inputs& in, int first) {
    MattBlock block{.view = views::viewBlock(in.eye, in.size)};
    block.first = first;
    block.firstLight = in.first;
    block.endLight = in.end;
    block.columns = in.occlusion.columns;
    for (const views::PosedMesh& solid : in.solids) {
        const int place = solid.drawn.index - first;
        if (place < 0 || place >= kMostMatter) continue;
        const scene::Material& material = solid.drawn.object->material;
        block.matter[std::size_t(place)] = {vec4(material.base, 0), vec4(material.diffuse, 1)};
    }
    return block;
}

MirrorBlock mirrorBlock(const MirrorInputs& in, const views::PosedMesh& mesh) {
    MirrorBlock block{.view = views::viewBlock(in.eye, in.size),
                      .reflectance = vec4(mesh.drawn.object->material.reflectance, 0),
                      .object = mesh.drawn.index};
    if (in.environment == graph::TextureHandle::None) return block;
    block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.scene.environment->rotation)));
    block.intensity = in.scene.environment->intensity;
    return block;
}

} // namespace

std::optional<std::string> Brdf::need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects) {
        if (!object.visible || object.isField() || object.material.isRefractive()) continue;
        if (object.material.isScattering() && !views::isPainted(object)) continue;
        return "object \"" + object.name + "\" is " +
               (object.material.isMirror()       ? "a mirror"
                : object.material.isScattering() ? "painted, and matt where it is not translucent"
                                                 : "an opaque surface");
    }
    return std::nullopt;
}

Status Brdf::record(graph::FrameGraph& graph, const Inputs& in) const {
    if (in.solids.empty()) return Done{};
    const graph::TextureId surface = in.surface, table = in.lightTable, target = in.target;
    const graph::TextureId occlusion = in.occlusion.texture;
    const graph::TextureId flux = in.first == 0 ? in.flux : graph::TextureId{};
    const graph::TextureId sum = in.first > 0 ? in.sum : graph::TextureId{};
    std::vector<std::string> defines;
    if (occlusion) defines.push_back("USE_OCCLUSION");
    if (flux) defines.push_back("USE_FLUX");
    if (in.show == scene::Aov::Irradiance) defines.push_back("SHOW_IRRADIANCE");
    const gl::Program* program = context_.program("brdf/light", defines);
    std::vector<graph::Block> blocks;
    for (int first = 0; first < int(in.scene.objects.size()); first += kMostMatter)
        blocks.push_back(mattBlock(in, first));
    graph.addPass("brdf.light", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light samples " + std::to_string(in.first) + " to " + std::to_string(in.end - 1) +
                    " on " + std::to_string(in.solids.size()) + " matt object(s)");
        pass.sample(surface);
        pass.sample(table);
        for (const graph::TextureId id : {occlusion, flux, sum})
            if (id) pass.sample(id);
        pass.write(target);
        if (in.clears) pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uLights", resources[table]}};
            if (occlusion) textures.push_back({"uOcclusion", resources[occlusion]});
            if (flux) textures.push_back({"uFlux", resources[flux]});
            if (sum) textures.push_back({"uSum", resources[sum]});
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

Status Brdf::recordMirrors(graph::FrameGraph& graph, const MirrorInputs& in) const {
    if (in.mirrors.empty()) return Done{};
    const bool hasSky = in.environment != graph::TextureHandle::None;
    const gl::Program* program = context_.program("brdf/mirror", hasSky ? std::vector<std::string>{"USE_SKY"}
                                                                        : std::vector<std::string>{});
    std::vector<graph::Block> blocks;
    for (const views::PosedMesh& mesh : in.mirrors)
        blocks.push_back(mirrorBlock(in, mesh));
    graph.addPass("brdf.mirror", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(std::to_string(in.mirrors.size()) + " mirror(s); they show the environment only");
        pass.sample(in.surface);
        pass.write(in.target);
        return [=, surface = in.surface, environment = in.environment](const graph::Resources& resources,
                                                                       graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]}};
            if (hasSky) textures.push_back({"uEnvironment", environment});
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

} // namespace lucent::brdf
