#include "techniques/subsurface/Volume.h"

#include "base/Log.h"
#include "light/ShadowMap.h"
#include "shaders/subsurface/Blocks.h"
#include "techniques/subsurface/Entering.h"

#include <algorithm>
#include <cmath>

namespace lucent::subsurface {

using graph::Format;
using graph::TextureId;

namespace {

constexpr int kDepths = 4;         // shaders/subsurface/volume_source.vert
constexpr double kUnsolved = 1e-3; // what is left of the first error
constexpr double kWidestCell = 4;  // mean free paths

// 2 A of the mixed condition phi = 2 A D dphi/dn, by what the boundary mirrors of the fluence and of the flux
// of light that is even but for a drift (Haskell et al. 1994, eq. 2.3.5 to 2.3.7).
double mixedCondition(double ior) {
    constexpr int kSteps = 1024;
    double ofFluence = 0, ofFlux = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double inside = (i + 0.5) / kSteps; // cosine
        const double square = 1 - (1 - inside * inside) * ior * ior;
        const double mirrored = square > 0 ? 1 - diffusion::transmittedShare(std::sqrt(square), ior) : 1;
        ofFluence += 2 * inside * mirrored / kSteps;
        ofFlux += 3 * inside * inside * mirrored / kSteps;
    }
    return 2 * (1 + ofFlux) / (1 - ofFluence);
}

// Looks along an axis at all cells and so much more around them.
views::Eye eyeAlong(const Cells& cells, int axis, float around = 0) {
    const vec3 extent = vec3(cells.count) * cells.width;
    views::Eye eye;
    eye.forward[axis] = 1;
    eye.right[(axis + 1) % 3] = 1;
    eye.up[(axis + 2) % 3] = 1;
    eye.halfExtent = vec2(extent[(axis + 1) % 3], extent[(axis + 2) % 3]) / 2.0f + around;
    eye.position = cells.low + (eye.right * extent + eye.up * extent) / 2.0f;
    eye.nearest = 0;
    eye.farthest = extent[axis];
    mat4 clip(0);
    for (int i = 0; i < 3; ++i) {
        clip[i][0] = eye.right[i] / eye.halfExtent.x;
        clip[i][1] = eye.up[i] / eye.halfExtent.y;
        clip[i][2] = 2 * eye.forward[i] / eye.farthest;
    }
    clip[3] = vec4(-glm::dot(eye.position, eye.right) / eye.halfExtent.x,
                   -glm::dot(eye.position, eye.up) / eye.halfExtent.y,
                   -2 * glm::dot(eye.position, eye.forward) / eye.farthest - 1, 1);
    eye.clipFromWorld = clip;
    return eye;
}

std::vector<graph::Binding> columnBindings(const graph::Resources& resources,
                                           const std::array<TextureId, 3>& along) {
    return {
        {"uAlongX", resources[along[0]]}, {"uAlongY", resources[along[1]]}, {"uAlongZ", resources[along[2]]}};
}

// Four points along a cell: with two the lattice shows where light grazes the surface.
Grid gridOf(const Cells& cells, const gl::Context& context) {
    return {.pixel = cells.width / 4, .levels = 1, .most = context.caps().maxTextureSize};
}

// The passes of one body.
class Body {
public:
    Body(graph::FrameGraph& graph, gl::Context& context, const Inputs& in, const Plan::State::Object& plan,
         const views::DrawnMesh& mesh, const Entering& entering, const Settings& settings, Volumes& volumes)
        : graph_(graph), context_(context), in_(in), plan_(plan), mesh_(mesh), entering_(entering),
          settings_(settings), bounds_(views::boundsOf(*mesh.object)),
          cells_(cellsOf(bounds_, settings.cells)), solution_(volumes.of(plan.index, key())) {}

