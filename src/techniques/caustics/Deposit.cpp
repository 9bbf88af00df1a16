#include "techniques/caustics/LightPasses.h"

#include <algorithm>
#include <cmath>

namespace lucent::caustics {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

// Texels a side, at most, of what the ray of a pixel is spread over. Rays that part widely are long thin
// parallelograms in points whose squares they hardly fill: under a glass ball most of the time of adding up
// went there. Narrower ones leave gaps in what is dim by then.
constexpr float kWidestFootprint = 96;

float LightPasses::unit() const {
    const views::Eye& face = mapViews().faces.front();
    vec2 texel = 2.0f * face.halfExtent / float(mapViews().size);
    if (!light_.halves.faces.empty()) texel *= 2.0f; // radians in the middle of a paraboloid
    const vec3 color = light_.lamp.color;
    return texel.x * texel.y * std::max({color.r, color.g, color.b});
}

// A splat covers three rays of a light that nothing bends, and at least three texels.
float LightPasses::splatSize(const views::Eye& glass) const {
    const views::Eye& face = mapViews().faces.front();
    const float ray = glass.halfExtent.x / float(settings_.grid);
    const float texel = face.halfExtent.x / float(mapViews().size);
    return std::clamp(3 * ray / texel, 3.0f, context_.caps().maxPointSize);
}

DepositBlock LightPasses::depositBlock(const Photons& photons, float size) const {
    return {.faces = views::facesOf(mapViews()),
            .frame = vec4(0),
            .grid = photons.count,
            .faceCount = int(mapViews().faces.size()),
            .face = 0,
            .unit = unit(),
            .size = size,
            .first = 0,
            .spread = spreadOf(light_.lamp),
            .within = 0};
}

// Over what the light of the rays that carry the rest is spread.
Status LightPasses::spread(Sheet& sheet) {
    std::vector<std::string> defines;
    Samples samples{
        {"uLanding", sheet.rest.landing}, {"uFlux", sheet.rest.flux}, {"uIndex", sheet.cells.index}};
    if (!refines()) {
        defines.push_back("OF_RESTS");
        samples.push_back({"uGridLanding", sheet.grid.landing});
    }
    const gl::Program* spreading = programOnMap("caustics/spread", std::move(defines));
    graph_.addPass("caustics.spread", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("over what rays spread their light where no beam carries it");
        for (const auto& [name, texture] : samples)
            pass.sample(texture);
        const TextureDesc desc{.size = sheet.rest.count, .format = Format::RGBA32F};
        sheet.sides = pass.createColor("caustics.sides", desc);
        sheet.shares = pass.createColor("caustics.shares", desc);
        pass.clear(sheet.sides, vec4(0));
        pass.clear(sheet.shares, vec4(0));
        const float widest = std::min(context_.caps().maxPointSize, kWidestFootprint);
        return [=, draw = drawOf(Part::Rests), program = spreading, block = depositBlock(sheet.rest, widest)](
                   const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw filled = draw;
            filled.program = program;
            filled.block = block;
            for (const auto& [name, texture] : samples)
                filled.textures.push_back({name, resources[texture]});
            commands.draw(filled);
        };
    });
    return Done{};
}

namespace {
// Rays whose rectangles are drawn of `count` packed ones: as many as lie at outlines and folds as a rule.
// What comes after them is drawn as square points, which have a sixth of the vertices, and many times the
// pixels.
int rectanglesOf(ivec2 count) { return count.x * ((count.y + 7) / 8); }
int areaOf(ivec2 size) { return size.x * size.y; }
} // namespace

LightPasses::Range LightPasses::allOf(const Sheet& sheet) { return {0, areaOf(sheet.grid.count)}; }

Status LightPasses::addKind(const char* stem, std::vector<std::string> defines, Kind kind,
                            std::vector<Kind>& kinds) {
    kind.program = programOnMap(stem, std::move(defines));
    kinds.push_back(std::move(kind));
    return Done{};
}

