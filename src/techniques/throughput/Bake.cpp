#include "techniques/throughput/Bake.h"

#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::throughput {

namespace {

constexpr double kCutSpacings = 1.5; // of vertices: what these carry is linear between them
constexpr double kMostRadius = 15;   // texels

double extentOf(const scene::Mesh& mesh, float scale) {
    vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    for (const vec3& p : mesh.positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return mesh.positions.empty() ? 0 : 1.001 * double(scale) * glm::length(glm::dvec3(high - low));
}

std::vector<vec3> positionsOf(const Surface& surface) {
    std::vector<vec3> positions;
    for (const Texel& texel : surface.texels.list)
        positions.push_back(positionAt(surface.hats, texel.place));
    return positions;
}
std::vector<vec3> normalsOf(const Surface& surface) {
    std::vector<vec3> normals;
    for (const Texel& texel : surface.texels.list)
        normals.push_back(normalAt(surface.hats, texel.place));
    return normals;
}

void addSums(Stages& stages, double share, const FactorRows& rows, std::size_t count,
             std::vector<vec3>& sums) {
    sums.assign(count, vec3(0));
    stages.forEach(share, count, [&rows, count, &sums](std::size_t j) {
        std::vector<vec3> row(count);
        rows.fill(std::uint32_t(j), row);
        dvec3 sum(0);
        for (const vec3& factor : row)
            sum += dvec3(factor);
        sums[j] = vec3(sum);
    });
}

template <class Value>
void addProduct(const Rows<Value>& rows, std::span<const vec3> by, std::vector<vec3>& sums) {
    for (std::size_t j = 0; j < rows.count(); ++j)
        for (std::uint32_t k = rows.starts[j]; k < rows.starts[j + 1]; ++k)
            sums[j] += rows.values[k] * by[rows.columns[k]];
}

} // namespace

std::vector<vec3> Bake::vertexIrradiance(std::span<const vec3> irradiance) const {
    std::vector<vec3> sums(surface.hats.count(), vec3(0));
    addProduct(surface.duals, irradiance, sums);
    return sums;
}

std::vector<vec3> Bake::vertexRadiosity(std::span<const vec3> irradiance) const {
    std::vector<vec3> radiosity = factors.product(vertexIrradiance(irradiance));
    if (options.local == Local::Stored) addProduct(filters.direct, irradiance, radiosity);
    return radiosity;
}

vec3 Bake::globalAt(std::size_t texel, std::span<const vec3> vertexRadiosity) const {
    const Place& place = surface.texels.list[texel].place;
    vec3 sum(0);
    for (int k = 0; k < 3; ++k)
        sum += place.weights[k] * vertexRadiosity[surface.hats.triangles[place.triangle][std::size_t(k)]];
    return sum;
}

vec3 Bake::filteredAt(std::size_t texel, std::span<const vec3> irradiance) const {
    constexpr int kRadius = Filters::kRadius;
    std::size_t number = texel * std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth);
    vec3 sum(0);
    for (int y = -kRadius; y <= kRadius; ++y)
        for (int x = -kRadius; x <= kRadius; ++x, ++number) {
            const int from = surface.texels.find(surface.texels.list[texel].at + ivec2(x, y));
            if (from >= 0) sum += filters.factors[number] * irradiance[std::size_t(from)];
        }
    return sum;
}

Lit Bake::relight(std::span<const vec3> irradiance) const {
    const std::size_t count = surface.texels.list.size();
    const std::vector<vec3> vertices = vertexRadiosity(irradiance);
    Lit lit{std::vector<vec3>(count), std::vector<vec3>(count)};
    for (std::size_t to = 0; to < count; ++to)
        lit.global[to] = globalAt(to, vertices);
    if (options.local == Local::Stored) {
        for (std::size_t to = 0; to < count; ++to)
            lit.local[to] = filteredAt(to, irradiance);
        return lit;
    }
    gather(irradiance, lit.local);
    return lit;
}

