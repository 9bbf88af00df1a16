#include "techniques/caustics/LightPasses.h"

#include "views/Glass.h"
#include "views/Surface.h"

#include <algorithm>

namespace lucent::caustics {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {
// How far a box reaches along a direction [m].
struct Extent {
    float low, high;
};
Extent extentOf(const views::Bounds& box, vec3 along) {
    const vec3 a = along * box.low, b = along * box.high;
    return {glm::dot(glm::min(a, b), vec3(1)), glm::dot(glm::max(a, b), vec3(1))};
}
} // namespace

views::Drawables withoutBlendedBefore(const views::LampPoint& lamp, const views::Bounds& bending,
                                      views::Drawables receivers) {
    const vec3 from(lamp.place);
    const vec3 way = lamp.place.w != 0 ? bending.center() - from : -from;
    const float first = extentOf(bending, way).low;
    return filtered(std::move(receivers), [&](const views::Drawable& one) {
        return !one.isBlended() || extentOf(one.bounds(), way).high > first;
    });
}

// --- what bends light

LampBlock LightPasses::lampBlock() const {
    return {.color = vec4(light_.lamp.color, light_.lamp.exponent),
            .axis = vec4(light_.lamp.axis, light_.lamp.fades),
            .cone = light_.lamp.cone,
            .grid = vec2(float(settings_.grid)),
            .picture = views::pictureBlock(light_.lamp)};
}

PhotonBlock LightPasses::photonBlock(const Plan::View& view, const Tint& tint) const {
    PhotonBlock block{.view = views::viewBlock(view.eye, viewSize()),
                      .lamp = lampBlock(),
                      .glass = {},
                      .tint = vec4(tint.color, 0),
                      .count = view.layers,
                      .channel = tint.channel,
                      .border = view.border};
    for (std::size_t i = 0; i < in_.glass.size(); ++i) {
        views::GlassBlock& glass = block.glass[i];
        glass = views::glassBlock(in_.glass[i]->object->material);
        if (tint.wavelength > 0) glass.ior.g = iorAt(vec3(glass.ior), tint.wavelength);
    }
    return block;
}

// What is blended ends no ray: beams would end with it, which it only weakens.
Result<LightPasses::GlassSeen> LightPasses::glassFrom(const Plan::View& view, const views::Drawables& glass,
                                                      const views::Drawables& solids) {
    GlassSeen seen;
    const ivec2 size = viewSize();
    if (!solids.empty()) {
        const TextureDesc desc{.size = size, .format = Format::RGBA32F};
        const TextureId surface = graph_.create("caustics.surface", desc);
        seen.solid = graph_.create("caustics.solid", desc);
        Status s = views::recordSurface(graph_, context_, view.eye, solids, surface, size);
        if (s) s = views::recordSolid(graph_, context_, view.eye, solids, surface, seen.solid, size);
        if (!s) return s.error();
    }
    Result<views::Layers> layers =
        views::recordLayers(graph_, context_, view.eye, glass, size, view.layers, seen.solid);
    if (!layers) return layers.error();
    seen.layers = *layers;
    Result<TextureId> depth = opticalDepth(view.eye, seen.layers.images, {"OF_LAYERS"});
    if (!depth) return depth.error();
    seen.opticalDepth = *depth;
    return seen;
}

Result<TextureId> LightPasses::opticalDepth(const views::Eye& eye, TextureId first,
                                            const std::vector<std::string>& defines) {
    if (blended_.empty()) return TextureId{};
    const TextureId depth =
        graph_.create("caustics.opticalDepth", {.size = viewSize(), .format = Format::R16F});
    if (Status s =
            views::recordOpticalDepth(graph_, context_, eye, blended_, first, depth, viewSize(), defines);
        !s)
        return s.error();
    return depth;
}

namespace {
graph::Draw filled(graph::Draw draw, const gl::Program& program, const graph::Block& block,
                   std::vector<graph::Binding> textures) {
    draw.program = &program;
    draw.block = block;
    draw.textures = std::move(textures);
    return draw;
}
} // namespace

// Rays of the rest are packed into the lowest rows of their images: a rectangle over these.
graph::Draw LightPasses::drawOf(Part part) {
    return isRest(part) ? graph::Draw{.vertices = 6} : graph::Draw{};
}

LightPasses::Samples LightPasses::Start::samples() const {
    Samples list;
    if (isRest() || (part == Part::Vertices && book)) list.push_back({"uBeams", cells.beams});
    if (isRest()) list.push_back({"uIndex", cells.index});
    return list;
}

std::vector<std::string> LightPasses::Start::defines() const {
    std::vector<std::string> list;
    if (part == Part::Vertices) list.push_back("VERTICES");
    if (part == Part::Rests) list.push_back("RESTS");
    if (part == Part::Pixels) list.push_back("PIXELS");
    if (isRest()) list.push_back("PACKED");
    if (book) list.push_back("WITH_BOOK");
    return list;
}

Status LightPasses::trace(const Plan::View& view, const Tint& tint, const GlassSeen& seen,
                          const Start& start) {
    std::vector<std::string> defines = start.defines();
    if (seen.solid) defines.push_back("USE_SOLID");
    if (seen.opticalDepth) defines.push_back("USE_BLENDED");
    const gl::Program* traced = program("caustics/photon", defines);
    graph_.addPass("caustics.photon", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(start.book       ? "where their light stays"
                    : start.isRest() ? "rays of one point of a light where no beam carries it"
                                     : "rays of one point of a light through refractive objects");
        views::sampleLayers(pass, seen.layers);
        for (const TextureId image : {seen.solid, seen.opticalDepth})
            if (image) pass.sample(image);
        for (const auto& [name, texture] : start.samples())
            pass.sample(texture);
        for (const TextureId target : start.targets) {
            pass.write(target);
            if (start.isRest()) pass.clear(target, vec4(0));
        }
        return
            [=, picture = picture_, draw = drawOf(start.part), program = traced,
             block = photonBlock(view, tint)](const graph::Resources& resources, graph::Commands& commands) {
                auto textures = views::layerBindings(resources, seen.layers);
                textures.push_back(pictureBinding(picture, resources[seen.layers.triangles.corners]));
                if (seen.solid) textures.push_back({"uSolid", resources[seen.solid]});
                if (seen.opticalDepth) textures.push_back({"uOpticalDepth", resources[seen.opticalDepth]});
                for (const auto& [name, texture] : start.samples())
                    textures.push_back({name, resources[texture]});
                commands.draw(filled(draw, *program, block, std::move(textures)));
            };
    });
    return Done{};
}

