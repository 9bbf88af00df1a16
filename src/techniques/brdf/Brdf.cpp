#include "techniques/brdf/Brdf.h"

#include "scene/ReflectanceTable.h"
#include "shaders/brdf/Blocks.h"
#include "techniques/brdf/Reflector.h"
#include "views/Meshes.h"
#include "views/Paint.h"

#include <algorithm>

namespace lucent::brdf {

namespace {

bool isTextured(const views::Drawable& solid) { return solid.textured.has_value(); }

// Of the objects [first, first + kMostMatter) of the scene.
MattBlock mattBlock(const Inputs& in, int first) {
    MattBlock block{.view = views::viewBlock(in.eye, in.size)};
    block.first = first;
    block.firstLight = in.first;
    block.endLight = in.end;
    block.placed = in.placed;
    block.columns = in.occlusion.columns;
    for (const auto& solid : in.solids) {
        const int place = solid->index - first;
        if (place < 0 || place >= kMostMatter) continue;
        const scene::Material& material = solid->object->material;
        const float matt = material.isRelief() ? 1 - material.relief().specularity : 1;
        const ReflectorValues values = reflectorOf(material);
        if (std::holds_alternative<scene::MeasuredBrdf>(material.kind)) continue;
        block.matter[std::size_t(place)] = {vec4(matt * material.base, showsObjects(*solid->object) ? 1 : 0),
                                            vec4(matt * material.diffuse, isTextured(*solid) ? 2 : 1),
                                            values.specular, values.lobe};
    }
    return block;
}

// Of one measured object alone.
MattBlock measuredBlock(const Inputs& in, const views::Drawable& solid) {
    MattBlock block = mattBlock(in, solid.index);
    block.matter = {};
    const scene::Material& material = solid.object->material;
    const auto& measured = std::get<scene::MeasuredBrdf>(material.kind);
    block.matter[0] = {vec4(material.base, 0), vec4(1), vec4(0), vec4(0)};
    block.form = int(measured.form);
    block.blocks = std::max(1, scene::blocksOf(*measured.table, measured.blocks));
    return block;
}

void setSky(auto& block, const auto& in) {
    if (in.environment == graph::TextureHandle::None) return;
    block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.scene.environment->rotation)));
    block.intensity = in.scene.environment->intensity;
}

// The cube view from an object; -1: none.
int cubeOf(const views::Surroundings* surroundings, int object) {
    if (!surroundings) return -1;
    const auto& cubes = surroundings->cubes;
    const auto found = std::find_if(cubes.begin(), cubes.end(),
                                    [&](const views::Probe& cube) { return cube.object == object; });
    return found == cubes.end() ? -1 : int(found - cubes.begin());
}

MirrorBlock mirrorBlock(const MirrorInputs& in, const views::Drawable& mirror) {
    MirrorBlock block{.view = views::viewBlock(in.eye, in.size),
                      .around = views::aroundBlock(in.surroundings),
                      .reflectance = vec4(mirror.object->material.mirror().reflectance, 0),
                      .object = mirror.index,
                      .cube = cubeOf(in.surroundings, mirror.index)};
    if (in.surroundings) {
        const auto& flat = in.surroundings->flat;
        for (std::size_t i = 0; i < flat.size(); ++i)
            if (flat[i].object == block.object)
                block.flats[std::size_t(block.flatCount++)] = vec4(flat[i].normal, i);
    }
    setSky(block, in);
    return block;
}

// By the offset of the pixel's sample: each sample of a pixel takes other directions.
vec2 turnOf(const views::Eye& eye, ivec2 size) { return glm::fract(0.5f * eye.shift * vec2(size)); }