    Status record(TextureId target);

private:
    std::optional<Volumes::Key> key() const;
    VolumeBlock block() const;
    graph::TextureDesc imageDesc(Format format) const {
        return {.size = cells_.imageSize(), .format = format};
    }
    Status columns(int axis);
    Status cut();
    Status bind();
    Status lay(const Points& points);
    Status light();
    void warnOfCells(const std::array<diffusion::Medium, 3>& media) const;
    Status solve();
    TextureId kept(graph::Texture& texture, const char* label);
    Status leave(TextureId target);

    graph::FrameGraph& graph_;
    gl::Context& context_;
    const Inputs& in_;
    const Plan::State::Object& plan_;
    const views::DrawnMesh& mesh_;
    const Entering& entering_;
    const Settings& settings_;
    const views::Bounds bounds_;
    const Cells cells_;
    const std::shared_ptr<Volumes::Solution> solution_;
    std::array<TextureId, 3> along_;
    TextureId cell_, faces_, lower_, upper_, diagonal_, source_, fluence_;
};

std::optional<Volumes::Key> Body::key() const {
    if (!entering_.key()) return std::nullopt;
    return Volumes::Key{*entering_.key(), diffusion::mediaOf(mesh_.object->material), settings_.cells};
}

VolumeBlock Body::block() const {
    const scene::Material& material = mesh_.object->material;
    const auto media = diffusion::mediaOf(material);
    VolumeBlock block{.view = views::viewBlock(in_.eye, in_.size),
                      .low = vec4(cells_.low, cells_.width),
                      .cells = ivec4(cells_.count, cells_.across),
                      .layers = ivec4(plan_.layers[0], plan_.layers[1], plan_.layers[2], 0)};
    for (int c = 0; c < 3; ++c) {
        const diffusion::Medium& medium = media[std::size_t(c)];
        block.diffusion[c] = float(1 / (3 * medium.extinction() * cells_.width));
        block.absorption[c] = float(medium.absorption * cells_.width);
        block.extinction[c] = float(medium.extinction());
        block.albedo[c] = float(medium.albedo());
    }
    block.diffusion.a = float(mixedCondition(material.translucent().ior));
    block.extinction.a = material.translucent().ior;
    block.albedo.a = (block.extinction.r + block.extinction.g + block.extinction.b) / 3;
    block.object = mesh_.index;
    return block;
}

Status Body::columns(int axis) {
    // A line a pixel, half a cell apart, the first and the last on the outermost edges.
    const views::Eye eye = eyeAlong(cells_, axis, cells_.width / 4);
    const ivec2 size = 2 * ivec2(cells_.count[(axis + 1) % 3], cells_.count[(axis + 2) % 3]) + 1;
    // Lines beside those that were counted may still hit the two sides of a sheet that is thinner than a
    // pixel.
    const int count = std::max(2, plan_.layers[std::size_t(axis)]);
    const TextureId images =
        graph_.create("subsurface.columns", {.size = size, .format = Format::RGBA32F, .layers = count});
    TextureId before;
    for (int layer = 0; layer < count; ++layer) {
        const gl::Program* program =
            context_.program("subsurface/volume_column",
                             before ? std::vector<std::string>{} : std::vector<std::string>{"PEEL_FIRST"});
        const TextureId last = before;
        graph_.addPass("subsurface.column", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("surface " + std::to_string(layer + 1) + " of object \"" + mesh_.object->name +
                        "\" along " + "xyz"[axis]);
            mesh_.sampleFrom(pass);
            if (last) pass.sample(last);
            pass.write(images, layer);
            pass.clear(images, vec4(0));
            before = pass.createColor("subsurface.columned", {.size = size, .format = Format::RG32F});
            pass.clear(before, vec4(0));
            pass.clear(pass.createDepth("subsurface.depth", size, Format::Depth32F), 1.0f);
            return [=, mesh = mesh_](const graph::Resources& resources, graph::Commands& commands) {
                graph::Draw draw{.depthTest = graph::DepthTest::Less};
                if (last) draw.textures.push_back({"uBefore", resources[last]});
                drawMesh(commands, *program, resources, mesh, eye, size, mesh.index, std::move(draw));
            };
        });
    }
    along_[std::size_t(axis)] = images;
    return Done{};
}