MirrorBlock LightPasses::mirrorBlock(const Plan::View& view) const {
    MirrorBlock block{
        .view = views::viewBlock(view.eye, viewSize()), .lamp = lampBlock(), .border = view.border};
    for (const auto& mirror : mirrorsOf(in_.solids))
        block.mirrors[std::size_t(block.count++)] =
            vec4(mirror->object->material.mirror().reflectance, float(mirror->index));
    return block;
}

// What the light meets first, mirrors or not: what refracts hides mirrors too.
Result<LightPasses::MirrorsSeen> LightPasses::mirrorsFrom(const views::Eye& eye) {
    views::Drawables everything = solids_;
    everything.insert(everything.end(), in_.glass.begin(), in_.glass.end());
    const TextureId surface =
        graph_.create("caustics.surface", {.size = viewSize(), .format = Format::RGBA32F});
    if (Status s = views::recordSurface(graph_, context_, eye, everything, surface, viewSize()); !s)
        return s.error();
    Result<TextureId> depth = opticalDepth(eye, surface, {});
    if (!depth) return depth.error();
    return MirrorsSeen{surface, *depth};
}

Status LightPasses::reflect(const Plan::View& view, const MirrorsSeen& seen, const Start& start) {
    std::vector<std::string> defines = start.defines();
    if (seen.opticalDepth) defines.push_back("USE_BLENDED");
    const gl::Program* reflecting = program("caustics/mirror", defines);
    graph_.addPass("caustics.mirror", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(start.book       ? "where their light stays"
                    : start.isRest() ? "rays of one point of a light where no beam carries it"
                                     : "rays of one point of a light off mirrors");
        pass.sample(seen.surface);
        if (seen.opticalDepth) pass.sample(seen.opticalDepth);
        for (const auto& [name, texture] : start.samples())
            pass.sample(texture);
        for (const TextureId target : start.targets) {
            pass.write(target);
            if (start.isRest()) pass.clear(target, vec4(0));
        }
        return [=, picture = picture_, draw = drawOf(start.part), program = reflecting,
                block = mirrorBlock(view)](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[seen.surface]},
                                                 pictureBinding(picture, resources[seen.surface])};
            if (seen.opticalDepth) textures.push_back({"uOpticalDepth", resources[seen.opticalDepth]});
            for (const auto& [name, texture] : start.samples())
                textures.push_back({name, resources[texture]});
            commands.draw(filled(draw, *program, block, std::move(textures)));
        };
    });
    return Done{};
}

