#include "techniques/throughput/Bake.h"

#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lucent::throughput {

namespace {

constexpr double kCutSpacings = 1.5; // of vertices: what these carry is linear between them
constexpr int kMostRadius = 15;      // texels

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

// Light that each texel gets of texels around, by the near part.
template <class Irradiance>
std::vector<vec3> gathered(const Surface& surface, const Response& response, int radius, const Work& work,
                           Status& status, const Irradiance& irradiance) {
    const std::vector<Texel>& texels = surface.texels.list;
    const std::vector<vec3> positions = positionsOf(surface), normals = normalsOf(surface);
    std::vector<vec3> sums(texels.size(), vec3(0));
    status = forEach(texels.size(), work, [&](std::size_t to) {
        if (!texels[to].isShown) return;
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x) {
                const int from = surface.texels.find(texels[to].at + ivec2(x, y));
                if (from < 0) continue;
                const auto at = std::size_t(from);
                sums[to] += texels[at].area * irradiance(at) *
                            response.near(positions[at], normals[at], positions[to]);
            }
    });
    return sums;
}

std::vector<vec3> sumsOf(const FactorRows& rows, std::size_t count, const Work& work, Status& status) {
    std::vector<vec3> sums(count);
    status = forEach(count, work, [&](std::size_t j) {
        std::vector<vec3> row(count);
        rows.fill(std::uint32_t(j), row);
        dvec3 sum(0);
        for (const vec3& factor : row)
            sum += dvec3(factor);
        sums[j] = vec3(sum);
    });
    return sums;
}

Status bakeLive(Bake& baked, const scene::Mesh& mesh, float scale, double extent, const Work& work) {
    // As wide as texels of 7 x 7 at least; the border must be one texel wider for what is read between
    // texels.
    int radius = Filters::kRadius;
    for (int attempt = 0; attempt < 4; ++attempt) {
        Result<Surface> surface = surfaceOf(mesh, scale, baked.options.side, radius + 1);
        if (!surface && attempt == 0) return surface.error();
        if (!surface) { // no room for borders so wide: texels leave their light less far
            radius = baked.radius;
            break;
        }
        baked.surface = std::move(*surface);
        baked.radius = radius;
        const double wanted = kCutSpacings * baked.surface.hats.spacing() / double(baked.surface.texels.size);
        const int next = std::clamp(int(std::ceil(wanted)), Filters::kRadius, kMostRadius);
        if (next <= radius) break;
        radius = next;
    }
    baked.cut = (float(radius) + 0.5f) * baked.surface.texels.size;
    const Response response(baked.medium, extent, double(baked.cut));
    const FactorRows rows(baked.surface.hats, response, baked.options.factors);
    Result<Factors> factors =
        factorsOf(rows, baked.surface.hats, baked.options.factors, partOf(work, 0, 0.7));
    if (!factors) return factors.error();
    baked.factors = std::move(*factors);
    Status done = Done{};
    baked.evened = gathered(baked.surface, response, radius, partOf(work, 0.7, 0.8), done,
                            [](std::size_t) { return 1.0f; });
    if (!done) return done;
    return forEach(baked.evened.size(), partOf(work, 0.8, 1), [&](std::size_t i) {
        vec3& found = baked.evened[i];
        if (!baked.surface.texels.list[i].isShown) return;
        const vec3 wanted = rows.nearAround(baked.surface.texels.list[i].place);
        for (int c = 0; c < 3; ++c)
            found[c] = found[c] > 0 ? wanted[c] / found[c] : 1;
    });
}

// Ours: each filter takes what the fit left wrong of even light, by the shares of K in it. What leaves of
// even light is known by the split response, whose far part is linear between vertices.
Status evenOut(Bake& baked, double extent, const Work& work) {
    const Surface& surface = baked.surface;
    const std::vector<Texel>& texels = surface.texels.list;
    const double cut = std::max(kCutSpacings * surface.hats.spacing(), 3.5 * double(surface.texels.size));
    const Response split(baked.medium, extent, cut), whole(baked.medium, extent, 0);
    const FactorRows rows(surface.hats, split, baked.options.factors);
    Status summed = Done{};
    const std::vector<vec3> far = sumsOf(rows, surface.hats.count(), partOf(work, 0, 0.5), summed);
    if (!summed) return summed;
    const Lit even = baked.relight(std::vector<vec3>(texels.size(), vec3(1)));
    const std::vector<vec3> positions = positionsOf(surface), normals = normalsOf(surface);
    return forEach(texels.size(), partOf(work, 0.5, 1), [&](std::size_t to) {
        if (!texels[to].isShown) return;
        const Place& place = texels[to].place;
        vec3 wanted = rows.nearAround(place) - even.local[to] - even.global[to], sum(0);
        for (int k = 0; k < 3; ++k)
            wanted += place.weights[k] * far[surface.hats.triangles[place.triangle][std::size_t(k)]];
        constexpr int kRadius = Filters::kRadius;
        std::array<vec3, std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth)> shares{};
        std::size_t number = 0;
        for (int y = -kRadius; y <= kRadius; ++y)
            for (int x = -kRadius; x <= kRadius; ++x, ++number) {
                const int from = surface.texels.find(texels[to].at + ivec2(x, y));
                if (from < 0) continue;
                const auto at = std::size_t(from);
                shares[number] = texels[at].area * whole.whole(positions[at], normals[at], positions[to]);
                sum += shares[number];
            }
        for (std::size_t k = 0; k < shares.size(); ++k)
            for (int c = 0; c < 3; ++c)
                if (sum[c] > 0)
                    baked.filters.factors[to * shares.size() + k][c] += wanted[c] * shares[k][c] / sum[c];
    });
}