// Triangles between the rays of the grid, points for those too small to be drawn, and the rest.
Status LightPasses::addBeams(std::vector<Kind>& kinds) {
    std::vector<std::string> ofBeams, ofPoints;
    if (mapViews().faces.size() > 1) ofBeams.push_back("SEVERAL_VIEWS");
    if (!context_.caps().floatBlend) ofPoints.push_back("ON_ONE_TEXEL");
    std::vector<std::string> ofQuads = ofPoints;
    ofQuads.push_back("AS_QUADS");
    const int layers = light_.hasBehind ? 2 : 1;
    if (light_.hasBehind) ofBeams.push_back("USE_BEHIND");
    const auto squares = [layers](const Sheet& sheet) {
        return Range{0, layers * 6 * areaOf(sheet.grid.count - 1)};
    };
    const auto beams = [this](const Sheet& sheet) -> Samples {
        Samples samples{{"uLanding", sheet.grid.landing},
                        {"uPlace", sheet.grid.place},
                        {"uFlux", sheet.grid.flux},
                        {"uBeams", sheet.cells.beams},
                        {"uDensity", sheet.density}};
        if (light_.hasBehind)
            samples.insert(samples.end(), {{"uShadow", mapDepths_}, {"uBehind", mapBehind_}});
        return samples;
    };
    const auto points = [](const Sheet& sheet) -> Samples {
        return {{"uLanding", sheet.grid.landing}, {"uPlace", sheet.grid.place}, {"uPoint", sheet.points}};
    };
    const auto first = [](const Sheet& sheet) { return Range{0, 6 * rectanglesOf(sheet.rest.count)}; };
    const auto others = [](const Sheet& sheet) {
        const int drawn = rectanglesOf(sheet.rest.count);
        return Range{drawn, areaOf(sheet.rest.count) - drawn};
    };
    const auto rests = [](const Sheet& sheet) -> Samples {
        return {{"uLanding", sheet.rest.landing},
                {"uPlace", sheet.rest.place},
                {"uSides", sheet.sides},
                {"uShare", sheet.shares}};
    };
    Status s = addKind("caustics/beam", ofBeams, {graph::Topology::Triangles, squares, beams}, kinds);
    if (s) s = addKind("caustics/point", ofPoints, {graph::Topology::Points, allOf, points}, kinds);
    if (s)
        s = addKind("caustics/footprint", ofQuads, {graph::Topology::Triangles, first, rests, true}, kinds);
    if (s) s = addKind("caustics/footprint", ofPoints, {graph::Topology::Points, others, rests, true}, kinds);
    return s;
}

Status LightPasses::addSplats(std::vector<Kind>& kinds) {
    const auto samples = [](const Sheet& sheet) -> Samples {
        return {{"uLanding", sheet.grid.landing}, {"uPlace", sheet.grid.place}, {"uFlux", sheet.grid.flux}};
    };
    return addKind("caustics/splat", {}, {graph::Topology::Points, allOf, samples}, kinds);
}