// --- rays

// Begins rays and follows them to where they land.
Result<LightPasses::Photons> LightPasses::send(Part part, const Cells& cells, const Trace& trace) {
    Photons photons{.count = part == Part::Pixels ? viewSize() : ivec2(settings_.grid)};
    const TextureDesc desc{.size = photons.count, .format = Format::RGBA32F};
    photons.place = targets_.make("caustics.place", desc);
    photons.direction = targets_.make("caustics.direction", desc);
    const bool isLast = !mirrors_.view && (!absorbs() || isInPicture());
    photons.flux = isLast ? targets_.make("caustics.flux", desc) : graph_.create("caustics.sent", desc);
    if (Status s = trace({part, cells, {photons.place, photons.direction, photons.flux}}); !s)
        return s.error();
    if (mirrors_.view)
        if (Status s = bounce(photons); !s) return s.error();
    if (isInPicture()) return photons; // they land there
    if (Status s = land(photons, part, cells); !s) return s.error();
    if (absorbs())
        if (Status s = absorb(photons); !s) return s.error();
    return photons;
}

Result<LightPasses::MirrorLayers> LightPasses::layersOf(const Plan::View& view) {
    MirrorLayers layers;
    const views::Drawables receivers = receiversOf(solids_);
    if (view.layers == 0 || receivers.empty()) return layers;
    const Result<GlassSeen> seen = glassFrom(view, tracedMirrorsOf(in_.solids), receivers);
    if (!seen) return seen.error();
    layers = {&view, *seen};
    return layers;
}

