#include "relief/Relief.h"

#include "views/EnvironmentLights.h"

#include <cstddef>

namespace lucent::relief {

namespace {

constexpr std::string_view kMethods[] = {"hierarchy", "march", "counting"};
constexpr std::string_view kAttenuations[] = {"ratio", "exponential"};

struct ReliefBlock {
    views::FieldBlock field;
    vec4 eye, base, diffuse, specular, falloffs;
    mat4 objectFromWorld;
    float metres, radius;
    int object, firstLight, endLight, isFirst, exponential, steps;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::fieldMembers(offsetof(ReliefBlock, field));
            list.insert(list.end(), {{"eye", offsetof(ReliefBlock, eye)},
                                     {"base", offsetof(ReliefBlock, base)},
                                     {"diffuse", offsetof(ReliefBlock, diffuse)},
                                     {"specular", offsetof(ReliefBlock, specular)},
                                     {"falloffs", offsetof(ReliefBlock, falloffs)},
                                     {"objectFromWorld", offsetof(ReliefBlock, objectFromWorld)},
                                     {"metres", offsetof(ReliefBlock, metres)},
                                     {"radius", offsetof(ReliefBlock, radius)},
                                     {"object", offsetof(ReliefBlock, object)},
                                     {"firstLight", offsetof(ReliefBlock, firstLight)},
                                     {"endLight", offsetof(ReliefBlock, endLight)},
                                     {"isFirst", offsetof(ReliefBlock, isFirst)},
                                     {"exponential", offsetof(ReliefBlock, exponential)},
                                     {"steps", offsetof(ReliefBlock, steps)}});
            return list;
        }();
        static const graph::BlockLayout layout{"ReliefBlock", sizeof(ReliefBlock), members};
        return layout;
    }
};

ReliefBlock makeBlock(const views::DrawnObject& drawn, const Inputs& in, const Settings& settings) {
    const scene::Object& object = *drawn.object;
    const scene::Material& material = object.material;
    const mat4 worldFromObject = object.transform.worldFromObject();
    const float scale = object.transform.scale;
    ReliefBlock block{};
    block.field = drawn.field->block(object.shape);
    block.eye = in.eye.inObject(worldFromObject);
    block.base = vec4(material.base, material.specularity);
    block.diffuse = vec4(material.diffuse, material.forwardScatter);
    block.specular = vec4(material.specular, material.depth / scale);
    block.falloffs = vec4(material.specularFalloff, material.scatterFalloff);
    block.objectFromWorld = glm::inverse(worldFromObject);
    block.metres = scale;
    block.radius = glm::length(object.shape.footprint());
    block.object = drawn.index;
    block.firstLight = in.first;
    block.endLight = in.end;
    block.isFirst = in.first == 0;
    block.exponential = settings.attenuation == Attenuation::Exponential;
    block.steps = settings.steps;
    return block;
}

std::vector<std::string> defines(const views::DrawnObject& drawn, const Settings& settings, scene::Aov show) {
    constexpr auto none = graph::TextureHandle::None;
    std::vector<std::string> list;
    if (settings.method == Method::March) list.push_back("METHOD_MARCH");
    if (settings.method == Method::Counting) list.push_back("METHOD_COUNTING");
    if (drawn.baseMap != none) list.push_back("USE_BASE_MAP");
    if (drawn.diffuseMap != none) list.push_back("USE_DIFFUSE_MAP");
    if (drawn.specularMap != none) list.push_back("USE_SPECULAR_MAP");
    if (show == scene::Aov::Iterations) list.push_back("SHOW_ITERATIONS");
    if (show == scene::Aov::Visibility) list.push_back("SHOW_VISIBILITY");
    return list;
}

bool hasEnvironment(const scene::Scene& scene) { return scene.environment && scene.environment->enabled; }

LightSource sourceOf(const scene::Light& light) {
    if (const auto* point = std::get_if<scene::PointLight>(&light)) {
        const bool fades = point->falloff == scene::LightFalloff::InverseSquare;
        return {vec4(point->position, fades ? 2 : 1), point->intensity * point->color, 1};
    }
    const auto& distant = std::get<scene::DistantLight>(light);
    return {vec4(-glm::normalize(distant.direction), 0), distant.irradiance * distant.color, 1};
}

} // namespace