// What of each cell lies inside.
Status Body::cut() {
    for (int axis = 0; axis < 3; ++axis)
        if (Status s = columns(axis); !s) return s;
    const gl::Program* program = context_.program("subsurface/volume_cells");
    graph_.addPass("subsurface.cells", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("cells of object \"" + mesh_.object->name + "\", cut by its surface");
        for (const TextureId id : along_)
            pass.sample(id);
        pass.write(cell_ = kept(solution_->cells, "subsurface.cells"));
        faces_ = pass.createColor("subsurface.faces", imageDesc(Format::RGBA32F));
        return [block = block(), along = along_, program](const graph::Resources& resources,
                                                          graph::Commands& commands) {
            commands.draw({.program = program, .block = block, .textures = columnBindings(resources, along)});
        };
    });
    return Done{};
}

Status Body::bind() {
    const gl::Program* program = context_.program("subsurface/volume_bind");
    graph_.addPass("subsurface.bind", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("how cells give each other light, and the world outside");
        pass.sample(cell_);
        pass.sample(faces_);
        lower_ = pass.createColor("subsurface.lower", imageDesc(Format::RGBA32F));
        upper_ = pass.createColor("subsurface.upper", imageDesc(Format::RGBA32F));
        diagonal_ = pass.createColor("subsurface.diagonal", imageDesc(Format::RGBA32F));
        return [block = block(), cell = cell_, faces = faces_, program](const graph::Resources& resources,
                                                                        graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uCell", resources[cell]}, {"uFaces", resources[faces]}}});
        };
    });
    return Done{};
}

Status Body::lay(const Points& points) {
    const gl::Program* program = context_.program("subsurface/volume_source");
    const Level& level = points.front();
    graph_.addPass("subsurface.source", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("where light that entered object \"" + mesh_.object->name + "\" first scatters");
        for (const TextureId id : {level.place, level.flux, level.normal, cell_})
            pass.sample(id);
        if (source_) {
            pass.write(source_);
        } else {
            const bool whole = context_.caps().floatBlend;
            source_ =
                pass.createColor("subsurface.source", imageDesc(whole ? Format::RGBA32F : Format::RGBA16F));
            pass.clear(source_, vec4(0));
        }
        VolumeBlock block = this->block();
        block.columns = level.size.x;
        return [level, block, cell = cell_, program](const graph::Resources& resources,
                                                     graph::Commands& commands) {
            commands.draw({.program = program,
                           .vertices = 2 * kDepths * level.size.x * level.size.y,
                           .topology = graph::Topology::Points,
                           .blend = graph::Blend::Add,
                           .block = block,
                           .textures = {{"uPlace", resources[level.place]},
                                        {"uFlux", resources[level.flux]},
                                        {"uNormal", resources[level.normal]},
                                        {"uCell", resources[cell]}}});
        };
    });
    return Done{};
}

Status Body::light() {
    const Grid grid = gridOf(cells_, context_);
    const Cut cut{mesh_, grid, true, in_.pictureOf};
    if (const LitBody* body = entering_.of(plan_.index)) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const LitLayer& layer : body->layers[axis]) {
                Result<Points> points = recordLayer(graph_, context_, plan_.axes[axis], cut, layer);
                if (!points) return points.error();
                if (Status s = lay(*points); !s) return s;
            }
        return Done{};
    }
    for (const views::LampPoint& lamp : entering_.samples()) {
        if (lamp.color == vec3(0)) continue;
        const views::ShadowViews views =
            views::shadowViews(lamp.source, boundsOfAll(in_.casters), bounds_, 2 * settings_.cells);
        for (const views::Eye& face : views.faces) {
            Result<Points> points = recordLit(graph_, context_, lamp, face, cut, in_.casters);
            if (!points) return points.error();
            if (Status s = lay(*points); !s) return s;
        }
    }
    return Done{};
}

