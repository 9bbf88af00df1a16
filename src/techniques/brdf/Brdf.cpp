#include "techniques/brdf/Brdf.h"

#include "techniques/brdf/SkyIrradiance.h"
#include "light/Lamps.h"
#include "light/ShadowMap.h"

#include <algorithm>
#include <cstddef>

namespace lucent::brdf {

using graph::TextureId;

namespace {

struct IrradianceBlock {
    views::ViewBlock view;
    views::ViewBlock faces[views::ShadowViews::kMost];
    vec4 place{0}, centre{0}, color{0}, axis{0};
    vec2 cone{0};
    int faceCount = 0, padding = 0;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(IrradianceBlock, view));
            list.insert(list.end(), {{"faces[0].eye", offsetof(IrradianceBlock, faces)},
                                     {"faces[1].size", offsetof(IrradianceBlock, faces[1].size)},
                                     {"place", offsetof(IrradianceBlock, place)},
                                     {"centre", offsetof(IrradianceBlock, centre)},
                                     {"color", offsetof(IrradianceBlock, color)},
                                     {"axis", offsetof(IrradianceBlock, axis)},
                                     {"cone", offsetof(IrradianceBlock, cone)},
                                     {"faceCount", offsetof(IrradianceBlock, faceCount)}});
            return list;
        }();
        static const graph::BlockLayout layout{"IrradianceBlock", sizeof(IrradianceBlock), members};
        return layout;
    }
};

struct Matter {
    vec4 base, tint;
};

struct ShadeBlock {
    static constexpr int kObjects = 256;

    views::ViewBlock view;
    mat4 mapFromWorld{1};
    vec4 sky[9] = {};
    Matter matter[kObjects] = {};
    int first = 0;
    float intensity = 0;
    int padding[2] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(ShadeBlock, view));
            list.insert(list.end(), {{"mapFromWorld", offsetof(ShadeBlock, mapFromWorld)},
                                     {"sky", offsetof(ShadeBlock, sky)},
                                     {"matter[0].base", offsetof(ShadeBlock, matter)},
                                     {"matter[1].tint", offsetof(ShadeBlock, matter[1].tint)},
                                     {"first", offsetof(ShadeBlock, first)},
                                     {"intensity", offsetof(ShadeBlock, intensity)}});
            return list;
        }();
        static const graph::BlockLayout layout{"ShadeBlock", sizeof(ShadeBlock), members};
        return layout;
    }
};

IrradianceBlock blockOf(const views::LampPoint& lamp, const views::ShadowViews& shadow, const Inputs& in) {
    IrradianceBlock block{.view = views::viewBlock(in.eye, in.size),
                          .faces = {},
                          .place = lamp.place,
                          .centre = vec4(lamp.centre, lamp.fades),
                          .color = vec4(lamp.color, lamp.exponent),
                          .axis = vec4(lamp.axis, 0),
                          .cone = lamp.cone,
                          .faceCount = int(shadow.faces.size())};
    for (std::size_t i = 0; i < shadow.faces.size(); ++i)
        block.faces[i] = views::viewBlock(shadow.faces[i], ivec2(shadow.size));
    return block;
}

