#include "caustics/LightPasses.h"

#include <algorithm>

namespace lucent::caustics {

using graph::Format;
using graph::TextureId;

float LightPasses::unit() const {
    const views::Eye& face = light_.receivers.faces.front();
    const vec2 texel = 2.0f * face.halfExtent / float(light_.receivers.size);
    const vec3 color = light_.lamp.color;
    return texel.x * texel.y * std::max({color.r, color.g, color.b});
}

// A splat covers three rays of a light that nothing bends, and at least three texels.
float LightPasses::splatSize(const views::Eye& glass) const {
    const views::Eye& face = light_.receivers.faces.front();
    const float ray = glass.halfExtent.x / float(settings_.grid);
    const float texel = face.halfExtent.x / float(light_.receivers.size);
    return std::clamp(3 * ray / texel, 3.0f, context_.caps().maxPointSize);
}

DepositBlock LightPasses::depositBlock(const Photons& photons, float size) const {
    return {.faces = Faces(light_.receivers),
            .grid = photons.count,
            .faceCount = int(light_.receivers.faces.size()),
            .face = 0,
            .unit = unit(),
            .size = size};
}

Status LightPasses::deposit() {
    // One kind of what is drawn of the rays of a sheet.
    struct Kind {
        const gl::Program* program = nullptr;
        graph::Topology topology = graph::Topology::Points;
        bool rest = false; // of what no beam carries
        int perSquare = 0; // vertices of a square between rays; 0: one for each ray
    };
    std::vector<Kind> kinds;
    const auto add = [&](const char* stem, std::vector<std::string> defines, Kind kind) -> Status {
        Result<const gl::Program*> found = program(stem, std::move(defines));
        if (!found) return found.error();
        kind.program = *found;
        kinds.push_back(kind);
        return Done{};
    };
    if (settings_.deposit == Deposit::Beam) {
        if (Status s = add("caustics/beam", {}, {.topology = graph::Topology::Triangles, .perSquare = 6}); !s)
            return s;
        if (Status s = add("caustics/beam", {"AS_POINTS"}, {.perSquare = 2}); !s) return s;
        const std::vector<std::string> defines =
            refines() ? std::vector<std::string>{} : std::vector<std::string>{"OF_RESTS"};
        if (Status s = add("caustics/footprint", defines, {.rest = true}); !s) return s;
    } else if (Status s = add("caustics/splat", {}, {}); !s) {
        return s;
    }
    map_ = targets_.make("caustics.map", {.size = light_.receivers.imageSize(), .format = sumFormat()});
    graph_.addPass("caustics.deposit", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light on the receivers, by " + std::string(nameOf(settings_.deposit)));
        struct Step {
            Kind kind;
            DepositBlock block;
            Photons photons;
            TextureId beams, gridLanding;
        };
        std::vector<Step> steps;
        for (const Sheet& sheet : sheets_)
            for (const Kind& kind : kinds) {
                const Photons& photons = kind.rest ? sheet.rest : sheet.grid;
                const float size = kind.rest ? context_.caps().maxPointSize : splatSize(sheet.eye);
                pass.sample(photons.landing);
                pass.sample(photons.flux);
                if (kind.perSquare > 0) pass.sample(sheet.beams);
                steps.push_back(
                    {kind, depositBlock(photons, size), photons, sheet.beams, sheet.grid.landing});
            }
        pass.write(map_);
        pass.clear(map_, vec4(0));
        return [steps = std::move(steps), refines = refines(),
                views = light_.receivers](const graph::Resources& resources, graph::Commands& commands) {
            for (int face = 0; face < int(views.faces.size()); ++face)
                for (const auto& [kind, block, photons, beams, gridLanding] : steps) {
                    DepositBlock here = block;
                    here.face = face;
                    const ivec2 squares = photons.count - 1;
                    std::vector<graph::Binding> textures{{"uLanding", resources[photons.landing]},
                                                         {"uFlux", resources[photons.flux]}};
                    if (kind.perSquare > 0) textures.push_back({"uBeams", resources[beams]});
                    if (kind.rest && !refines) textures.push_back({"uGridLanding", resources[gridLanding]});
                    commands.draw({.program = kind.program,
                                   .vertices = kind.perSquare > 0 ? kind.perSquare * squares.x * squares.y
                                                                  : photons.count.x * photons.count.y,
                                   .topology = kind.topology,
                                   .region = ivec4(views.corner(face), views.size, views.size),
                                   .blend = graph::Blend::Add,
                                   .block = here,
                                   .textures = std::move(textures)});
                }
        };
    });
    return Done{};
}

Status LightPasses::lookUp(TextureId& sum) {
    Result<const gl::Program*> looking =
        program("caustics/lookup", sum ? std::vector<std::string>{"USE_BEFORE"} : std::vector<std::string>{});
    if (!looking) return looking.error();
    const TextureId before = sum;
    graph_.addPass("caustics.lookup", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("irradiance that one point of a light throws on each pixel by way of glass");
        pass.sample(in_.surface);
        pass.sample(map_);
        pass.sample(depths_);
        if (before) pass.sample(before);
        sum = pass.createColor("caustics.irradiance", {.size = in_.size, .format = Format::RGBA32F});
        const LookupBlock block{.view = views::viewBlock(in_.eye, in_.size),
                                .faces = Faces(light_.receivers),
                                .faceCount = int(light_.receivers.faces.size()),
                                .unit = unit()};
        return [=, program = *looking, surface = in_.surface, map = map_,
                depths = depths_](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{
                {"uSurface", resources[surface]}, {"uMap", resources[map]}, {"uShadow", resources[depths]}};
            if (before) textures.push_back({"uBefore", resources[before]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

} // namespace lucent::caustics
