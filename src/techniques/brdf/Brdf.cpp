#include "techniques/brdf/Brdf.h"

#include "shaders/brdf/Blocks.h"
#include "views/Paint.h"

namespace lucent::brdf {

namespace {

// Of the objects [first, first + kMostMatter) of the scene.
MattBlock mattBlock(const Inputs& in, int first) {
    MattBlock block{.view = views::viewBlock(in.eye, in.size)};
    block.first = first;
    block.firstLight = in.first;
    block.endLight = in.end;
    block.columns = in.occlusion.columns;
    for (const auto& solid : in.solids) {
        const int place = solid->index - first;
        if (place < 0 || place >= kMostMatter) continue;
        const scene::Material& material = solid->object->material;
        const float matt = material.isRelief() ? 1 - material.relief().specularity : 1;
        block.matter[std::size_t(place)] = {vec4(matt * material.base, 0), vec4(matt * material.diffuse, 1)};
    }
    return block;
}

MirrorBlock mirrorBlock(const MirrorInputs& in, const views::Drawable& mirror) {
    MirrorBlock block{.view = views::viewBlock(in.eye, in.size),
                      .around = views::aroundBlock(in.surroundings),
                      .reflectance = vec4(mirror.object->material.mirror().reflectance, 0),
                      .object = mirror.index,
                      .cube = -1};
    if (in.surroundings) {
        const auto& cubes = in.surroundings->cubes;
        for (std::size_t i = 0; i < cubes.size(); ++i)
            if (cubes[i].object == block.object) block.cube = int(i);
        const auto& flat = in.surroundings->flat;
        for (std::size_t i = 0; i < flat.size(); ++i)
            if (flat[i].object == block.object)
                block.flats[std::size_t(block.flatCount++)] = vec4(flat[i].normal, i);
    }
    if (in.environment == graph::TextureHandle::None) return block;
    block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.scene.environment->rotation)));
    block.intensity = in.scene.environment->intensity;
    return block;
}

// What of the surroundings mirrors show, for people.
std::string shownIn(const MirrorInputs& in) {
    if (in.solid) return "they show what the camera sees";
    if (in.surroundings && (in.surroundings->hasCubes() || !in.surroundings->flat.empty()))
        return "they show what is around";
    return "they show the environment";
}

// A copy: the target cannot be read.
graph::TextureId recordCopy(graph::FrameGraph& graph, gl::Context& context, graph::TextureId from,
                            ivec2 size) {
    const gl::Program* program = context.program("views/around");
    graph::TextureId copy;
    graph.addPass("brdf.seen", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what the camera sees, to be seen in mirrors");
        pass.sample(from);
        copy = pass.createColor("brdf.seen", {.size = size, .format = graph::Format::RGBA32F});
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .textures = {{"uPicture", resources[from]}}});
        };
    });
    return copy;
}

} // namespace

bool Brdf::shades(const scene::Object& object) {
    return !object.isField() && !object.material.isRefractive() &&
           (!object.material.isScattering() || views::isPainted(object));
}

std::optional<std::string> Brdf::need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects) {
        if (!object.visible || !shades(object)) continue;
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

const ParamTable& params() {
    static const Param list[] = {declare(&Settings::surroundings, views::aroundText())};
    static const ParamTable table = tableOf<Settings>("brdf", list, "Mirrors");
    return table;
}

Status Brdf::recordMirrors(graph::FrameGraph& graph, const MirrorInputs& in) const {
    if (in.mirrors.empty()) return Done{};
    const bool hasSky = in.environment != graph::TextureHandle::None;
    const bool isAround = in.surroundings && !in.solid;
    const bool hasCubes = isAround && in.surroundings->hasCubes();
    const bool hasFlat = isAround && !in.surroundings->flat.empty();
    std::vector<std::string> defines;
    if (hasSky) defines.push_back("USE_SKY");
    if (hasCubes) defines.push_back("USE_AROUND");
    if (hasFlat) defines.push_back("USE_FLAT");
    if (in.solid) defines.push_back("USE_VIEW");
    const gl::Program* program = context_.program("brdf/mirror", defines);
    const graph::TextureId seen =
        in.solid ? recordCopy(graph, context_, in.target, in.size) : graph::TextureId{};
    std::vector<graph::Block> blocks;
    for (const auto& mirror : in.mirrors)
        blocks.push_back(mirrorBlock(in, *mirror));
    std::vector<graph::Binding> kept;
    if (hasSky) kept.push_back({"uEnvironment", in.environment});
    if (hasFlat) kept.push_back({"uMirrored", in.surroundings->mirrored});
    if (hasCubes) {
        kept.push_back({"uAround", in.surroundings->radiance});
        kept.push_back({"uAroundSolid", in.surroundings->solid});
    }
    graph.addPass("brdf.mirror", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(std::to_string(in.mirrors.size()) + " mirror(s); " + shownIn(in));
        pass.sample(in.surface);
        if (seen) {
            pass.sample(seen);
            pass.sample(in.solid);
        }
        pass.write(in.target);
        return [=, surface = in.surface, solid = in.solid](const graph::Resources& resources,
                                                           graph::Commands& commands) {
            std::vector<graph::Binding> textures = kept;
            textures.push_back({"uSurface", resources[surface]});
            if (seen) {
                textures.push_back({"uShown", resources[seen]});
                textures.push_back({"uSolid", resources[solid]});
            }
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

} // namespace lucent::brdf