LobeBlock lobeBlock(const Inputs& in, const views::Drawable& glossy) {
    const scene::Material& material = glossy.object->material;
    const ReflectorValues values = reflectorOf(material);
    LobeBlock block{.view = views::viewBlock(in.eye, in.size),
                    .around = views::aroundBlock(in.surroundings),
                    .diffuse = values.diffuse,
                    .specular = values.specular,
                    .lobe = values.lobe,
                    .turn = turnOf(in.eye, in.size),
                    .alpha = facetAlphaOf(material),
                    .directions = in.lobeDirections,
                    .object = glossy.index,
                    .isTextured = isTextured(glossy),
                    .cube = cubeOf(in.surroundings, glossy.index)};
    setSky(block, in);
    return block;
}

// What of the surroundings mirrors show, for people.
std::string shownIn(const MirrorInputs& in) {
    if (in.surroundings && (in.surroundings->hasCubes() || !in.surroundings->flat.empty()))
        return "they show what is around";
    if (in.solid) return "they show what the camera sees";
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
                : object.material.isGlossy()     ? "a glossy surface"
                : object.material.isScattering() ? "painted, and matt where it is not translucent"
                                                 : "an opaque surface");
    }
    return std::nullopt;
}

// What narrow lobes mirror of what is around; none where there is nothing.
graph::TextureId Brdf::recordLobes(graph::FrameGraph& graph, const Inputs& in,
                                   const views::TexturedImages& textured) const {
    const bool hasSky = in.environment != graph::TextureHandle::None;
    const bool hasCubes = in.surroundings && in.surroundings->hasCubes();
    std::vector<graph::Block> blocks;
    for (const auto& solid : in.solids)
        if (showsObjects(*solid->object)) blocks.push_back(lobeBlock(in, *solid));
    if (blocks.empty() || (!hasSky && !hasCubes)) return {};
    std::vector<std::string> defines;
    if (hasSky) defines.push_back("USE_SKY");
    if (hasCubes) defines.push_back("USE_AROUND");
    if (textured) defines.push_back("TEXTURED");
    const gl::Program* program = context_.program("brdf/lobe", defines);
    std::vector<graph::Binding> kept;
    if (hasSky) kept.push_back({"uEnvironment", in.environment});
    if (hasCubes) {
        kept.push_back({"uAround", in.surroundings->radiance});
        kept.push_back({"uAroundSolid", in.surroundings->solid});
    }
    graph::TextureId mirrored;
    graph.addPass("brdf.lobe", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what " + std::to_string(blocks.size()) + " glossy object(s) mirror of what is around, " +
                    std::to_string(in.lobeDirections) + " directions a pixel");
        pass.sample(in.surface);
        views::sampleTextured(pass, textured);
        mirrored = pass.createColor("brdf.lobe", {.size = in.size, .format = graph::Format::RGBA32F});
        pass.clear(mirrored, vec4(0));
        return [=, surface = in.surface](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures = kept;
            textures.push_back({"uSurface", resources[surface]});
            views::bindTextured(textures, resources, textured);
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return mirrored;
}

Status Brdf::record(graph::FrameGraph& graph, const Inputs& in) {
    if (in.solids.empty()) return Done{};
    const bool isGlossy = in.show == scene::Aov::Color &&
                          std::any_of(in.solids.begin(), in.solids.end(),
                                      [](const auto& one) { return one->object->material.isGlossy(); });
    const views::TexturedImages textured =
        textured_.record(graph, context_, in.eye, filtered(in.solids, isTextured), in.surface, in.size);
    const graph::TextureId mirrored =
        isGlossy && in.first == 0 ? recordLobes(graph, in, textured) : graph::TextureId{};
    const graph::TextureId surface = in.surface, table = in.lightTable, target = in.target;
    const graph::TextureId occlusion = in.occlusion.texture;
    const graph::TextureId flux = in.flux;
    const graph::TextureId sum = in.first > 0 ? in.sum : graph::TextureId{};
    std::vector<std::string> defines = in.occlusion.defines();
    if (flux) defines.push_back("USE_FLUX");
    if (in.show == scene::Aov::Irradiance) defines.push_back("SHOW_IRRADIANCE");
    if (isGlossy) defines.push_back("GLOSSY");
    if (mirrored) defines.push_back("USE_MIRRORED");
    if (textured) defines.push_back("TEXTURED");
    const gl::Program* program = context_.program("brdf/light", defines);
    std::vector<graph::Block> blocks;
    for (int first = 0; first < int(in.scene.objects.size()); first += kMostMatter)
        blocks.push_back(mattBlock(in, first));
    struct Measured {
        graph::Block block;
        graph::TextureHandle table;
    };
    std::vector<Measured> measured;
    const bool hasTable = in.show != scene::Aov::Irradiance;
    for (const auto& solid : in.solids) {
        const auto* kind = std::get_if<scene::MeasuredBrdf>(&solid->object->material.kind);
        if (!kind) continue;
        Result<graph::TextureHandle> table = in.table(kind->table);
        if (!table) return table.error();
        measured.push_back({measuredBlock(in, *solid), *table});
    }
    const gl::Program* lookup = nullptr;
    if (!measured.empty()) {
        std::erase(defines, "GLOSSY");
        std::erase(defines, "USE_MIRRORED");
        std::erase(defines, "TEXTURED");
        if (hasTable) defines.push_back("MEASURED");
        lookup = context_.program("brdf/light", defines);
    }
    graph.addPass("brdf.light", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light samples " + std::to_string(in.first) + " to " + std::to_string(in.end - 1) +
                    " on " + std::to_string(in.solids.size()) + " matt" + (isGlossy ? " or glossy" : "") +
                    " object(s)");
        pass.sample(surface);
        pass.sample(table);
        for (const graph::TextureId id : {occlusion, flux, sum, mirrored})
            if (id) pass.sample(id);
        views::sampleTextured(pass, textured);
        pass.write(target);
        if (in.clears) pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uLights", resources[table]}};
            if (occlusion) textures.push_back({"uOcclusion", resources[occlusion]});
            if (flux) textures.push_back({"uFlux", resources[flux]});
            if (sum) textures.push_back({"uSum", resources[sum]});
            const std::vector<graph::Binding> shared = textures;
            if (mirrored) textures.push_back({"uMirrored", resources[mirrored]});
            views::bindTextured(textures, resources, textured);
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
            for (const Measured& one : measured) {
                std::vector<graph::Binding> own = shared;
                if (hasTable) own.push_back({"uTable", one.table});
                commands.draw({.program = lookup, .block = one.block, .textures = own});
            }
        };
    });
    return Done{};
}

