#include "techniques/throughput/Throughput.h"

#include "diffusion/Profile.h"
#include "shaders/throughput/Blocks.h"
#include "techniques/throughput/BakeFile.h"
#include "views/Paint.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace lucent::throughput {

using graph::Format;
using graph::TextureId;

namespace {

constexpr int kTexelsOfPixel = 4;    // are interpolated where a view shows an atlas
constexpr int kMostTexels = 1 << 22; // of occlusion at once: 64 MiB

TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
    return graph.import(texture.handle(), texture.desc(), texture.label());
}

// Scaled already: turned and moved.
mat4 worldFromBody(const scene::Object& object) {
    scene::Transform transform = object.transform;
    transform.scale = 1;
    return transform.worldFromObject();
}

// Whether a picture asks for less of an atlas than all of it.
bool seesFew(const Bake& bake, ivec2 picture) {
    const int side = bake.surface.texels.side;
    return bake.options.local == Local::Live && kTexelsOfPixel * picture.x * picture.y <= side * side;
}

SpreadBlock spreadBlock(const Bake& bake, const Settings& settings) {
    return {.radius = bake.radius,
            .cut = bake.cut,
            .local = settings.part == Part::Global ? 0.0f : 1.0f,
            .global = settings.part == Part::Local ? 0.0f : 1.0f};
}

} // namespace

bool bakes(const scene::Object& object) {
    return object.visible && !object.isField() && scene::isPrecomputed(object);
}

std::optional<std::string> need(const scene::Scene& scene) {
    for (const scene::Object& object : scene.objects)
        if (bakes(object)) return "subsurface scattering of object \"" + object.name + "\" is precomputed";
    return std::nullopt;
}

namespace {

using Made = std::shared_ptr<const Bake>;
// What it was made of, and the file that holds it.
using MadeOf = std::pair<BakeKey, decltype(scene::Object::bake)>;
MadeOf keptKey(const scene::Object& object, const BakeOptions& options) {
    return {keyOf(object, options, DipoleGeometry::Planar), object.bake};
}

} // namespace

bool isBaked(const scene::Object& object, const BakeOptions& options) {
    return object.bake || object.kept.find<Made>(keptKey(object, options));
}

void keepBake(const scene::Object& object, const BakeOptions& options, std::shared_ptr<const Bake> made) {
    object.kept.keep(keptKey(object, options), Made(std::move(made)));
}

namespace {
Result<Made> bakeOf(const scene::Object& object, const BakeOptions& options, const MadeOf& key) {
    if (const Made* made = object.kept.find<Made>(key)) return *made;
    Result<Bake> made = object.bake ? decodeBake(*object.bake, object.bakeFile, key.first)
                                    : bake(object, options, DipoleGeometry::Planar);
    if (!made)
        return Error{"objects." + object.name + (object.bake ? ".bake: " : ": ") + made.error().message,
                     made.error().fault};
    return object.kept.keep(key, Made(std::make_shared<const Bake>(std::move(*made))));
}
} // namespace

Result<std::shared_ptr<const Bake>> bakeOf(const scene::Object& object, const BakeOptions& options) {
    return bakeOf(object, options, keptKey(object, options));
}

// --- onto the GPU

namespace {
// Of objects that are made of the same, one is worked out.
Result<Made> bakeOnce(const scene::Object& object, const BakeOptions& options,
                      std::vector<std::pair<MadeOf, Made>>& known) {
    const MadeOf key = keptKey(object, options);
    const auto same =
        std::find_if(known.begin(), known.end(), [&](const auto& one) { return one.first == key; });
    if (same != known.end()) {
        if (!object.kept.find<Made>(key)) object.kept.keep(key, same->second);
        return same->second;
    }
    Result<Made> made = bakeOf(object, options, key);
    if (made) known.emplace_back(key, *made);
    return made;
}
} // namespace

