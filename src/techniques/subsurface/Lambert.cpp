#include "techniques/subsurface/Lambert.h"

#include "light/ShadowMap.h"
#include "shaders/subsurface/Blocks.h"
#include "techniques/subsurface/Sky.h"

namespace lucent::subsurface {

using graph::TextureId;

namespace {

constexpr int kShadowSize =
    1024; // texels a side, in which highlights are cut off; of lamps with a size half as many

// Share of the light that entered which leaves again, of each colour.
vec3 wholeOf(const scene::Material& material, const Settings& settings) {
    const std::array<diffusion::Medium, 3> media = diffusion::mediaOf(material);
    vec3 whole;
    for (int i = 0; i < 3; ++i)
        whole[i] = float(
            diffusion::totalReflectance(media[std::size_t(i)], settings.profile, double(material.thickness)));
    return whole;
}

// The passes of one picture, each of which adds to the one before.
class Sum {
public:
    Sum(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
        const std::vector<views::PosedMesh>& objects, const Settings& settings)
        : graph_(graph), context_(context), in_(in), objects_(objects), settings_(settings) {}

    Status addLamp(const views::LampPoint& lamp) {
        Result<LampShadow> shadow = recordLampShadow(graph_, context_, in_, objects_, lamp);
        if (!shadow) return shadow.error();
        std::vector<LambertBlock> blocks;
        for (const views::PosedMesh& mesh : objects_) {
            LambertBlock block = blockOf(mesh);
            block.place = lamp.place;
            block.color = vec4(lamp.color, lamp.exponent);
            block.axis = vec4(lamp.axis, lamp.fades);
            block.cone = lamp.cone;
            block.faceCount = int(shadow->views.faces.size());
            block.faces = views::facesOf(shadow->views);
            blocks.push_back(block);
        }
        return add(blocks, shadow->map, shadow->map ? "USE_SHADOW" : "", "one point of a lamp");
    }

    Status addSky() {
        std::vector<LambertBlock> blocks;
        for (const views::PosedMesh& mesh : objects_) {
            LambertBlock block = blockOf(mesh);
            const std::array<vec3, 9> sky = enteringSky(*in_.scene.environment, double(block.ior));
            for (std::size_t i = 0; i < sky.size(); ++i)
                block.sky[i] = vec4(sky[i], 0);
            blocks.push_back(block);
        }
        return add(blocks, {}, "FROM_SKY", "the environment");
    }

    TextureId sum() {
        if (!sum_) {
            graph_.addPass("subsurface.lambert", [&](graph::PassBuilder& pass) -> graph::Execute {
                pass.reason("no light shines on what scatters");
                sum_ = create(pass);
                return [](const graph::Resources&, graph::Commands&) {};
            });
        }
        return sum_;
    }

private:
    LambertBlock blockOf(const views::PosedMesh& mesh) const {
        const scene::Material& material = mesh.drawn.object->material;
        const vec3 whole = in_.irradiance ? vec3(1) : wholeOf(material, settings_);
        return {.view = views::viewBlock(in_.eye, in_.size),
                .faces = {},
                .whole = vec4(whole, 0),
                .object = mesh.drawn.index,
                .ior = in_.irradiance ? 1 : material.surfaceIor()}; // at 1 all of it enters
    }

    TextureId create(graph::PassBuilder& pass) const {
        const TextureId sum =
            pass.createColor("subsurface.lambert", {.size = in_.size, .format = graph::Format::RGBA32F});
        pass.clear(sum, vec4(0));
        return sum;
    }

    Status add(const std::vector<LambertBlock>& blocks, TextureId shadow, const char* define,
               const std::string& source) {
        std::vector<std::string> defines;
        if (*define) defines.push_back(define);
        if (sum_) defines.push_back("USE_BEFORE");
        const gl::Program* program = context_.program("subsurface/lambert", defines);
        const TextureId before = sum_;
        graph_.addPass("subsurface.lambert", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("light of " + source + " that leaves where it entered");
            pass.sample(in_.surface);
            if (shadow) pass.sample(shadow);
            if (before) pass.sample(before);
            sum_ = create(pass);
            return [=, surface = in_.surface](const graph::Resources& resources, graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uSurface", resources[surface]}};
                if (shadow) textures.push_back({"uShadow", resources[shadow]});
                if (before) textures.push_back({"uBefore", resources[before]});
                for (const LambertBlock& block : blocks)
                    commands.draw({.program = program, .block = block, .textures = textures});
            };
        });
        return Done{};
    }

    graph::FrameGraph& graph_;
    gl::Context& context_;
    const Inputs& in_;
    const std::vector<views::PosedMesh>& objects_;
    const Settings& settings_;
    TextureId sum_;
};

} // namespace

Result<LampShadow> recordLampShadow(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                    const std::vector<views::PosedMesh>& objects,
                                    const views::LampPoint& lamp) {
    const views::Bounds receivers = views::seenBy(in.eye, boundsOfAll(objects));
    const int size = lamp.isPart ? kShadowSize / 2 : kShadowSize;
    LampShadow shadow{views::shadowViews(lamp.source, boundsOfAll(in.casters, in.fields), receivers, size),
                      {}};
    if (shadow.views.faces.empty()) return shadow;
    Result<TextureId> drawn =
        views::recordShadow(graph, context, shadow.views, in.casters, receivers, in.fields);
    if (!drawn) return drawn.error();
    shadow.map = *drawn;
    return shadow;
}

Result<Radiosity> recordLambert(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                const std::vector<views::PosedMesh>& objects, const Settings& settings) {
    Sum sum(graph, context, in, objects, settings);
    for (const views::LampPoint& lamp : views::lampPoints(in.scene, views::samplingOf(in.scene).lamp))
        if (Status added = sum.addLamp(lamp); !added) return added.error();
    if (in.environment != graph::TextureHandle::None)
        if (Status added = sum.addSky(); !added) return added.error();
    return Radiosity{sum.sum(), 1};
}

} // namespace lucent::subsurface