Status bakeStored(Bake& baked, const scene::Mesh& mesh, float scale, double extent, const Work& work) {
    baked.radius = Filters::kRadius;
    // The fit looks one texel beyond the filter, and so do those that read between texels.
    Result<Surface> surface = surfaceOf(mesh, scale, baked.options.side, Filters::kRadius + 2);
    if (!surface) return surface.error();
    baked.surface = std::move(*surface);
    const Hats& hats = baked.surface.hats;
    const Response response(baked.medium, extent, 0);
    FactorOptions options = baked.options.factors;
    options.diagonal = true;
    const FactorRows all(hats, response, options);
    options.diagonal = baked.options.blend == Blend::None;
    const FactorRows rows(hats, response, options);
    Result<Factors> factors = factorsOf(rows, hats, options, partOf(work, 0, 0.5));
    if (!factors) return factors.error();
    baked.factors = std::move(*factors);
    if (baked.options.blend == Blend::None) {
        Result<Filters> filters = plainFilters(baked.surface, response, partOf(work, 0.5, 1));
        if (!filters) return filters.error();
        baked.filters = std::move(*filters);
        return Done{};
    }
    Status summed = Done{};
    const std::vector<vec3> whole = sumsOf(all, hats.count(), partOf(work, 0.5, 0.6), summed);
    if (!summed) return summed;
    Result<Filters> filters =
        fittedFilters(baked.surface, response, rows, baked.factors, whole, partOf(work, 0.6, 0.8));
    if (!filters) return filters.error();
    baked.filters = std::move(*filters);
    return evenOut(baked, extent, partOf(work, 0.8, 1));
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

Lit Bake::relight(std::span<const vec3> irradiance) const {
    const std::vector<Texel>& texels = surface.texels.list;
    std::vector<vec3> vertices = factors.product(vertexIrradiance(irradiance));
    if (options.local == Local::Stored) addProduct(filters.direct, irradiance, vertices);
    Lit lit{std::vector<vec3>(texels.size(), vec3(0)), std::vector<vec3>(texels.size(), vec3(0))};
    for (std::size_t to = 0; to < texels.size(); ++to) {
        const Place& place = texels[to].place;
        for (int k = 0; k < 3; ++k)
            lit.global[to] +=
                place.weights[k] * vertices[surface.hats.triangles[place.triangle][std::size_t(k)]];
    }
    if (options.local == Local::Live) {
        const Response response(medium, 2.0 * double(cut), double(cut));
        Status done = Done{};
        lit.local =
            gathered(surface, response, radius, {}, done, [&](std::size_t i) { return irradiance[i]; });
        for (std::size_t to = 0; to < texels.size(); ++to)
            lit.local[to] *= evened[to];
        return lit;
    }
    std::size_t number = 0;
    for (std::size_t to = 0; to < texels.size(); ++to)
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x, ++number) {
                const int from = surface.texels.find(texels[to].at + ivec2(x, y));
                if (from >= 0) lit.local[to] += filters.factors[number] * irradiance[std::size_t(from)];
            }
    return lit;
}

std::size_t Bake::bytes() const { return factors.bytes() + filters.bytes() + surface.duals.bytes(); }

Result<Bake> bake(const scene::Mesh& mesh, float scale, const Medium& medium, const BakeOptions& options,
                  const Work& work) {
    Bake baked;
    baked.options = options;
    baked.medium = medium;
    const double extent = extentOf(mesh, scale);
    const Status done = options.local == Local::Live ? bakeLive(baked, mesh, scale, extent, work)
                                                     : bakeStored(baked, mesh, scale, extent, work);
    if (!done) return done.error();
    return baked;
}

} // namespace lucent::throughput