Status Throughput::prepare(const std::vector<views::DrawnMesh>& meshes, const Settings& settings) {
    std::map<int, Body> before = std::exchange(bodies_, {});
    std::vector<std::pair<MadeOf, Made>> known;
    for (const views::DrawnMesh& mesh : meshes) {
        const Result<Made> bake = bakeOnce(*mesh.object, optionsOf(settings), known);
        if (!bake) return bake.error();
        Body body;
        if (const auto own = before.find(mesh.index); own != before.end()) body = std::move(own->second);
        if (!body.baked || body.baked->bake != *bake) {
            Result<std::shared_ptr<const BakeTextures>> baked = texturesOf(*bake, before);
            if (!baked)
                return Error{"objects." + mesh.object->name + ": " + baked.error().message,
                             baked.error().fault};
            body.baked = std::move(*baked);
            const graph::TextureDesc desc{.size = body.baked->place.desc().size, .format = Format::RGBA32F};
            for (graph::Texture& entered : body.entered)
                entered = graph::Texture(context_.device(), desc, "throughput.entered");
        }
        bodies_.emplace(mesh.index, std::move(body));
    }
    return Done{};
}

Result<std::shared_ptr<const BakeTextures>> Throughput::texturesOf(const std::shared_ptr<const Bake>& bake,
                                                                   const std::map<int, Body>& before) {
    for (const std::map<int, Body>* bodies : {&before, &std::as_const(bodies_)})
        for (const auto& [index, body] : *bodies)
            if (body.baked && body.baked->bake == bake) return body.baked;
    return upload(context_, bake);
}

// --- light

Status Throughput::addTo(graph::FrameGraph& graph, const Arriving& in, const views::DrawnMesh& mesh,
                         Body& body, const Settings& settings) {
    const ivec2 size = body.baked->place.desc().size;
    const TextureId place = import(graph, body.baked->place), frame = import(graph, body.baked->frame);
    TextureId surface, places;
    const gl::Program* placing = context_.program("throughput/place");
    graph.addPass("throughput.place", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("where the texels of object \"" + mesh.object->name + "\" lie");
        pass.sample(place);
        pass.sample(frame);
        surface = pass.createColor("throughput.surface", {.size = size, .format = Format::RGBA32F});
        places = pass.createColor("throughput.places", {.size = size, .format = Format::RGBA32F});
        pass.clear(surface, vec4(0));
        pass.clear(places, vec4(0));
        const PlaceBlock block{.worldFromBody = worldFromBody(*mesh.object), .object = mesh.index};
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = placing,
                           .block = block,
                           .textures = {{"uPlace", resources[place]}, {"uFrame", resources[frame]}}});
        };
    });
    const views::LitView view{.eye = in.eye,
                              .size = size,
                              .surface = surface,
                              .places = places,
                              .extent = body.baked->bake->surface.texels.size};
    const Result<TextureId> flux = in.fluxOn ? in.fluxOn(view) : TextureId{};
    if (!flux) return flux.error();
    const int most =
        std::clamp(4 * (kMostTexels / (size.x * size.y)), 4, views::mostSamplesAtOnce(context_, size));
    for (int first = in.first; first == in.first || first < in.end; first += most) {
        const int end = std::min(in.end, first + most);
        const auto from = std::size_t(first), count = std::size_t(end - first);
        Result<views::Occlusion> occlusion =
            views::recordOcclusion(graph, context_, view, in.samples.subspan(from, count),
                                   in.shadows.subspan(from - std::size_t(in.first), count));
        if (!occlusion) return occlusion.error();
        std::vector<std::string> defines = occlusion->defines();
        if (first > 0) defines.push_back("USE_SUM");
        const TextureId carried = first == in.first ? *flux : TextureId{};
        if (carried) defines.push_back("USE_FLUX");
        if (settings.fresnel == Fresnel::Schlick) defines.push_back("SCHLICK");
        const gl::Program* program = context_.program("throughput/enter", defines);
        const TextureId before = first > 0 ? import(graph, body.entered[body.now]) : TextureId{};
        body.now = 1 - body.now;
        const TextureId sum = import(graph, body.entered[body.now]);
        graph.keep(sum);
        const ThroughputEnterBlock block{
            .size = size,
            .ior = in.irradiance ? 1 : mesh.object->material.translucent().surfaceIor(),
            .firstLight = first,
            .endLight = end,
            .columns = occlusion->columns};
        graph.addPass("throughput.enter", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("the illumination map of object \"" + mesh.object->name + "\"");
            for (const TextureId id : {surface, places, in.table, occlusion->texture, before, carried})
                if (id) pass.sample(id);
            pass.write(sum);
            pass.clear(sum, vec4(0));
            return [=, table = in.table, shade = occlusion->texture](const graph::Resources& resources,
                                                                     graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                     {"uPlaces", resources[places]},
                                                     {"uLights", resources[table]}};
                if (shade) textures.push_back({"uOcclusion", resources[shade]});
                if (before) textures.push_back({"uEntered", resources[before]});
                if (carried) textures.push_back({"uFlux", resources[carried]});
                commands.draw({.program = program, .block = block, .textures = textures});
            };
        });
    }
    return Done{};
}