Status LightPasses::deposit() {
    std::vector<Kind> kinds;
    const bool beams = settings_.deposit == Deposit::Beam;
    if (Status s = beams ? addBeams(kinds) : addSplats(kinds); !s) return s;
    const views::ShadowViews& views = mapViews();
    const TextureDesc desc{.size = mapSize(), .format = sumFormat()};
    const TextureId sharp =
        isSpread() ? graph_.create("caustics.sharp", desc) : targets_.make("caustics.map", desc);
    graph_.addPass("caustics.deposit", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light on the receivers, by " + std::string(nameOf(settings_.deposit)) +
                    (light_.hasBehind ? "; on those behind others too" : ""));
        struct Step {
            graph::Draw draw;
            DepositBlock block;
            Samples samples;
        };
        std::vector<Step> steps;
        for (const Sheet& sheet : sheets_)
            for (const Kind& kind : kinds) {
                const Range range = kind.range(sheet);
                Step step{.draw = {.program = kind.program,
                                   .vertices = range.vertices,
                                   .topology = kind.topology,
                                   .blend = graph::Blend::Add},
                          .block = depositBlock(kind.rest ? sheet.rest : sheet.grid, splatSize(sheet.eye)),
                          .samples = kind.samples(sheet)};
                step.block.first = range.first;
                step.block.within = sheet.within;
                for (const auto& [name, texture] : step.samples)
                    pass.sample(texture);
                steps.push_back(std::move(step));
            }
        pass.write(sharp);
        pass.clear(sharp, vec4(0));
        return [steps = std::move(steps), views, whole = ivec4(0, 0, mapSize()),
                hasBehind = light_.hasBehind](const graph::Resources& resources, graph::Commands& commands) {
            for (int face = 0; face < int(views.faces.size()); ++face)
                for (const Step& step : steps) {
                    graph::Draw draw = step.draw;
                    draw.region = hasBehind ? whole : ivec4(views.corner(face), views.size, views.size);
                    DepositBlock block = step.block;
                    block.face = face;
                    block.frame = vec4(draw.region);
                    draw.block = block;
                    for (const auto& [name, texture] : step.samples)
                        draw.textures.push_back({name, resources[texture]});
                    commands.draw(draw);
                }
        };
    });
    map_ = sharp;
    if (isSpread()) {
        blur(graph_.create("caustics.rows", desc), {1, 0});
        blur(targets_.make("caustics.map", desc), {0, 1});
    }
    return Done{};
}

// What the size of the light's sample leaves of the map's edges.
void LightPasses::blur(TextureId target, ivec2 along) {
    const gl::Program* blurring = program("caustics/blur");
    graph_.addPass("caustics.blur", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what the size of the light sample blurs");
        pass.sample(map_);
        pass.write(target);
        return [from = map_, program = blurring,
                block = BlurBlock{.face = ivec2(mapViews().size), .along = along}](
                   const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program, .block = block, .textures = {{"uMap", resources[from]}}});
        };
    });
    map_ = target;
}

Status LightPasses::lookUp(const Map& from, TextureId& sum) {
    std::vector<std::string> defines;
    if (sum) defines.push_back("USE_BEFORE");
    if (from.behind) defines.push_back("USE_BEHIND");
    if (in_.solid) defines.push_back("FROM_SOLID");
    if (in_.places) defines.push_back("OF_PLACES");
    const char* const name = in_.solid ? "uSolid" : "uSurface";
    const TextureId pixels = in_.solid ? in_.solid : in_.surface;
    const gl::Program* looking = programOnMap("caustics/lookup", defines);
    const TextureId before = sum;
    graph_.addPass("caustics.lookup", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("irradiance that one point of a light throws on each pixel by way of glass");
        pass.sample(pixels);
        if (in_.places) pass.sample(in_.places);
        pass.sample(from.flux);
        pass.sample(from.depths);
        if (from.behind) pass.sample(from.behind);
        if (before) pass.sample(before);
        sum = pass.createColor("caustics.irradiance", {.size = in_.size, .format = Format::RGBA32F});
        const LookupBlock block{.view = views::viewBlock(in_.eye, in_.size),
                                .faces = views::facesOf(mapViews()),
                                .faceCount = int(mapViews().faces.size()),
                                .unit = unit(),
                                .extent = in_.extent,
                                .part = 1 / std::sqrt(float(in_.samples))};
        return [=, program = looking, places = in_.places](const graph::Resources& resources,
                                                           graph::Commands& commands) {
            std::vector<graph::Binding> textures{{name, resources[pixels]},
                                                 {"uMap", resources[from.flux]},
                                                 {"uShadow", resources[from.depths]}};
            if (from.behind) textures.push_back({"uBehind", resources[from.behind]});
            if (before) textures.push_back({"uBefore", resources[before]});
            if (places) textures.push_back({"uPlaces", resources[places]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

} // namespace lucent::caustics
