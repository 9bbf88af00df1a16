#include "techniques/relief/Relief.h"

#include <algorithm>
#include <cmath>

namespace lucent::relief {

namespace {

constexpr std::string_view kMethods[] = {"hierarchy", "march", "counting", "transfer"};
constexpr std::string_view kAttenuations[] = {"ratio", "exponential"};

std::vector<std::string> defines(const views::DrawnField& drawn, const Settings& settings, const Inputs& in) {
    constexpr auto none = graph::TextureHandle::None;
    std::vector<std::string> list = in.occlusion.defines();
    if (!in.transferred.empty()) list.push_back("USE_TRANSFER");
    const bool shines = !in.transferred.empty() && drawn.object->material.relief().specularity > 0;
    if (in.first == in.end && !shines && !in.flux) list.push_back("LIGHTLESS");
    if (settings.method == Method::March) list.push_back("METHOD_MARCH");
    if (settings.method == Method::Counting) list.push_back("METHOD_COUNTING");
    if (drawn.baseMap != none) list.push_back("USE_BASE_MAP");
    if (drawn.diffuseMap != none) list.push_back("USE_DIFFUSE_MAP");
    if (drawn.specularMap != none) list.push_back("USE_SPECULAR_MAP");
    if (in.show == scene::Aov::Iterations) list.push_back("SHOW_ITERATIONS");
    if (in.show == scene::Aov::Visibility) list.push_back("SHOW_VISIBILITY");
    if (in.show == scene::Aov::Irradiance) list.push_back("SHOW_IRRADIANCE");
    if (in.flux) list.push_back("USE_FLUX");
    return list;
}

ReliefBlock blockOf(const views::DrawnField& drawn, const Inputs& in, const Settings& settings) {
    const mat4 worldFromObject = drawn.object->transform.worldFromObject();
    ReliefBlock block = makeBlock(drawn, settings);
    block.eye = in.eye.inObject(worldFromObject);
    block.objectFromWorld = glm::inverse(worldFromObject);
    block.worldFromObject = worldFromObject;
    block.firstLight = in.first;
    block.endLight = in.end;
    block.isFirst = in.first == 0;
    block.placed = in.placed;
    block.viewSize = in.size;
    block.columns = in.occlusion.columns;
    block.share = Relief::shareOfLight(in.scene);
    block.factor = (settings.normalise ? block.share : 1) / kPi;
    return block;
}

} // namespace

ReliefBlock makeBlock(const views::DrawnField& drawn, const Settings& settings) {
    const scene::Object& object = *drawn.object;
    const scene::Material& material = object.material;
    const scene::Relief& relief = material.relief();
    const float scale = object.transform.scale;
    ReliefBlock block{};
    block.field = drawn.block();
    block.base = vec4(material.base, relief.specularity);
    block.diffuse = vec4(material.diffuse, relief.forwardScatter);
    block.specular = vec4(relief.specular, relief.depth / scale);
    block.falloffs = vec4(relief.specularFalloff, relief.scatterFalloff);
    block.objectFromWorld = block.worldFromObject = mat4(1);
    block.share = block.factor = 1;
    block.metres = scale;
    block.radius = glm::length(object.field().footprint());
    block.object = drawn.index;
    block.exponential = settings.attenuation == Attenuation::Exponential;
    block.steps = settings.steps;
    return block;
}

const ParamTable& Relief::params() {
    static const Param list[] = {
        declare(&Settings::method, {.id = "method",
                                    .label = "Method",
                                    .group = Group::HeightField,
                                    .doc = "How the length inside the solid is found: exactly, skipping by a "
                                           "pyramid of heights; by equal steps; or by counting points as in "
                                           "the thesis, which does not converge. Transfer does as hierarchy "
                                           "for lamps, and traces a field once for all environments.",
                                    .choices = kMethods}),
        declare(&Settings::steps, {.id = "steps",
                                   .label = "Steps",
                                   .min = 1,
                                   .max = 65536,
                                   .low = 16,
                                   .high = 1024,
                                   .logarithmic = true,
                                   .group = Group::HeightField,
                                   .doc = "Steps along a ray; only march and counting take steps."}),
        declare(&Settings::attenuation,
                {.id = "attenuation",
                 .label = "Attenuation",
                 .group = Group::HeightField,
                 .doc =
                     "How light fades with the length r inside the solid: t / r, or e^(1 - r / t), which has "
                     "the same value and slope where r is the depth t.",
                 .choices = kAttenuations}),
        declare(&Settings::terms,
                {.id = "terms",
                 .label = "Terms",
                 .min = 4,
                 .max = kMostTerms,
                 .low = 4,
                 .high = kMostTerms,
                 .group = Group::Environment,
                 .doc = "Coefficients a texel by which transfer keeps how much light each direction brings; "
                        "rounded up to a multiple of 4. More keep shadows sharper."}),
        declare(&Settings::normalise, {.id = "normalise",
                                       .label = "Divide by number of lights",
                                       .group = Group::Light,
                                       .doc = "Divides the light by the number of lights, an environment "
                                              "counting as one, so that more lights do not brighten the "
                                              "picture (thesis 4.3.7). Off: lights add."}),
    };
    static const ParamTable table = tableOf<Settings>("relief", list, "Relief");
    return table;
}

std::optional<std::string> Relief::need(const scene::Scene& scene) {
    const auto field = std::find_if(scene.objects.begin(), scene.objects.end(),
                                    [](const scene::Object& object) { return object.isField(); });
    if (field == scene.objects.end()) return std::nullopt;
    return "object \"" + field->name + "\" is a height field";
}

float Relief::shareOfLight(const scene::Scene& scene) {
    return 1 / float(std::max<std::size_t>(1, scene.lights.size() + (views::hasEnvironment(scene) ? 1 : 0)));
}

Status Relief::record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const {
    std::vector<const gl::Program*> programs;
    for (const views::DrawnField& drawn : in.objects) {
        const gl::Program* program = context_.program("relief/light", defines(drawn, settings, in));
        programs.push_back(program);
    }
    std::vector<graph::Block> blocks;
    for (const views::DrawnField& drawn : in.objects)
        blocks.push_back(blockOf(drawn, in, settings));
    const std::vector<views::DrawnField> objects = in.objects;
    const graph::TextureId surface = in.surface, sum = in.sum, target = in.target, table = in.lightTable;
    const graph::TextureId occlusion = in.occlusion.texture;
    const graph::TextureId flux = in.flux;
    const std::vector<Transferred> transferred = in.transferred;
    const bool readsSum = in.first > 0;
    graph.addPass("relief.light", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("lights " + std::to_string(in.first) + " to " + std::to_string(in.end - 1) + " of " +
                    std::to_string(in.lights.size()) + " through the solid, method " +
                    std::string(kMethods[std::size_t(settings.method)]));
        pass.sample(surface);
        pass.sample(table);
        if (readsSum) pass.sample(sum);
        if (occlusion) pass.sample(occlusion);
        if (flux) pass.sample(flux);
        for (const Transferred& light : transferred)
            if (light.irradiance) pass.sample(light.irradiance);
        pass.write(target);
        if (in.clears) pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (std::size_t i = 0; i < objects.size(); ++i) {
                const views::DrawnField& drawn = objects[i];
                auto textures = drawn.heights->bindings();
                textures.push_back({"uSurface", resources[surface]});
                textures.push_back({"uLights", resources[table]});
                if (readsSum) textures.push_back({"uSum", resources[sum]});
                if (occlusion) textures.push_back({"uOcclusion", resources[occlusion]});
                if (flux) textures.push_back({"uFlux", resources[flux]});
                if (!transferred.empty() && transferred[i].irradiance) {
                    textures.push_back({"uIrradiance", resources[transferred[i].irradiance]});
                    textures.push_back({"uGloss", transferred[i].gloss});
                }
                if (drawn.baseMap != graph::TextureHandle::None)
                    textures.push_back({"uBaseMap", drawn.baseMap});
                if (drawn.diffuseMap != graph::TextureHandle::None)
                    textures.push_back({"uDiffuseMap", drawn.diffuseMap});
                if (drawn.specularMap != graph::TextureHandle::None)
                    textures.push_back({"uSpecularMap", drawn.specularMap});
                commands.draw({.program = programs[i], .block = blocks[i], .textures = std::move(textures)});
            }
        };
    });
    return Done{};
}

} // namespace lucent::relief