Status Throughput::light(graph::FrameGraph& graph, const Arriving& in,
                         const std::vector<views::DrawnMesh>& meshes, const Settings& settings) {
    for (const views::DrawnMesh& mesh : meshes)
        if (const auto body = bodies_.find(mesh.index); body != bodies_.end())
            if (Status s = addTo(graph, in, mesh, body->second, settings); !s) return s;
    mirrors_ = in.mirrors && in.placed > 0;
    if (mirrors_ && in.first < in.placed) mirror(graph, in, meshes);
    return Done{};
}

void Throughput::mirror(graph::FrameGraph& graph, const Arriving& in,
                        const std::vector<views::DrawnMesh>& meshes) {
    std::vector<std::string> defines;
    if (in.occlusion->texture) defines.push_back("USE_OCCLUSION");
    if (in.first > 0) defines.push_back("USE_SUM");
    const gl::Program* program = context_.program("throughput/mirror", defines);
    const TextureId before = in.first > 0 ? import(graph, mirrored_[mirroredNow_]) : TextureId{};
    mirroredNow_ = 1 - mirroredNow_;
    graph::Texture& target = mirrored_[mirroredNow_];
    const graph::TextureDesc desc{.size = in.size, .format = Format::RGBA32F};
    if (!target || target.desc() != desc)
        target = graph::Texture(context_.device(), desc, "throughput.mirrored");
    const TextureId sum = import(graph, target);
    graph.keep(sum);
    std::vector<graph::Block> blocks;
    for (const views::DrawnMesh& mesh : meshes) {
        const scene::Translucent& inside = mesh.object->material.translucent();
        if (inside.roughness == 0) continue; // points of lamps have no size
        blocks.push_back(ThroughputMirrorBlock{.view = views::viewBlock(in.eye, in.size),
                                               .ior = inside.surfaceIor(),
                                               .roughness = inside.roughness,
                                               .object = mesh.index,
                                               .firstLight = in.first,
                                               .endLight = std::min(in.end, in.placed),
                                               .columns = in.occlusion->columns});
    }
    graph.addPass("throughput.mirror", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what precomputed objects mirror of lamps");
        for (const TextureId id : {in.surface, in.table, in.occlusion->texture, before})
            if (id) pass.sample(id);
        pass.write(sum);
        pass.clear(sum, vec4(0));
        return [=, surface = in.surface, table = in.table,
                shade = in.occlusion->texture](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uLights", resources[table]}};
            if (shade) textures.push_back({"uOcclusion", resources[shade]});
            if (before) textures.push_back({"uMirrored", resources[before]});
            for (const graph::Block& block : blocks)
                commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
}

// --- what leaves

TextureId Throughput::multiply(graph::FrameGraph& graph, const Matrix& matrix, TextureId vector,
                               TextureId sum, const char* reason) {
    const gl::Program* program = context_.program(
        "throughput/product", sum ? std::vector<std::string>{"USE_SUM"} : std::vector<std::string>{});
    const TextureId starts = import(graph, matrix.starts), entries = import(graph, matrix.entries);
    TextureId product;
    graph.addPass("throughput.product", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        for (const TextureId id : {starts, entries, vector, sum})
            if (id) pass.sample(id);
        product =
            pass.createColor("throughput.vector", {.size = listSize(std::size_t(matrix.rows), kVectorWidth),
                                                   .format = Format::RGBA32F});
        pass.clear(product, vec4(0));
        return [=, block = ProductBlock{.rows = matrix.rows}](const graph::Resources& resources,
                                                              graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uStarts", resources[starts]},
                                                 {"uEntries", resources[entries]},
                                                 {"uVector", resources[vector]}};
            if (sum) textures.push_back({"uSum", resources[sum]});
            commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return product;
}

// What leaves at the vertices of light that entered far away.
TextureId Throughput::carried(graph::FrameGraph& graph, const Body& body) {
    const TextureId entered = import(graph, body.entered[body.now]);
    const TextureId lit = multiply(graph, body.baked->duals, entered, {}, "irradiance of the vertices");
    TextureId vertices = multiply(graph, body.baked->close, lit, {}, "what vertices leave at each other");
    if (body.baked->inner.rows > 0) {
        const TextureId moments =
            multiply(graph, body.baked->inner, lit, {}, "sums over vertices for far ones");
        vertices = multiply(graph, body.baked->outer, moments, vertices, "what they leave there");
    }
    if (body.baked->direct.rows > 0)
        vertices =
            multiply(graph, body.baked->direct, entered, vertices, "what texels leave at their vertices");
    return vertices;
}

TextureId Throughput::spread(graph::FrameGraph& graph, const Body& body, const Settings& settings) {
    const TextureId vertices = carried(graph, body), entered = import(graph, body.entered[body.now]);
    const bool isLive = body.baked->bake->options.local == Local::Live;
    const gl::Program* program = context_.program("throughput/spread", {isLive ? "LIVE" : "STORED"});
    const TextureId place = import(graph, body.baked->place), frame = import(graph, body.baked->frame),
                    corners = import(graph, body.baked->corners);
    TextureId near, reach, filters, leaving;
    if (isLive) {
        near = import(graph, body.baked->near);
        reach = import(graph, body.baked->reach);
    } else {
        filters = import(graph, body.baked->filters);
    }
    const SpreadBlock block = spreadBlock(*body.baked->bake, settings);
    graph.addPass("throughput.spread", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what leaves at the texels: of close light and of far");
        for (const TextureId id : {entered, vertices, place, frame, corners, near, reach, filters})
            if (id) pass.sample(id);
        leaving = pass.createColor("throughput.leaving",
                                   {.size = body.baked->place.desc().size, .format = Format::RGBA32F});
        pass.clear(leaving, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uEntered", resources[entered]},
                                                 {"uFrame", resources[frame]},
                                                 {"uCorners", resources[corners]},
                                                 {"uVertices", resources[vertices]}};
            if (near)
                textures.insert(
                    textures.end(),
                    {{"uPlace", resources[place]}, {"uNear", resources[near]}, {"uReach", resources[reach]}});
            if (filters) textures.push_back({"uFilters", resources[filters]});
            commands.draw({.program = program, .block = block, .textures = textures});
        };
    });
    return leaving;
}

// What leaves only where a view shows the body: kernels of few pixels in place of those of all texels.
TextureId Throughput::spreadSeen(graph::FrameGraph& graph, const Shown& in, const views::DrawnMesh& mesh,
                                 const Body& body, const Settings& settings) {
    const BakeTextures& baked = *body.baked;
    const TextureId vertices = carried(graph, body), entered = import(graph, body.entered[body.now]);
    const std::vector<TextureId> places = seen(graph, in, mesh, baked, {}, vertices);
    const TextureId place = import(graph, baked.place), near = import(graph, baked.near),
                    reach = import(graph, baked.reach);
    const gl::Program* program = context_.program("throughput/spread_seen");
    TextureId leaving;
    graph.addPass("throughput.spread", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what leaves there: of close light and of far");
        for (const TextureId id : {entered, place, near, reach, places[0], places[1], places[2]})
            pass.sample(id);
        leaving = pass.createColor("throughput.leaving", {.size = in.size, .format = Format::RGBA32F});
        pass.clear(leaving, vec4(0));
        return [=, block = spreadBlock(*baked.bake, settings)](const graph::Resources& resources,
                                                               graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uEntered", resources[entered]},
                                        {"uPlace", resources[place]},
                                        {"uNear", resources[near]},
                                        {"uReach", resources[reach]},
                                        {"uPosition", resources[places[0]]},
                                        {"uFar", resources[places[1]]},
                                        {"uAt", resources[places[2]]}}});
        };
    });
    return leaving;
}