// Light of such cells is lost: next to a boundary it changes within a mean free path.
void Body::warnOfCells(const std::array<diffusion::Medium, 3>& media) const {
    double paths = 0;
    for (const diffusion::Medium& medium : media)
        paths = std::max(paths, double(cells_.width) * medium.extinction());
    if (paths > kWidestCell)
        warnOnce("subsurface: object \"" + mesh_.object->name + "\" is cut into cells " +
                 std::to_string(std::llround(paths)) +
                 " mean free paths wide, which lose light; more cells are nearer, and method multires has "
                 "none");
}

Status Body::solve() {
    const std::array<diffusion::Medium, 3> media = diffusion::mediaOf(mesh_.object->material);
    warnOfCells(media);
    const Rounds rounds = roundsOf(media, cells_);
    const dvec3 squares = rounds.radius * rounds.radius;
    dvec3 omega(1);
    TextureId before;
    for (int round = 0; round < rounds.count; ++round) {
        const char* const variants[] = {"STEP_FIRST", "STEP_SECOND"};
        const gl::Program* program =
            context_.program("subsurface/volume_step", round < 2 ? std::vector<std::string>{variants[round]}
                                                                 : std::vector<std::string>{});
        if (round > 0) omega = round == 1 ? 2.0 / (2.0 - squares) : 1.0 / (1.0 - squares * omega / 4.0);
        const TextureId now = fluence_;
        graph_.addPass("subsurface.diffuse", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("light on its way through the cells, round " + std::to_string(round + 1) + " of " +
                        std::to_string(rounds.count));
            for (const TextureId id : {diagonal_, source_})
                pass.sample(id);
            if (round > 0)
                for (const TextureId id : {lower_, upper_, now})
                    pass.sample(id);
            if (round > 1) pass.sample(before);
            const bool last = round + 1 == rounds.count;
            if (last)
                pass.write(fluence_ = kept(solution_->fluence, "subsurface.fluence"));
            else
                fluence_ = pass.createColor("subsurface.fluence", imageDesc(Format::RGBA32F));
            VolumeBlock block = this->block();
            block.omega = vec4(vec3(omega), 0);
            return [=, lower = lower_, upper = upper_, diagonal = diagonal_, source = source_,
                    solution = solution_](const graph::Resources& resources, graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uDiagonal", resources[diagonal]},
                                                     {"uSource", resources[source]}};
                if (round > 0)
                    textures.insert(textures.end(), {{"uLower", resources[lower]},
                                                     {"uUpper", resources[upper]},
                                                     {"uNow", resources[now]}});
                if (round > 1) textures.push_back({"uBefore", resources[before]});
                commands.draw({.program = program, .block = block, .textures = std::move(textures)});
                if (last) solution->solved = true;
            };
        });
        before = now;
    }
    return Done{};
}

Status Body::leave(TextureId target) {
    const gl::Program* program = context_.program("subsurface/volume_leave");
    graph_.addPass("subsurface.leave", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("what leaves object \"" + mesh_.object->name + "\" where the camera sees it");
        for (const TextureId id : {in_.surface, cell_, fluence_})
            pass.sample(id);
        pass.write(target);
        return [block = block(), surface = in_.surface, cell = cell_, fluence = fluence_,
                program](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uSurface", resources[surface]},
                                        {"uCell", resources[cell]},
                                        {"uFluence", resources[fluence]}}});
        };
    });
    return Done{};
}

// Outlives the graph.
TextureId Body::kept(graph::Texture& texture, const char* label) {
    if (!texture || texture.desc() != imageDesc(Format::RGBA32F))
        texture = graph::Texture(context_.device(), imageDesc(Format::RGBA32F), label);
    const TextureId id = graph_.import(texture.handle(), texture.desc(), texture.label());
    if (!solution_->solved) graph_.keep(id);
    return id;
}

Status Body::record(TextureId target) {
    if (solution_->solved) {
        cell_ = kept(solution_->cells, "subsurface.cells");
        fluence_ = kept(solution_->fluence, "subsurface.fluence");
        return leave(target);
    }
    if (Status s = cut(); !s) return s;
    if (Status s = bind(); !s) return s;
    if (Status s = light(); !s) return s;
    if (!source_) return Done{}; // no light meets it
    if (Status s = solve(); !s) return s;
    return leave(target);
}

} // namespace