// Light that each texel gets of texels around, by the near part: shares of its reach.
void Bake::gather(std::span<const vec3> irradiance, std::vector<vec3>& lit) const {
    const Response response(medium, 2.0 * double(cut), double(cut));
    const std::vector<vec3> positions = positionsOf(surface), normals = normalsOf(surface);
    const std::vector<Texel>& texels = surface.texels.list;
    Stages stages;
    stages.forEach(1, texels.size(), [&](std::size_t to) {
        if (!texels[to].isShown) return;
        vec3 sum(0), weights(0);
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x) {
                const int from = surface.texels.find(texels[to].at + ivec2(x, y));
                if (from < 0) continue;
                const auto at = std::size_t(from);
                const vec3 weight =
                    texels[at].area * response.near(positions[at], normals[at], positions[to]);
                sum += weight * irradiance[at];
                weights += weight;
            }
        lit[to] = reach[to] * sum / glm::max(weights, vec3(1e-30f));
    });
    (void)stages.finish(); // adding up does not fail
}

std::size_t Bake::bytes() const { return factors.bytes() + filters.bytes() + surface.duals.bytes(); }

// What the stages of a bake work on.
struct BakeMaking::State {
    std::shared_ptr<const scene::Mesh> mesh;
    float scale;
    double extent;
    Bake baked;
    std::optional<Response> response;
    std::optional<FactorRows> rows;
    std::vector<vec3> whole; // of Stored: sums of rows with the diagonal
    // Of Stored: what leaves of even light.
    struct Even {
        Response split, all;
        FactorRows rows;
        std::vector<vec3> positions, normals, ones, vertices, far;
        Even(const Medium& medium, double extent, double cut, const Surface& surface,
             const FactorOptions& options)
            : split(medium, extent, cut), all(medium, extent, 0), rows(surface.hats, split, options),
              positions(positionsOf(surface)), normals(normalsOf(surface)),
              ones(surface.texels.list.size(), vec3(1)) {}
    };
    std::optional<Even> even;
    Stages stages; // ends before what it works on

    State(std::shared_ptr<const scene::Mesh> of, float metres, const Medium& medium,
          const BakeOptions& options, int threads)
        : mesh(std::move(of)), scale(metres), extent(extentOf(*mesh, scale)), stages(threads) {
        baked.options = options;
        baked.medium = medium;
        baked.radius = Filters::kRadius;
        if (options.local == Local::Live)
            layLive(0, Filters::kRadius);
        else
            layStored();
    }

    // As wide as texels of 7 x 7 at least; the border must be one texel wider for what is read between
    // texels.
    void layLive(int attempt, int radius) {
        addSurface(stages, mesh, scale, baked.options.side, radius + 1,
                   [this, attempt, radius](Result<Surface> surface) -> Status {
                       if (!surface && attempt == 0) return surface.error();
                       if (surface) { // else no room for borders so wide: light is left less far
                           baked.surface = std::move(*surface);
                           baked.radius = radius;
                           const double spacings = kCutSpacings * baked.surface.hats.spacing();
                           const double wanted = std::ceil(spacings / double(baked.surface.texels.size));
                           const int next = int(std::clamp(wanted, double(Filters::kRadius), kMostRadius));
                           if (next > radius && attempt < 3) {
                               layLive(attempt + 1, next);
                               return Done{};
                           }
                       }
                       fillLive();
                       return Done{};
                   });
    }

    void fillLive() {
        baked.cut = (float(baked.radius) + 0.5f) * baked.surface.texels.size;
        response.emplace(baked.medium, extent, double(baked.cut));
        rows.emplace(baked.surface.hats, *response, baked.options.factors);
        addFactors(stages, 0.7, *rows, baked.surface.hats, baked.options.factors, baked.factors);
        const std::vector<Texel>& texels = baked.surface.texels.list;
        baked.reach.assign(texels.size(), vec3(0));
        stages.forEach(0.3, texels.size(), [this, &texels](std::size_t i) {
            if (texels[i].isShown) baked.reach[i] = rows->nearAround(texels[i].place);
        });
    }