// Follows rays from mirror to mirror.
Status LightPasses::bounce(Photons& photons) {
    const gl::Program* bouncing = program("caustics/bounce");
    const Photons before = photons;
    const TextureDesc desc{.size = photons.count, .format = Format::RGBA32F};
    photons.place = targets_.make("caustics.bounced", desc);
    photons.direction = targets_.make("caustics.bouncedDirection", desc);
    photons.flux = absorbs() && !isInPicture() ? graph_.create("caustics.bouncedFlux", desc)
                                               : targets_.make("caustics.flux", desc);
    photons.sent = before.flux;
    BounceBlock block{.view = views::viewBlock(mirrors_.view->eye, viewSize()),
                      .mirrors = {},
                      .count = mirrors_.view->layers};
    std::size_t number = 0;
    for (const auto& mirror : tracedMirrorsOf(in_.solids))
        block.mirrors[number++] = vec4(mirror->object->material.mirror().reflectance, 0);
    graph_.addPass("caustics.bounce", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("mirrors that rays meet on their way");
        views::sampleLayers(pass, mirrors_.seen.layers);
        for (const TextureId image : {mirrors_.seen.solid, before.place, before.direction, before.flux})
            pass.sample(image);
        for (const TextureId target : {photons.place, photons.direction, photons.flux})
            pass.write(target);
        return [=, seen = mirrors_.seen, program = bouncing](const graph::Resources& resources,
                                                             graph::Commands& commands) {
            auto textures = views::layerBindings(resources, seen.layers);
            textures.insert(textures.end(), {{"uSolid", resources[seen.solid]},
                                             {"uPlace", resources[before.place]},
                                             {"uDirection", resources[before.direction]},
                                             {"uFlux", resources[before.flux]}});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

// What was absorbed on the way: of the flux that was sent, what is left.
Status LightPasses::keepAbsorbed(const Photons& photons, TextureId incident) {
    const gl::Program* weighing = program("caustics/absorbed");
    const TextureId target =
        targets_.make("caustics.absorbed", {.size = photons.count, .format = Format::RGBA32F});
    graph_.addPass("caustics.absorbed", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what water or mirrors absorb on the way");
        const Samples samples{{"uBefore", photons.sent}, {"uAfter", photons.flux}, {"uIncident", incident}};
        for (const auto& [name, texture] : samples)
            pass.sample(texture);
        pass.write(target);
        return [=, program = weighing](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program};
            for (const auto& [name, texture] : samples)
                draw.textures.push_back({name, resources[texture]});
            commands.draw(draw);
        };
    });
    return Done{};
}

// Where somebody reads it, what became of their light.
Status LightPasses::keepBook(Part part, const Cells& cells, const Photons& photons, const Trace& trace) {
    if (!targets_.keeps()) return Done{};
    const TextureDesc desc{.size = photons.count, .format = Format::RGBA32F};
    std::vector<TextureId> book;
    for (const char* label :
         {"caustics.incident", "caustics.absorbed", "caustics.reflected", "caustics.lost"})
        book.push_back(targets_.make(label, desc));
    if (Status s = trace({part, cells, book, true}); !s) return s;
    return photons.sent ? keepAbsorbed(photons, book.front()) : Status(Done{});
}

Status LightPasses::carry(const views::Eye& eye, float within, const Trace& trace) {
    const bool beams = settings_.deposit == Deposit::Beam;
    const Part part = beams ? Part::Vertices : Part::Cells;
    Sheet sheet{.eye = eye, .within = within};
    Result<Photons> grid = send(part, {}, trace);
    if (!grid) return grid.error();
    sheet.grid = *grid;
    if (beams) {
        Result<TextureId> mask = beamsOf(*grid, 2 * eye.halfExtent.x / float(grid->count.x));
        if (!mask) return mask.error();
        sheet.cells.beams = *mask;
        if (Status s = weigh(sheet); !s) return s;
    }
    if (Status s = keepBook(part, sheet.cells, *grid, trace); !s) return s;
    if (beams) {
        const Part rests = refines() ? Part::Pixels : Part::Rests;
        if (Status s = pack(sheet); !s) return s;
        Result<Photons> rest = send(rests, sheet.cells, trace);
        if (!rest) return rest.error();
        sheet.rest = *rest;
        if (Status s = keepBook(rests, sheet.cells, *rest, trace); !s) return s;
        if (Status s = spread(sheet); !s) return s;
    }
    sheets_.push_back(std::move(sheet));
    return Done{};
}

// A little larger, so that flat ones have an inside.
views::Bounds LightPasses::boxOfReceivers() const {
    views::Bounds box = boundsOfAll(receivers_);
    const float margin = 1e-3f * box.radius();
    return {box.low - margin, box.high + margin};
}

Status LightPasses::land(Photons& photons, Part part, const Cells& cells) {
    static const char* const kVariants[] = {nullptr, "FIXED_POINT", "NEWTON", "SECANT"};
    std::vector<std::string> defines;
    if (const char* variant = kVariants[std::size_t(settings_.intersect)]) defines.push_back(variant);
    if (behind_) defines.push_back("USE_BEHIND");
    if (isRest(part)) defines.push_back("PACKED");
    if (light_.receivers.faces.size() == 1) defines.push_back("ONE_VIEW");
    const gl::Program* landing = program("caustics/land", defines);
    const views::Bounds box = boxOfReceivers();
    photons.landing = targets_.make("caustics.landing", {.size = photons.count, .format = Format::RGBA32F});
    const TextureId effort =
        targets_.make("caustics.effort", {.size = photons.count, .format = Format::RG32F});
    graph_.addPass("caustics.land", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("where these rays intersect receivers, by " + std::string(nameOf(settings_.intersect)));
        pass.sample(photons.place);
        pass.sample(photons.direction);
        pass.sample(depths_);
        if (behind_) {
            pass.sample(behind_);
            pass.sample(back_);
        }
        for (const TextureId target : {photons.landing, effort}) {
            pass.write(target);
            if (isRest(part)) pass.clear(target, vec4(0));
        }
        if (isRest(part)) pass.sample(cells.index);
        const LandBlock block{.faces = views::facesOf(light_.receivers),
                              .low = vec4(box.low, 0),
                              .high = vec4(box.high, 0),
                              .faceCount = int(light_.receivers.faces.size()),
                              .steps = settings_.steps};
        return [=, draw = drawOf(part), program = landing, depths = depths_, behind = behind_,
                back = back_](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uPlace", resources[photons.place]},
                                                 {"uDirection", resources[photons.direction]},
                                                 {"uShadow", resources[depths]}};
            if (behind) {
                textures.push_back({"uBehind", resources[behind]});
                textures.push_back({"uBack", resources[back]});
            }
            if (isRest(part)) textures.push_back({"uIndex", resources[cells.index]});
            commands.draw(filled(draw, *program, block, std::move(textures)));
        };
    });
    return Done{};
}