// What is shown of a body's light, in its atlas.
TextureId Throughput::lightOf(graph::FrameGraph& graph, const Body& body, bool isIrradiance,
                              const Settings& settings) {
    if (isIrradiance || settings.part == Part::Illumination) return import(graph, body.entered[body.now]);
    return spread(graph, body, settings);
}

void Throughput::recordAtlases(graph::FrameGraph& graph, ivec2 size, TextureId target,
                               const Settings& settings) {
    const int columns = int(std::ceil(std::sqrt(double(bodies_.size()) * size.x / std::max(size.y, 1))));
    const int rows = (int(bodies_.size()) + columns - 1) / std::max(columns, 1);
    std::vector<std::pair<TextureId, AtlasBlock>> atlases;
    for (auto& [index, body] : bodies_) {
        const int number = int(atlases.size());
        const ivec2 cell(size.x / columns, size.y / rows);
        const int side = std::min(cell.x, cell.y);
        const ivec2 middle = cell * ivec2(number % columns, rows - 1 - number / columns) + cell / 2;
        atlases.emplace_back(lightOf(graph, body, false, settings),
                             AtlasBlock{.corner = middle - side / 2, .side = side});
    }
    const gl::Program* program = context_.program("throughput/atlas");
    graph.addPass("throughput.atlas", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("view.show asks for \"atlas\"");
        for (const auto& [light, block] : atlases)
            pass.sample(light);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const auto& [light, block] : atlases)
                commands.draw(
                    {.program = program, .block = block, .textures = {{"uLight", resources[light]}}});
        };
    });
}