const ParamTable& params() {
    static const Param list[] = {
        declare(&Settings::surroundings, views::aroundText()),
        declare(&Settings::lobeDirections,
                {.id = "lobeDirections",
                 .label = "Directions of a lobe",
                 .min = 1,
                 .max = 1024,
                 .low = 1,
                 .high = 64,
                 .group = Group::Environment,
                 .doc = "In how many directions a glossy surface looks around, in each sample of a pixel: "
                        "more make what it mirrors smoother and take longer."}),
    };
    static const ParamTable table = tableOf<Settings>("brdf", list, "Mirrors and gloss");
    return table;
}

Status Brdf::recordMirrors(graph::FrameGraph& graph, const MirrorInputs& in) const {
    if (in.mirrors.empty()) return Done{};
    const bool hasSky = in.environment != graph::TextureHandle::None;
    const bool hasCubes = in.surroundings && in.surroundings->hasCubes();
    const bool hasFlat = in.surroundings && !in.surroundings->flat.empty();
    std::vector<std::string> defines;
    if (hasSky) defines.push_back("USE_SKY");
    if (hasCubes) defines.push_back("USE_AROUND");
    if (hasFlat) defines.push_back("USE_FLAT");
    if (in.solid && !hasCubes) defines.push_back("USE_VIEW");
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