const ParamTable& Relief::params() {
    static const Param list[] = {
        declare(&Settings::method, {.id = "method",
                                    .label = "Method",
                                    .group = Group::HeightField,
                                    .doc = "How the length inside the solid is found: exactly, skipping by a "
                                           "pyramid of heights; by equal steps; or by counting points as in "
                                           "the thesis, which does not converge.",
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
        declare(&Settings::environmentLights,
                {.id = "environmentLights",
                 .label = "Directions",
                 .min = 6,
                 .max = 65536,
                 .low = 16,
                 .high = 1024,
                 .logarithmic = true,
                 .group = Group::Environment,
                 .doc = "About how many directions stand for the environment; each carries the mean of its "
                        "part of the map."}),
        declare(&Settings::normalise, {.id = "normalise",
                                       .label = "Divide by number of lights",
                                       .group = Group::Light,
                                       .doc = "Divides the light by the number of lights, an environment "
                                              "counting as one, so that more lights do not brighten the "
                                              "picture (thesis 4.3.7). Off: lights add."}),
    };
    static const ParamTable table = tableOf<Settings>("relief", list);
    return table;
}

std::optional<std::string> Relief::need(const scene::Scene& scene) {
    if (scene.objects.empty()) return std::nullopt;
    return "object \"" + scene.objects.front().name + "\" is a height field";
}

std::vector<LightSource> Relief::lights(const scene::Scene& scene, const Settings& settings,
                                        int environmentLights) {
    std::vector<LightSource> sources;
    for (const scene::Light& light : scene.lights)
        sources.push_back(sourceOf(light));
    std::size_t count = sources.size();
    if (hasEnvironment(scene) && environmentLights > 0) {
        for (const views::EnvironmentLight& light :
             views::environmentLights(*scene.environment, environmentLights))
            sources.push_back({vec4(light.direction, 0), light.weight * light.radiance, light.weight});
        ++count;
    }
    for (LightSource& source : sources) {
        source.weight /= float(count);
        if (settings.normalise) source.color /= float(count);
    }
    return sources;
}

Image Relief::lightTable(const std::vector<LightSource>& lights) {
    const int rows = std::max(1, (int(lights.size()) + kLightsPerRow - 1) / kLightsPerRow);
    Image table(2 * kLightsPerRow, rows, 4);
    float* texel = table.pixels.data();
    for (const LightSource& light : lights) {
        for (float value : {light.place.x, light.place.y, light.place.z, light.place.w, light.color.r,
                            light.color.g, light.color.b, light.weight})
            *texel++ = value;
    }
    return table;
}

Status Relief::record(graph::FrameGraph& graph, const Inputs& in, const Settings& settings) const {
    std::vector<const gl::Program*> programs;
    for (const views::DrawnObject& drawn : in.objects) {
        Result<const gl::Program*> program =
            context_.program("relief/light", defines(drawn, settings, in.show));
        if (!program) return program.error();
        programs.push_back(*program);
    }
    std::vector<graph::Block> blocks;
    for (const views::DrawnObject& drawn : in.objects)
        blocks.push_back(makeBlock(drawn, in, settings));
    const std::vector<views::DrawnObject> objects = in.objects;
    const graph::TextureId surface = in.surface, sum = in.sum, target = in.target, table = in.lightTable;
    const bool readsSum = in.first > 0;
    graph.addPass("relief.light", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("lights " + std::to_string(in.first) + " to " + std::to_string(in.end - 1) + " of " +
                    std::to_string(in.lights.size()) + " through the solid, method " +
                    std::string(kMethods[std::size_t(settings.method)]));
        pass.sample(surface);
        pass.sample(table);
        if (readsSum) pass.sample(sum);
        pass.write(target);
        pass.clear(vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (std::size_t i = 0; i < objects.size(); ++i) {
                const views::DrawnObject& drawn = objects[i];
                auto textures = drawn.field->bindings();
                textures.push_back({"uSurface", resources[surface]});
                textures.push_back({"uLights", resources[table]});
                if (readsSum) textures.push_back({"uSum", resources[sum]});
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