    void layStored() {
        // The fit looks one texel beyond the filter, and so do those that read between texels.
        addSurface(stages, mesh, scale, baked.options.side, Filters::kRadius + 2,
                   [this](Result<Surface> surface) -> Status {
                       if (!surface) return surface.error();
                       baked.surface = std::move(*surface);
                       fillStored();
                       return Done{};
                   });
    }

    void fillStored() {
        const Hats& hats = baked.surface.hats;
        response.emplace(baked.medium, extent, 0);
        FactorOptions options = baked.options.factors;
        options.diagonal = baked.options.blend == Blend::None;
        rows.emplace(hats, *response, options);
        addFactors(stages, 0.5, *rows, hats, options, baked.factors);
        if (baked.options.blend == Blend::None) {
            addPlainFilters(stages, 0.5, baked.surface, *response, baked.filters);
            return;
        }
        options.diagonal = true;
        const auto all = std::make_shared<const FactorRows>(hats, *response, options);
        addSums(stages, 0.1, *all, hats.count(), whole);
        stages.then([this, all]() -> Status { // the last that needs them
            addFittedFilters(stages, 0.2, baked.surface, *response, *rows, baked.factors, whole,
                             baked.filters);
            stages.then([this]() -> Status {
                evenStored();
                return Done{};
            });
            return Done{};
        });
    }

    // Ours: each filter takes what the fit left wrong of even light, by the shares of K in it. What leaves
    // of even light is known by the split response, whose far part is linear between vertices.
    void evenStored() {
        const Surface& surface = baked.surface;
        const double cut = std::max(kCutSpacings * surface.hats.spacing(), 3.5 * double(surface.texels.size));
        even.emplace(baked.medium, extent, cut, surface, baked.options.factors);
        addSums(stages, 0.1, even->rows, surface.hats.count(), even->far);
        even->vertices = baked.vertexRadiosity(even->ones);
        stages.forEach(0.1, even->ones.size(), [this](std::size_t to) { evenStored(to); });
    }

    void evenStored(std::size_t to) {
        const std::vector<Texel>& texels = baked.surface.texels.list;
        if (!texels[to].isShown) return;
        const vec3 wanted = even->rows.nearAround(texels[to].place) + baked.globalAt(to, even->far) -
                            baked.filteredAt(to, even->ones) - baked.globalAt(to, even->vertices);
        constexpr int kRadius = Filters::kRadius;
        std::array<vec3, std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth)> shares{};
        std::size_t number = 0;
        vec3 sum(0);
        for (int y = -kRadius; y <= kRadius; ++y)
            for (int x = -kRadius; x <= kRadius; ++x, ++number) {
                const int from = baked.surface.texels.find(texels[to].at + ivec2(x, y));
                if (from < 0) continue;
                const auto at = std::size_t(from);
                shares[number] = texels[at].area *
                                 even->all.whole(even->positions[at], even->normals[at], even->positions[to]);
                sum += shares[number];
            }
        for (std::size_t k = 0; k < shares.size(); ++k)
            for (int c = 0; c < 3; ++c)
                if (sum[c] > 0)
                    baked.filters.factors[to * shares.size() + k][c] += wanted[c] * shares[k][c] / sum[c];
    }
};

BakeMaking::BakeMaking(std::shared_ptr<const scene::Mesh> mesh, float scale, const Medium& medium,
                       const BakeOptions& options, int threads)
    : state_(std::make_unique<State>(std::move(mesh), scale, medium, options, threads)) {}
BakeMaking::~BakeMaking() = default;

std::optional<Result<Bake>> BakeMaking::advance(double ms) {
    const Result<bool> done = state_->stages.advance(ms);
    if (!done) return Result<Bake>(done.error());
    if (!*done) return std::nullopt;
    return Result<Bake>(std::move(state_->baked));
}

double BakeMaking::share() const { return state_->stages.share(); }

Result<Bake> BakeMaking::finish() {
    if (Status done = state_->stages.finish(); !done) return done.error();
    return std::move(state_->baked);
}

} // namespace lucent::throughput