// The triangles of a body in a view.
std::vector<TextureId> Throughput::seen(graph::FrameGraph& graph, const Shown& in,
                                        const views::DrawnMesh& mesh, const BakeTextures& baked,
                                        TextureId image, TextureId vertices) {
    const TextureId source = image ? image : vertices;
    const gl::Program* program = context_.program(
        "throughput/seen", image ? std::vector<std::string>{} : std::vector<std::string>{"PLACES"});
    const TextureId triangles = import(graph, baked.triangles), charts = import(graph, baked.charts);
    std::vector<TextureId> seen(image ? 1 : 3);
    graph.addPass("throughput.seen", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the atlas of object \"" + mesh.object->name + "\" as the camera sees it");
        for (const TextureId id : {source, triangles, charts})
            pass.sample(id);
        for (TextureId& color : seen) {
            color = pass.createColor("throughput.seen", {.size = in.size, .format = Format::RGBA32F});
            pass.clear(color, vec4(0));
        }
        pass.clear(pass.createDepth("throughput.depth", in.size), 1.0f);
        const SeenBlock block{.clipFromBody = in.eye.clipFromWorld * worldFromBody(*mesh.object)};
        return [=, name = image ? "uLeaving" : "uVertices",
                corners = baked.cornerCount()](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .vertices = corners,
                           .depthTest = graph::DepthTest::Less,
                           .block = block,
                           .textures = {{"uTriangles", resources[triangles]},
                                        {"uCharts", resources[charts]},
                                        {name, resources[source]}}});
        };
    });
    return seen;
}

