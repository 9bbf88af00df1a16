#include "techniques/caustics/LightPasses.h"
#include "views/Glass.h"
#include "views/Meshes.h"

#include <algorithm>
#include <cmath>

namespace lucent::caustics {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {

// A lamp this high above all of the water [sine]: waves of less than 45 degrees stand in no light of each
// other, and the steepest that do not break have 30.
constexpr float kHighEnough = 0.7071f;

// Twice as many rays a side as through glass: a wave folds light within a few of them, and as they begin on
// the surface itself no view of the lamp has to be drawn for them.
int raysAlong(int grid) { return 2 * grid; }

ivec2 raysOn(const scene::Water& water, int grid) {
    const vec2 part = water.size / std::max(water.size.x, water.size.y);
    return glm::max(ivec2(glm::round(part * float(raysAlong(grid)))), ivec2(2));
}

} // namespace

bool beginsOnWater(const Settings& settings, const views::LampPoint& lamp, const views::Drawables& glass,
                   const views::Drawables& solids) {
    if (settings.deposit != Deposit::Beam || glass.size() != 1 || !mirrorsOf(solids).empty()) return false;
    if (std::any_of(solids.begin(), solids.end(), [](const auto& solid) { return solid->isBlended(); }))
        return false; // rays begin beneath what hides the water, or not at all
    const scene::Object& object = *glass.front()->object;
    if (!std::holds_alternative<scene::Water>(object.shape)) return false;
    const vec3 up = rotationFromDegrees(object.transform.rotate) * vec3(0, 1, 0);
    if (lamp.place.w == 0) return glm::dot(vec3(lamp.place), up) >= kHighEnough;
    const views::Bounds box = views::boundsOf(object);
    for (int corner = 0; corner < 8; ++corner) {
        const vec3 place(corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                         corner & 4 ? box.high.z : box.low.z);
        const vec3 way = vec3(lamp.place) - place;
        if (!(glm::dot(way, up) >= kHighEnough * glm::length(way))) return false;
    }
    return true;
}

WaterRaysBlock LightPasses::waterBlock(const Tint& tint, ivec2 rays) const {
    const scene::Object& object = *in_.glass.front()->object;
    const auto& water = std::get<scene::Water>(object.shape);
    const vec2 size = object.transform.scale * water.size / vec2(rays - 1);
    const ivec2 cells = scene::waterCells(water, object.mostCells);
    WaterRaysBlock block{.faces = views::facesOf(light_.water->over),
                         .worldFromObject = object.transform.worldFromObject(),
                         .normalFromObject = mat4(rotationFromDegrees(object.transform.rotate)),
                         .lamp = lampBlock(),
                         .water = views::glassBlock(object.material),
                         .place = light_.lamp.place,
                         .tint = vec4(tint.color, 0),
                         .cells = cells,
                         .grid = rays,
                         .cell = water.size / vec2(cells),
                         .faceCount = int(light_.water->over.faces.size()),
                         .channel = tint.channel,
                         .area = size.x * size.y};
    if (tint.wavelength > 0) block.water.ior.g = iorAt(vec3(block.water.ior), tint.wavelength);
    return block;
}

Status LightPasses::beginOnWater(const Tint& tint, ivec2 rays, TextureId shadow,
                                 const std::vector<TextureId>& targets, bool book) {
    std::vector<std::string> defines;
    if (shadow) defines.push_back("USE_SHADOW");
    if (book) defines.push_back("WITH_BOOK");
    const gl::Program* beginning = program("caustics/water", defines);
    graph_.addPass("caustics.water", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(book ? "where their light stays" : "rays of one point of a light from the water on");
        const TextureId positions = in_.glass.front()->mesh()->positions;
        pass.sample(positions);
        if (shadow) pass.sample(shadow);
        for (const TextureId target : targets)
            pass.write(target);
        return [=, picture = picture_, program = beginning, block = waterBlock(tint, rays)](
                   const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uPositions", resources[positions]},
                                                 pictureBinding(picture, resources[positions])};
            if (shadow) textures.push_back({"uShadow", resources[shadow]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

// Whether light of rays that have left what bends them may still be absorbed: in water, of which a sheet is
// all that there is.
bool LightPasses::absorbs() const {
    return std::any_of(in_.glass.begin(), in_.glass.end(), [](const auto& one) {
        return std::holds_alternative<scene::Water>(one->object->shape) &&
               vec3(views::glassBlock(one->object->material).absorption) != vec3(0);
    });
}

Status LightPasses::absorb(Photons& photons) {
    const TextureDesc desc{.size = photons.count, .format = Format::RGBA32F};
    const TextureId before = photons.flux, target = targets_.make("caustics.flux", desc);
    if (!photons.sent) photons.sent = before;
    photons.flux = target;
    SoakBlock block{};
    for (std::size_t i = 0; i < in_.glass.size(); ++i)
        block.absorption[i] = views::glassBlock(in_.glass[i]->object->material).absorption;
    const gl::Program* soaking = program("caustics/absorb");
    graph_.addPass("caustics.absorb", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what the water leaves of their light until they land");
        for (const TextureId image : {photons.place, photons.direction, photons.landing, before})
            pass.sample(image);
        pass.write(target);
        return [=, program = soaking](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uPlace", resources[photons.place]},
                                                 {"uDirection", resources[photons.direction]},
                                                 {"uLanding", resources[photons.landing]},
                                                 {"uFlux", resources[before]}};
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

// The light of triangles that are no beams goes with the rays at their corners.
Status LightPasses::leaveAlone(Sheet& sheet) {
    const gl::Program* leaving = program("caustics/alone");
    sheet.rest.count = sheet.grid.count;
    const Samples samples{{"uFlux", sheet.grid.flux},
                          {"uLanding", sheet.grid.landing},
                          {"uPlace", sheet.grid.place},
                          {"uBeams", sheet.cells.beams},
                          {"uIndex", sheet.cells.index}};
    graph_.addPass("caustics.alone", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("light between rays of which no beam is made");
        for (const auto& [name, texture] : samples)
            pass.sample(texture);
        const TextureDesc desc{.size = sheet.grid.count, .format = Format::RGBA32F};
        sheet.rest.flux = pass.createColor("caustics.alone", desc);
        sheet.rest.landing = pass.createColor("caustics.aloneLanding", desc);
        sheet.rest.place = pass.createColor("caustics.alonePlace", desc);
        for (const TextureId id : {sheet.rest.flux, sheet.rest.landing, sheet.rest.place})
            pass.clear(id, vec4(0));
        return [=, draw = drawOf(Part::Rests), program = leaving](const graph::Resources& resources,
                                                                  graph::Commands& commands) {
            graph::Draw filled = draw;
            filled.program = program;
            for (const auto& [name, texture] : samples)
                filled.textures.push_back({name, resources[texture]});
            commands.draw(filled);
        };
    });
    return Done{};
}

Status LightPasses::carryFromWater(const Tint& tint) {
    TextureId shadow;
    if (!light_.water->over.faces.empty()) {
        const views::Bounds below = boundsOfAll(in_.glass);
        Result<TextureId> depths =
            views::recordShadow(graph_, context_, light_.water->over, in_.solids, below);
        if (!depths) return depths.error();
        shadow = *depths;
    }
    const auto& water = std::get<scene::Water>(in_.glass.front()->object->shape);
    const TextureDesc desc{.size = raysOn(water, settings_.grid), .format = Format::RGBA32F};
    Sheet sheet{.eye = light_.receivers.faces.front()};
    sheet.grid.count = desc.size;
    sheet.grid.place = targets_.make("caustics.place", desc);
    sheet.grid.direction = targets_.make("caustics.direction", desc);
    sheet.grid.flux = absorbs() ? graph_.create("caustics.sent", desc) : targets_.make("caustics.flux", desc);
    Status s = beginOnWater(tint, desc.size, shadow,
                            {sheet.grid.place, sheet.grid.direction, sheet.grid.flux}, false);
    if (s) s = land(sheet.grid, Part::Cells, {});
    if (!s) return s;
    if (absorbs())
        if (s = absorb(sheet.grid); !s) return s;
    if (targets_.keeps()) {
        std::vector<TextureId> book;
        for (const char* label :
             {"caustics.incident", "caustics.absorbed", "caustics.reflected", "caustics.lost"})
            book.push_back(targets_.make(label, desc));
        s = beginOnWater(tint, desc.size, shadow, book, true);
        if (s && sheet.grid.sent) s = keepAbsorbed(sheet.grid, book.front());
        if (!s) return s;
    }
    const float reach = light_.lamp.place.w == 0
                            ? 1
                            : glm::distance(vec3(light_.lamp.place), boundsOfAll(in_.glass).center());
    const float cell = std::max(water.size.x, water.size.y) / float(raysAlong(settings_.grid));
    Result<TextureId> mask = beamsOf(sheet.grid, in_.glass.front()->object->transform.scale * cell / reach);
    if (!mask) return mask.error();
    sheet.cells.beams = *mask;
    s = weigh(sheet);
    if (s) s = pack(sheet);
    if (s) s = leaveAlone(sheet);
    if (s) s = spread(sheet);
    if (!s) return s;
    sheets_.push_back(std::move(sheet));
    return Done{};
}

} // namespace lucent::caustics