Cells cellsOf(const views::Bounds& body, int along) {
    const vec3 extent = glm::max(body.high - body.low, vec3(1e-9f));
    Cells cells;
    // A third of a cell less than fits: no side of a box then lies on the edges of cells, where lines may or
    // may not meet it.
    cells.width = std::max({extent.x, extent.y, extent.z}) / (float(std::max(2, along - 2)) - 0.3f);
    cells.count = glm::ivec3(glm::ceil(extent / cells.width)) + 2;
    cells.low = body.center() - 0.5f * vec3(cells.count) * cells.width;
    cells.across =
        std::max(1, int(std::ceil(std::sqrt(double(cells.count.z) * cells.count.y / cells.count.x))));
    return cells;
}

Rounds roundsOf(const std::array<diffusion::Medium, 3>& media, const Cells& cells) {
    Rounds rounds;
    for (int c = 0; c < 3; ++c) {
        const diffusion::Medium& medium = media[std::size_t(c)];
        const double width = cells.width, strength = 1 / (3 * medium.extinction()), link = strength / width;
        const double twoA = mixedCondition(medium.ior);
        // The body's slowest mode fades no slower than that of its box, widened to where light would be 0.
        double slowest = medium.absorption;
        for (int axis = 0; axis < 3; ++axis) {
            const double extent = cells.count[axis] * width + 2 * twoA * strength;
            slowest += strength * glm::pi<double>() * glm::pi<double>() / (extent * extent);
        }
        const double most = 6 * std::max(link, 1 / twoA) + medium.absorption * width;
        const double radius = 1 - std::min(1.0, slowest * width / most);
        rounds.radius[c] = radius;
        const double omega = 2 / (1 + std::sqrt(1 - radius * radius));
        const double left = std::sqrt(std::max(omega - 1, 1e-12)); // of the error, a round
        const double needed = std::ceil(std::log(kUnsolved) / std::log(left)) + 2;
        rounds.count = std::max(rounds.count, int(std::min(needed, double(kMostRounds))));
    }
    return rounds;
}

std::array<views::Eye, 3> axesOf(const Cells& cells) {
    return {eyeAlong(cells, 0), eyeAlong(cells, 1), eyeAlong(cells, 2)};
}

ivec2 pixelsOf(const views::Eye& axis, const scene::Object& object, const Cells& cells,
               const gl::Context& context) {
    return pixelsOf(axis, object, gridOf(cells, context));
}

std::shared_ptr<Volumes::Solution> Volumes::of(int object, const std::optional<Key>& key) {
    std::shared_ptr<Solution>& solution = solutions_[object];
    if (!solution) solution = std::make_shared<Solution>();
    if (!key || solution->key != *key) solution->solved = false;
    if (key) solution->key = *key;
    return solution;
}

void Volumes::keepOnly(const std::vector<int>& objects) {
    std::erase_if(solutions_, [&](const auto& solution) {
        return std::find(objects.begin(), objects.end(), solution.first) == objects.end();
    });
}

Result<Radiosity> recordVolumes(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                const Plan::State& plan, const Entering& entering, const Settings& settings,
                                Volumes& volumes) {
    std::vector<int> indices;
    for (const Plan::State::Object& object : plan.objects)
        indices.push_back(object.index);
    volumes.keepOnly(indices);
    TextureId light;
    graph.addPass("subsurface.dark", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("before any light leaves there");
        light = pass.createColor("subsurface.radiosity", {.size = in.size, .format = Format::RGBA32F});
        pass.clear(light, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
    for (const Plan::State::Object& object : plan.objects)
        for (const views::DrawnMesh& mesh : in.solids)
            if (mesh.index == object.index)
                if (Status s =
                        Body(graph, context, in, object, mesh, entering, settings, volumes).record(light);
                    !s)
                    return s.error();
    return Radiosity{light, 1};
}

} // namespace lucent::subsurface