Status Throughput::record(graph::FrameGraph& graph, const Shown& in,
                          const std::vector<views::DrawnMesh>& meshes, const Settings& settings) {
    const bool isIrradiance = in.scene.view.show == scene::Aov::Irradiance;
    const bool isColor = in.scene.view.show == scene::Aov::Color;
    const TextureId mirrored = isColor && mirrors_ ? import(graph, mirrored_[mirroredNow_]) : TextureId{};
    const bool hasSky = isColor && in.environment != graph::TextureHandle::None;
    std::vector<std::string> defines;
    if (!isColor) defines.push_back("SHOW_RADIOSITY");
    if (mirrored) defines.push_back("USE_LAMPS");
    if (hasSky) defines.push_back("USE_SKY");
    const bool isEntering = isIrradiance || settings.part == Part::Illumination;
    std::vector<views::DrawnMesh> painted;
    for (const views::DrawnMesh& mesh : meshes)
        if (mesh.paint && !isEntering) painted.push_back(mesh);
    Result<TextureId> paint = TextureId{};
    if (!painted.empty()) paint = views::recordLeaving(graph, context_, in.eye, painted, in.size);
    if (!paint) return paint.error();
    for (const views::DrawnMesh& mesh : meshes) {
        const auto found = bodies_.find(mesh.index);
        if (found == bodies_.end()) continue;
        const Body& body = found->second;
        const TextureId shown =
            !isEntering && seesFew(*body.baked->bake, in.size)
                ? spreadSeen(graph, in, mesh, body, settings)
                : seen(graph, in, mesh, *body.baked, lightOf(graph, body, isIrradiance, settings), {})[0];
        const float ior = mesh.object->material.translucent().surfaceIor();
        ThroughputShadeBlock block{.view = views::viewBlock(in.eye, in.size),
                                   .ior = ior,
                                   .roughness = mesh.object->material.translucent().roughness,
                                   .mean = float(diffusion::meanTransmittance(double(ior))),
                                   .object = mesh.index};
        if (hasSky) {
            block.mapFromWorld = mat4(glm::transpose(rotationFromDegrees(in.scene.environment->rotation)));
            block.intensity = in.scene.environment->intensity;
        }
        const bool isPainted = mesh.paint && !isEntering;
        std::vector<std::string> own = defines;
        if (isPainted) own.push_back("PAINTED");
        const gl::Program* shading = context_.program("throughput/shade", own);
        graph.addPass("throughput.shade", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("what object \"" + mesh.object->name + "\" sends to the eye" +
                        (hasSky ? "; it mirrors the environment past everything" : ""));
            pass.sample(in.surface);
            pass.sample(shown);
            if (mirrored) pass.sample(mirrored);
            if (isPainted) pass.sample(*paint);
            pass.write(in.target);
            return [=, surface = in.surface, environment = in.environment,
                    paint = *paint](const graph::Resources& resources, graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                     {"uSeen", resources[shown]}};
                if (isPainted) textures.push_back({"uPaint", resources[paint]});
                if (mirrored) textures.push_back({"uMirrored", resources[mirrored]});
                if (hasSky) textures.push_back({"uEnvironment", environment});
                commands.draw({.program = shading, .block = block, .textures = textures});
            };
        });
    }
    return Done{};
}

std::map<std::string, std::size_t> Throughput::bytes() const {
    std::map<std::string, std::size_t> bytes;
    const auto add = [&](const graph::Texture& texture) {
        if (texture) bytes[texture.label()] += texture.desc().bytes();
    };
    for (const graph::Texture& texture : mirrored_)
        add(texture);
    std::set<const BakeTextures*> bakes;
    for (const auto& [index, body] : bodies_) {
        add(body.entered[0]);
        add(body.entered[1]);
        if (bakes.insert(body.baked.get()).second) body.baked->addBytes(bytes);
    }
    return bytes;
}

} // namespace lucent::throughput