// @param cell  width of a ray's: m, or of a point's light m for each metre from it
Result<TextureId> LightPasses::beamsOf(const Photons& photons, float cell) {
    const gl::Program* choosing = programOnMap(
        "caustics/beams", refines() ? std::vector<std::string>{"REFINE"} : std::vector<std::string>{});
    TextureId beams;
    graph_.addPass("caustics.beams", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("which triangles between rays carry the light between them");
        pass.sample(photons.place);
        pass.sample(photons.flux);
        pass.sample(photons.landing);
        beams = pass.createColor("caustics.beams", {.size = photons.count, .format = Format::RGBA32F});
        const DepositBlock block = depositBlock(photons, cell);
        return [photons, block, program = choosing](const graph::Resources& resources,
                                                    graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uPlace", resources[photons.place]},
                                        {"uFlux", resources[photons.flux]},
                                        {"uLanding", resources[photons.landing]}}});
        };
    });
    return beams;
}

// What is known of the cells of a grid of rays.
Result<TextureId> LightPasses::recordCells(const char* stem, const char* reason, const TextureDesc& desc,
                                           const Samples& samples) {
    const gl::Program* found = program(stem);
    TextureId cells;
    graph_.addPass("caustics.cells", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        for (const auto& [name, texture] : samples)
            pass.sample(texture);
        cells = pass.createColor("caustics.cells", desc);
        return [=, program = found](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program};
            for (const auto& [name, texture] : samples)
                draw.textures.push_back({name, resources[texture]});
            commands.draw(draw);
        };
    });
    return cells;
}

// Finds the cells in which rays of their own begin, and a place for each.
Status LightPasses::pack(Sheet& sheet) {
    const ivec2 grid = sheet.grid.count;
    const TextureDesc number{.size = grid, .format = Format::R32F};
    const TextureDesc row{.size = {1, grid.y}, .format = Format::R32F};
    Result<TextureId> lone =
        recordCells("caustics/lone", "in which cells of the grid beams carry not all light", number,
                    {{"uBeams", sheet.cells.beams}, {"uFlux", sheet.grid.flux}});
    if (!lone) return lone.error();
    Result<TextureId> ranks =
        recordCells("caustics/ranks", "how many of them a row has up to each", number, {{"uLone", *lone}});
    if (!ranks) return ranks.error();
    Result<TextureId> rows =
        recordCells("caustics/rows", "how many there are up to each row", row, {{"uRanks", *ranks}});
    if (!rows) return rows.error();
    Result<TextureId> index =
        recordCells("caustics/index", "where each of them is packed",
                    {.size = grid, .format = Format::RGBA32F}, {{"uRanks", *ranks}, {"uRows", *rows}});
    if (!index) return index.error();
    sheet.cells.index = *index;
    return Done{};
}

// What the triangles around each ray leave where it lands.
Status LightPasses::weigh(Sheet& sheet) {
    if (Status s = weighOnce(sheet, false); !s) return s;
    return weighOnce(sheet, true);
}

// @param sharpen  what was found before
Status LightPasses::weighOnce(Sheet& sheet, bool sharpen) {
    const gl::Program* weighing = program("caustics/density", sharpen ? std::vector<std::string>{"SHARPEN"}
                                                                      : std::vector<std::string>{});
    const TextureId before = sheet.density;
    graph_.addPass("caustics.density", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how densely the triangles around each ray light what they fall on");
        pass.sample(sheet.cells.beams);
        pass.sample(sheet.grid.flux);
        if (sharpen) pass.sample(before);
        const TextureDesc desc{.size = sheet.grid.count, .format = Format::RGBA32F};
        sheet.density = pass.createColor("caustics.density", desc);
        if (!sharpen) sheet.points = pass.createColor("caustics.points", desc);
        return [=, beams = sheet.cells.beams, flux = sheet.grid.flux, block = depositBlock(sheet.grid, 0),
                program = weighing](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program,
                             .block = block,
                             .textures = {{"uBeams", resources[beams]}, {"uFlux", resources[flux]}}};
            if (sharpen) draw.textures.push_back({"uDensity", resources[before]});
            commands.draw(draw);
        };
    });
    return Done{};
}

