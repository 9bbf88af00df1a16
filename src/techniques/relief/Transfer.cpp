#include "techniques/relief/Transfer.h"

#include "light/EnvironmentLights.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace lucent::relief {

using graph::Format;
using graph::TextureDesc;

namespace {

constexpr int kCells = 1024;   // about as many parts of the sphere does the basis tell apart
constexpr int kSamples = 1024; // texels of which the basis is learned
constexpr int kTile = 64;      // texels a side
constexpr int kBlocksPerRow = 16, kBlockRows = kSensors / 4 / kBlocksPerRow;
constexpr int kSmallLights = 16384;
constexpr std::size_t kMostBytes = std::size_t(128) << 20; // of coefficients
constexpr double kStepMs = 40;
constexpr ivec2 kGlossSize{64, 32};

// Texels of the transfer: the field's own, or fewer where their coefficients would not fit.
ivec2 gridFor(ivec2 texels, int terms) {
    const double bytes = double(texels.x) * texels.y * terms * 2;
    const double shrink = std::min(1.0, std::sqrt(double(kMostBytes) / bytes));
    return glm::max(ivec2(1), ivec2(glm::dvec2(texels) * shrink));
}

int columnsFor(ivec2 grid, int images, int largest) {
    const int most = std::max(1, largest / grid.x);
    return std::min(most, std::max(1, int(std::ceil(std::sqrt(double(images) * grid.y / grid.x)))));
}

int roundUp(int value, int step) { return (value + step - 1) / step * step; }

Image directionTable(const std::vector<vec3>& cells, const std::vector<vec3>& sensors) {
    std::vector<views::LampPoint> lights;
    const auto add = [&](vec3 direction) {
        lights.push_back({.place = vec4(direction, 0), .color = vec3(1), .source = {}});
    };
    for (vec3 direction : cells)
        add(direction);
    lights.resize(std::size_t(roundUp(int(cells.size()), 4)), lights.back());
    for (vec3 direction : sensors)
        add(direction);
    return views::sampleTable(lights);
}

// Falloff as the shader has it (lib/shading.glsl), for tables that are made here.
float falloff(float x, vec2 range) {
    if (range.y <= range.x) return x >= range.x ? 1.0f : 0.0f;
    return std::clamp((x - range.x) / (range.y - range.x), 0.0f, 1.0f);
}

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

double transferRays(ivec2 texels, int terms) {
    const ivec2 grid = gridFor(texels, roundUp(terms, 4));
    return double(grid.x) * grid.y * kSensors + double(kSamples) * (kCells + kSensors);
}

std::vector<SmallLight> smallLights(const scene::Scene& scene, const Settings& settings) {
    std::vector<SmallLight> lights;
    const float share = Relief::shareOfLight(scene);
    for (const views::EnvironmentLight& light : views::environmentLights(*scene.environment, kSmallLights))
        // Irradiance over pi, as every light counts: 4 pi times the weight is a solid angle.
        lights.push_back({light.direction,
                          4 * light.weight * (settings.normalise ? share : 1) * light.radiance,
                          light.weight * share});
    return lights;
}

Transfer::Key Transfer::keyOf(const scene::Object& object, const Settings& settings) {
    return {object.field().heights,     object.field().width,
            object.field().heightScale, object.material.relief().depth / object.transform.scale,
            settings.attenuation,       roundUp(settings.terms, 4)};
}

Transfer::Transfer(gl::Context& context, Key key)
    : context_(context), key_(std::move(key)), grid_(gridFor(key_.heights->size(), key_.terms)),
      cells_(kCells) {}

// --- tracing once

// The sample is about 6 tiles' worth of rays.
float Transfer::share() const {
    const int all = tiles().x * tiles().y, sampleTiles = 6;
    if (ready()) return 1;
    if (phase_ == Phase::Sample) return float(sampleTiles * row_) / float(kSamples * (all + sampleTiles));
    return (float(sampleTiles + tile_) + float(row_) / kBlockRows) / float(all + sampleTiles);
}

ivec2 Transfer::tiles() const { return (grid_ + kTile - 1) / kTile; }

Status Transfer::step(graph::TexturePool& pool, const views::DrawnField& drawn) {
    const double before = now();
    const int rows = rowsAtOnce_;
    const Status done = phase_ == Phase::Sample ? sample(pool, drawn) : trace(pool, drawn);
    const double took = now() - before;
    rowsAtOnce_ = std::max(1, int(std::min(double(rows) * 4, rows * kStepMs / std::max(took, 0.1))));
    return done;
}

Status Transfer::run(graph::TexturePool& pool, const char* name, const graph::Texture& target,
                     const std::function<void(graph::Commands&)>& draw) {
    graph::FrameGraph graph;
    const graph::TextureId id = graph.import(target.handle(), target.desc(), target.label());
    graph.keep(id);
    graph.addPass(name, [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("transfer of a height field, once for all environments");
        pass.write(id);
        return [&draw](const graph::Resources&, graph::Commands& commands) { draw(commands); };
    });
    if (Status compiled = graph.compile(); !compiled) return compiled;
    graph.execute(pool);
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    context_.device().wait(target.handle());
    return Done{};
}

// Rows of d for scattered texels; when all are there, the basis is learned from them.
Status Transfer::sample(graph::TexturePool& pool, const views::DrawnField& drawn) {
    const gl::Program* program = context_.program("relief/trace", {"SCATTERED"});
    gl::Device& device = context_.device();
    const int padded = roundUp(cells_.count(), 4);
    if (!directions_) {
        const Image table = directionTable(cells_.directions(), spiral(kSensors));
        directions_ =
            graph::Texture(device, {.size = table.size(), .format = Format::RGBA32F}, "relief.directions");
        device.upload(directions_.handle(), 0, table.pixels);
        sampled_ =
            graph::Texture(device, {.size = {(padded + kSensors) / 4, kSamples}, .format = Format::RGBA32F},
                           "relief.sampled");
    }
    const int rows = std::min(rowsAtOnce_, kSamples - row_);
    ReliefBlock block = makeBlock(drawn, {.attenuation = key_.attenuation});
    block.specular.a = key_.depth;
    std::vector<graph::Binding> textures = drawn.heights->bindings();
    textures.push_back({"uLights", directions_.handle()});
    const Status drawnRows = run(pool, "relief.sample", sampled_, [&](graph::Commands& commands) {
        commands.draw({.program = program,
                       .region = {0, row_, sampled_.desc().size.x, rows},
                       .block = block,
                       .textures = textures});
    });
    if (!drawnRows) return drawnRows;
    row_ += rows;
    if (row_ < kSamples) return Done{};

    basis_.learn(device.read(sampled_.handle()), cells_.count(), padded, kSensors, key_.terms);
    sampled_ = graph::Texture();
    const int images = basis_.terms() / 4;
    const int columns = columnsFor(grid_, images, context_.caps().maxTextureSize);
    const ivec2 size = grid_ * ivec2(columns, (images + columns - 1) / columns);
    if (size.y > context_.caps().maxTextureSize)
        return Error{"relief.transfer: " + std::to_string(size.x) + "x" + std::to_string(size.y) +
                         " texels of coefficients; this GPU's textures have at most " +
                         std::to_string(context_.caps().maxTextureSize) + " a side: choose fewer terms",
                     Fault::Machine};
    coefficients_ = graph::Texture(device, {.size = size, .format = Format::RGBA16F}, "relief.coefficients");
    const ivec2 tile = glm::min(grid_, ivec2(kTile));
    traced_ =
        graph::Texture(device, {.size = tile * ivec2(kBlocksPerRow, kBlockRows), .format = Format::RGBA16F},
                       "relief.traced");
    phase_ = Phase::Trace;
    row_ = 0;
    rowsAtOnce_ = 1;
    return Done{};
}

// d of a tile's texels in the sensor directions, then their coefficients.
Status Transfer::trace(graph::TexturePool& pool, const views::DrawnField& drawn) {
    const gl::Program* program = context_.program("relief/trace");
    const ivec2 tile = glm::min(grid_, ivec2(kTile));
    const ivec2 corner = tile * ivec2(tile_ % tiles().x, tile_ / tiles().x);
    const int rows = std::min(rowsAtOnce_, kBlockRows - row_);
    ReliefBlock block = makeBlock(drawn, {.attenuation = key_.attenuation});
    block.specular.a = key_.depth;
    block.firstLight = roundUp(cells_.count(), 4);
    block.tile = ivec4(corner, tile);
    block.grid = grid_;
    std::vector<graph::Binding> textures = drawn.heights->bindings();
    textures.push_back({"uLights", directions_.handle()});
    const Status traced = run(pool, "relief.trace", traced_, [&](graph::Commands& commands) {
        commands.draw({.program = program,
                       .region = {0, row_ * tile.y, traced_.desc().size.x, rows * tile.y},
                       .block = block,
                       .textures = textures});
    });
    if (!traced) return traced;
    row_ += rows;
    if (row_ < kBlockRows) return Done{};

    if (Status projected = project(pool, corner); !projected) return projected;
    row_ = 0;
    if (++tile_ == tiles().x * tiles().y) {
        phase_ = Phase::Ready;
        traced_ = graph::Texture();
        directions_ = graph::Texture();
    }
    return Done{};
}

Status Transfer::project(graph::TexturePool& pool, ivec2 corner) {
    const gl::Program* program = context_.program("relief/project");
    const ivec2 tile = glm::min(grid_, ivec2(kTile));
    const int columns = coefficients_.desc().size.x / grid_.x;
    const ivec2 size = glm::min(tile, grid_ - corner);
    return run(pool, "relief.project", coefficients_, [&](graph::Commands& commands) {
        for (int image = 0; image < basis_.terms() / 4; ++image) {
            const ivec2 at = corner + grid_ * ivec2(image % columns, image / columns);
            ProjectBlock block;
            for (int sensor = 0; sensor < kSensors; ++sensor)
                for (int i = 0; i < 4; ++i)
                    block.fit[std::size_t(sensor)][i] = basis_.fit(4 * image + i, sensor);
            block.tile = ivec4(at, tile);
            commands.draw({.program = program,
                           .region = ivec4(at, size),
                           .block = block,
                           .textures = {{"uTraced", traced_.handle()}}});
        }
    });
}

// --- any environment

std::vector<Transfer::CellLight> Transfer::cellLights(const std::vector<SmallLight>& lights,
                                                      const mat3& objectFromWorld) const {
    std::vector<CellLight> list;
    list.reserve(lights.size());
    for (SmallLight light : lights) {
        light.direction = objectFromWorld * light.direction;
        list.push_back({light, cells_.cellOf(light.direction)});
    }
    return list;
}

std::vector<vec4> Transfer::fluxOf(const std::vector<CellLight>& lights, const scene::Material& material,
                                   vec3 view) const {
    std::vector<vec4> flux(std::size_t(cells_.count()), vec4(0));
    const float kf = material.relief().forwardScatter;
    for (const auto& [light, cell] : lights) {
        const float f =
            kf > 0 ? falloff(glm::dot(view, light.direction), material.relief().scatterFalloff) : 0;
        flux[std::size_t(cell)] += vec4(((1 - kf) + kf * f) * light.color, light.weight);
    }
    return flux;
}

void Transfer::setEnvironment(const scene::Object& object, const std::vector<SmallLight>& lights,
                              const std::vector<vec3>& views, float error) {
    const auto inCells = cellLights(lights, glm::transpose(rotationFromDegrees(object.transform.rotate)));
    const std::size_t nodes = object.material.relief().forwardScatter == 0 ? 1 : views.size();
    light_.assign(nodes * kMostTerms, vec4(0));
    termsUsed_ = basis_.terms();
    for (std::size_t node = 0; node < nodes; ++node) {
        // The middle of the field says how many terms are needed.
        const bool measures = error > 0 && node == nodes / 2;
        const Projection projection = basis_.project(fluxOf(inCells, object.material, views[node]), measures);
        std::copy(projection.light.begin(), projection.light.end(),
                  light_.begin() + std::ptrdiff_t(kMostTerms * node));
        if (!measures) continue;
        const auto good = std::find_if(projection.errors.begin(), projection.errors.end() - 1,
                                       [&](float e) { return e <= error; });
        termsUsed_ = 4 * int(good - projection.errors.begin()) + 4;
    }
    if (nodes > 1) {
        const TextureDesc desc{.size = {kMostTerms, int(nodes)}, .format = Format::RGBA32F};
        if (!nodes_) nodes_ = graph::Texture(context_.device(), desc, "relief.nodes");
        context_.device().upload(nodes_.handle(), 0, light_);
    }
    drawGloss(object.material, inCells);
}

Result<graph::TextureId> Transfer::recordIrradiance(graph::FrameGraph& graph) const {
    const bool oneView = light_.size() == kMostTerms;
    const gl::Program* program = context_.program(
        "relief/gather", oneView ? std::vector<std::string>{} : std::vector<std::string>{"USE_NODES"});
    GatherBlock block{};
    if (oneView) std::copy(light_.begin(), light_.end(), block.light.begin());
    block.size = grid_;
    block.terms = termsUsed_;
    block.columns = coefficients_.desc().size.x / grid_.x;
    const graph::TextureId source =
        graph.import(coefficients_.handle(), coefficients_.desc(), coefficients_.label());
    graph::TextureId target;
    graph.addPass("relief.gather", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the environment's light on each texel from " + std::to_string(termsUsed_) +
                    " coefficients");
        pass.sample(source);
        target = pass.createColor("relief.irradiance", {.size = grid_, .format = Format::RGBA32F});
        return [=, nodes = nodes_.handle()](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uCoefficients", resources[source]}};
            if (!oneView) textures.push_back({"uNodes", nodes});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return target;
}

// Stays black where nothing shines: the light pass then does not look.
void Transfer::drawGloss(const scene::Material& material, const std::vector<CellLight>& lights) {
    if (!gloss_)
        gloss_ = graph::Texture(context_.device(), {.size = kGlossSize, .format = Format::RGBA32F},
                                "relief.gloss");
    if (material.relief().specularity == 0) return;
    Image table(kGlossSize.x, kGlossSize.y, 4);
    const std::vector<vec4> flux = fluxOf(lights, scene::Material{}, vec3(0));
    for (int y = 0; y < kGlossSize.y; ++y) {
        for (int x = 0; x < kGlossSize.x; ++x) {
            const float azimuth = 2 * kPi * ((float(x) + 0.5f) / float(kGlossSize.x) - 0.5f);
            const float z = 2 * (float(y) + 0.5f) / float(kGlossSize.y) - 1;
            const float radius = std::sqrt(1 - z * z);
            const vec3 r(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
            vec3 sum(0);
            for (std::size_t i = 0; i < flux.size(); ++i)
                sum += falloff(glm::dot(r, cells_.directions()[i]), material.relief().specularFalloff) *
                       vec3(flux[i]);
            std::copy_n(&sum[0], 3, table.at(x, y));
        }
    }
    context_.device().upload(gloss_.handle(), 0, table.pixels);
}

} // namespace lucent::relief