// Adds the light of one point of a lamp.
//
// @param before  what the points before it left on each pixel; or none
Result<TextureId> recordLamp(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                             const views::LampPoint& lamp, const views::ShadowViews& views, TextureId shadow,
                             TextureId before) {
    std::vector<std::string> defines;
    if (shadow) defines.push_back("USE_SHADOW");
    if (before) defines.push_back("USE_BEFORE");
    Result<const gl::Program*> program = context.program("brdf/irradiance", defines);
    if (!program) return program.error();
    TextureId sum;
    graph.addPass("brdf.irradiance", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light of one point of a lamp" +
                    std::string(shadow ? ", and its shadows" : "; nothing casts shadows"));
        pass.sample(in.surface);
        if (shadow) pass.sample(shadow);
        if (before) pass.sample(before);
        sum = pass.createColor("brdf.irradiance", {.size = in.size, .format = graph::Format::RGBA32F});
        return [=, surface = in.surface, program = *program, block = blockOf(lamp, views, in)](
                   const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]}};
            if (shadow) textures.push_back({"uShadow", resources[shadow]});
            if (before) textures.push_back({"uBefore", resources[before]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return sum;
}

// The light of all lamps on each pixel; none without lamps.
Result<TextureId> recordLamps(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                              const Settings& settings) {
    const std::vector<views::DrawnObject> fields(in.fields.begin(), in.fields.end());
    const views::Bounds casters = boundsOfAll(in.casters, fields);
    const views::Bounds receivers = views::seenBy(in.eye, boundsOfAll(in.solids));
    TextureId sum;
    for (const views::LampPoint& lamp : views::lampPoints(in.scene, settings.lightSamples)) {
        const int size = lamp.isPart ? std::max(16, settings.shadowSize / 2) : settings.shadowSize;
        const views::ShadowViews views = views::shadowViews(lamp.source, casters, receivers, size);
        TextureId shadow;
        if (!views.faces.empty()) {
            Result<TextureId> drawn =
                views::recordShadow(graph, context, views, in.casters, receivers, fields);
            if (!drawn) return drawn.error();
            shadow = *drawn;
        }
        Result<TextureId> added = recordLamp(graph, context, in, lamp, views, shadow, sum);
        if (!added) return added.error();
        sum = *added;
    }
    return sum;
}

// Of the objects [first, first + kObjects) of the scene.
ShadeBlock shadeBlock(const Inputs& in, int first) {
    ShadeBlock block;
    block.view = views::viewBlock(in.eye, in.size);
    block.first = first;
    if (in.environment != graph::TextureHandle::None) {
        const scene::Environment& environment = *in.scene.environment;
        block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(environment.rotation)));
        block.intensity = environment.intensity;
        const std::array<vec3, 9> sky = skyIrradiance(environment);
        std::transform(sky.begin(), sky.end(), block.sky, [](vec3 one) { return vec4(one, 0); });
    }
    for (const views::PosedMesh& solid : in.solids) {
        const int place = solid.drawn.index - first;
        if (place < 0 || place >= ShadeBlock::kObjects) continue;
        const scene::Material& material = solid.drawn.object->material;
        block.matter[place] = material.isMirror() ? Matter{vec4(0, 0, 0, 1), vec4(material.reflectance, 1)}
                                                  : Matter{vec4(material.base, 0), vec4(material.diffuse, 1)};
    }
    return block;
}

} // namespace

const ParamTable& Brdf::params() {
    static const Param list[] = {
        declare(&Settings::lightSamples, {.id = "lightSamples",
                                          .label = "Points of a lamp on surfaces",
                                          .min = 1,
                                          .max = 1024,
                                          .low = 1,
                                          .high = 64,
                                          .logarithmic = true,
                                          .group = Group::Light,
                                          .doc = "How many points stand for a lamp that has a size, where it "
                                                 "lights opaque surfaces; each casts its own shadows."}),
        declare(&Settings::shadowSize, {.id = "shadowSize",
                                        .label = "Shadow map",
                                        .unit = "texels",
                                        .min = 64,
                                        .max = 4096,
                                        .low = 256,
                                        .high = 2048,
                                        .logarithmic = true,
                                        .group = Group::Light,
                                        .doc = "Texels along a side of what a lamp sees; lamps with a size "
                                               "have half as many for each of their points."}),
    };
    static const ParamTable table = tableOf<Settings>("brdf", list, "Surfaces and shadows");
    return table;
}

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

Status Brdf::record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const {
    if (in.solids.empty()) return Done{};
    Result<TextureId> light = recordLamps(graph, context_, in, settings);
    if (!light) return light.error();
    const TextureId irradiance = *light, flux = in.flux, surface = in.surface, target = in.target;
    const bool hasSky = in.environment != graph::TextureHandle::None;
    std::vector<std::string> defines;
    if (irradiance) defines.push_back("USE_LAMPS");
    if (flux) defines.push_back("USE_FLUX");
    if (hasSky) defines.push_back("USE_SKY");
    if (in.show == scene::Aov::Irradiance) defines.push_back("SHOW_IRRADIANCE");
    Result<const gl::Program*> program = context_.program("brdf/shade", defines);
    if (!program) return program.error();
    std::vector<graph::Block> blocks;
    for (int first = 0; first < int(in.scene.objects.size()); first += ShadeBlock::kObjects)
        blocks.push_back(shadeBlock(in, first));
    graph.addPass("brdf.shade", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(std::to_string(in.solids.size()) + " opaque or mirroring object(s)" +
                    (hasSky ? "; the environment lights them past everything" : ""));
        pass.sample(surface);
        if (irradiance) pass.sample(irradiance);
        if (flux) pass.sample(flux);
        pass.write(target);
        return [=, program = *program, environment = in.environment](const graph::Resources& resources,
                                                                     graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]}};
            if (irradiance) textures.push_back({"uIrradiance", resources[irradiance]});
            if (flux) textures.push_back({"uFlux", resources[flux]});
            if (hasSky) textures.push_back({"uEnvironment", environment});
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return Done{};
}

} // namespace lucent::brdf