// Depths at which what the light sees ends, where it is solid.
Status LightPasses::recordBack() {
    graph_.addPass("caustics.back", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how thick what the light sees is, past which it may come");
        std::vector<views::Drawing> drawings =
            drawingsOf(context_, pass, filtered(receivers_, &views::Drawable::hasBack),
                       views::ViewKind::Shadow, {"BEHIND", "BACK"});
        pass.sample(depths_);
        const ivec2 size = light_.receivers.imageSize();
        back_ = pass.createColor("caustics.back", {.size = size, .format = Format::R32F});
        pass.clear(back_, vec4(1e30f));
        pass.clear(pass.createDepth("caustics.backDepth", size, Format::Depth32F), 1.0f);
        return [drawings, views = light_.receivers, first = depths_](const graph::Resources& resources,
                                                                     graph::Commands& commands) {
            for (int face = 0; face < int(views.faces.size()); ++face)
                for (const views::Drawing& draw : drawings)
                    draw(resources, commands, views.faces[std::size_t(face)], ivec2(views.size),
                         {.region = ivec4(views.corner(face), views.size, views.size),
                          .depthTest = graph::DepthTest::Less,
                          .textures = {{"uFirst", resources[first]}}});
        };
    });
    return Done{};
}

// Depths in the map's paraboloids.
Status LightPasses::recordRound() {
    std::vector<std::string> defines{"PARABOLOIDS"};
    if (behind_) defines.push_back("USE_BEHIND");
    const gl::Program* rounding = program("caustics/round", defines);
    graph_.addPass("caustics.round", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how far what the light sees lies behind each texel of the map's paraboloids");
        Samples samples{{"uShadow", depths_}};
        if (behind_) samples.insert(samples.end(), {{"uBehind", behind_}, {"uBack", back_}});
        for (const auto& [name, texture] : samples)
            pass.sample(texture);
        const TextureDesc desc{.size = mapViews().imageSize(), .format = Format::R32F};
        mapDepths_ = pass.createColor("caustics.round", desc);
        if (behind_) mapBehind_ = pass.createColor("caustics.roundBehind", desc);
        RoundBlock block{.faces = views::facesOf(light_.receivers),
                         .faceCount = int(light_.receivers.faces.size())};
        std::copy_n(views::facesOf(light_.halves).begin(), 2, block.halves.begin());
        return [=, program = rounding, samples = std::move(samples)](const graph::Resources& resources,
                                                                     graph::Commands& commands) {
            std::vector<graph::Binding> textures;
            for (const auto& [name, texture] : samples)
                textures.push_back({name, resources[texture]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

// --- all of them

Status LightPasses::record(TextureId& sum) {
    if (light_.lamp.picture) {
        const Result<graph::TextureHandle> picture = pictureOf_(light_.lamp);
        if (!picture) return picture.error();
        picture_ = *picture;
    }
    const views::Bounds bounds = boundsOfAll(receivers_);
    Result<TextureId> depths = views::recordShadow(graph_, context_, light_.receivers, receivers_, bounds);
    if (!depths) return depths.error();
    depths_ = *depths;
    if (light_.hasBehind) {
        Result<TextureId> behind =
            views::recordShadow(graph_, context_, light_.receivers, receivers_, bounds, depths_);
        if (!behind) return behind.error();
        behind_ = *behind;
        if (Status s = recordBack(); !s) return s;
    }
    mapDepths_ = depths_;
    mapBehind_ = behind_;
    if (!light_.halves.faces.empty())
        if (Status s = recordRound(); !s) return s;
    const std::vector<Tint> light =
        views::disperses(in_.glass) ? tints(settings_.wavelengths) : std::vector<Tint>{{}};
    if (light_.water)
        for (const Tint& tint : light)
            if (Status s = carryFromWater(tint); !s) return s;
    if (light_.mirrors.size() == 1 && !light_.glass.empty()) {
        const Result<MirrorLayers> layers = layersOf(light_.mirrors.front());
        if (!layers) return layers.error();
        mirrors_ = *layers;
    }
    for (const Plan::View& view : light_.glass) {
        const Result<GlassSeen> seen = glassFrom(view, in_.glass, solids_);
        if (!seen) return seen.error();
        for (const Tint& tint : light) {
            const auto through = [&](const Start& start) { return trace(view, tint, *seen, start); };
            if (Status s = carry(view.eye, light_.within, through); !s) return s;
        }
    }
    for (const Plan::View& view : light_.mirrors) {
        const Result<MirrorsSeen> seen = mirrorsFrom(view.eye);
        if (!seen) return seen.error();
        const Result<MirrorLayers> layers = layersOf(view);
        if (!layers) return layers.error();
        mirrors_ = *layers;
        const auto off = [&](const Start& start) { return reflect(view, *seen, start); };
        if (Status s = carry(view.eye, 0, off); !s) return s;
    }
    if (isInPicture()) return drawLines(sum);
    if (Status s = deposit(); !s) return s;
    return in_.surface ? lookUp(map(), sum) : Status(Done{});
}

} // namespace lucent::caustics
