#include "techniques/throughput/Blend.h"

#include <algorithm>
#include <cmath>

namespace lucent::throughput {

namespace {

constexpr int kBorder = Filters::kRadius + 1; // of 9 x 9

// What texels leave on others.
class Filtering {
public:
    Filtering(const Surface& surface, const Response& response) : surface_(surface), response_(response) {
        for (const Texel& texel : surface.texels.list) {
            positions_.push_back(positionAt(surface.hats, texel.place));
            normals_.push_back(normalAt(surface.hats, texel.place));
        }
    }
    std::size_t count() const { return positions_.size(); }
    /// K of a texel that is lit on another one.
    dvec3 factor(std::size_t lit, std::size_t to) const {
        return double(surface_.texels.list[lit].area) *
               dvec3(response_.whole(positions_[lit], normals_[lit], positions_[to]));
    }
    /// Calls with each texel at most so far away, and where it lies from here.
    template <class Work>
    void forEachAround(std::size_t texel, int radius, const Work& work) const {
        for (int y = -radius; y <= radius; ++y)
            for (int x = -radius; x <= radius; ++x) {
                const int other = surface_.texels.find(surface_.texels.list[texel].at + ivec2(x, y));
                if (other >= 0) work(std::size_t(other), ivec2(x, y));
            }
    }

private:
    const Surface& surface_;
    const Response& response_;
    std::vector<vec3> positions_, normals_;
};

std::size_t placeOf(ivec2 away) {
    return std::size_t((away.y + Filters::kRadius) * Filters::kWidth + away.x + Filters::kRadius);
}
constexpr std::size_t kFactors = std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth);

// Solves a symmetric positive definite system of three (Cholesky).
dvec3 solve(const std::array<dvec3, 3>& m, const dvec3& right) {
    const double a = std::sqrt(m[0][0]), b = m[1][0] / a, c = m[2][0] / a, d = std::sqrt(m[1][1] - b * b),
                 e = (m[2][1] - b * c) / d, f = std::sqrt(m[2][2] - c * c - e * e);
    const double x = right.x / a, y = (right.y - b * x) / d, z = (right.z - c * x - e * y) / f;
    const double w = z / f, v = (y - e * w) / d;
    return {(x - b * v - c * w) / a, v, w};
}

class Fitting {
public:
    Fitting(const Surface& surface, const Response& response, const FactorRows& rows, const Factors& factors,
            std::span<const vec3> whole)
        : surface_(surface), filtering_(surface, response), rows_(rows), whole_(whole),
          even_(factors.product(std::vector<vec3>(surface.hats.count(), vec3(1)))),
          known_(surface.hats.count()), exact_(surface.texels.list.size()) {
        for (std::uint32_t v = 0; v < surface.hats.count(); ++v)
            for (std::uint32_t k = surface.duals.starts[v]; k < surface.duals.starts[v + 1]; ++k)
                exact_[surface.duals.columns[k]].emplace_back(v, double(surface.duals.values[k]));
    }

    void add(Stages& stages, double share, Filters& made) {
        stages.forEach(0.2 * share, known_.size(),
                       [this](std::size_t j) { known_[j] = rows_.close(std::uint32_t(j)); });
        made.factors.assign(filtering_.count() * kFactors, vec3(0));
        weights_.resize(filtering_.count());
        stages.forEach(0.8 * share, filtering_.count(),
                       [this, &made](std::size_t lit) { weights_[lit] = fit(lit, made.factors); });
        stages.then([this, &made]() -> Status {
            made.direct = directOf(weights_);
            return Done{};
        });
    }

private:
    const std::array<std::uint32_t, 3>& cornersOf(std::size_t texel) const {
        return surface_.hats.triangles[surface_.texels.list[texel].place.triangle];
    }
    vec3 weightsOf(std::size_t texel) const { return surface_.texels.list[texel].place.weights; }

    // Irradiance of vertices per irradiance of a texel.
    using Dual = std::pair<std::uint32_t, double>;
    std::vector<Dual> dualsOf(std::size_t texel) const {
        const Texel& of = surface_.texels.list[texel];
        std::vector<Dual> duals;
        if (of.own > 0.5f * of.area) {
            for (const Dual& dual : exact_[texel])
                duals.emplace_back(dual.first, dual.second * double(of.area / of.own));
            return duals;
        }
        for (int v = 0; v < 3; ++v) { // of another chart's surface: as at the middle
            const std::uint32_t vertex = cornersOf(texel)[std::size_t(v)];
            duals.emplace_back(vertex, 3 / surface_.hats.areas[vertex] *
                                           (4 * double(of.place.weights[v]) - 1) * double(of.area));
        }
        return duals;
    }
    static double dualOf(const std::vector<Dual>& duals, std::uint32_t vertex) {
        for (const auto& [known, dual] : duals)
            if (known == vertex) return dual;
        return 0;
    }

    vec3 factor(std::uint32_t i, std::uint32_t j) const {
        const auto& row = known_[j];
        const auto found =
            std::lower_bound(row.begin(), row.end(), i,
                             [](const auto& entry, std::uint32_t column) { return entry.first < column; });
        return found != row.end() && found->first == i ? found->second : rows_.onePoint(i, j);
    }

    // The hats of the lit texel's three vertices at another one.
    dvec3 hatsAt(std::size_t lit, std::size_t to) const {
        dvec3 hats(0);
        for (int v = 0; v < 3; ++v)
            for (int k = 0; k < 3; ++k)
                if (cornersOf(to)[std::size_t(k)] == cornersOf(lit)[std::size_t(v)])
                    hats[v] = double(weightsOf(to)[k]);
        return hats;
    }

    // w of the texel's vertices for each colour; adds its share to the filters of the texels around.
    std::array<dvec3, 3> fit(std::size_t lit, std::vector<vec3>& filters) const {
        const Texel& texel = surface_.texels.list[lit];
        const Hats& hats = surface_.hats;
        const std::vector<Dual> duals = dualsOf(lit);
        double spread = 0; // m²: of the hats together
        for (const std::uint32_t vertex : cornersOf(lit))
            spread += hats.areas[vertex] / 3;
        // What the vertices carry, at vertices around and from there at texels.
        std::vector<std::pair<std::uint32_t, dvec3>> carried;
        const auto carriedTo = [&](std::uint32_t j) {
            for (const auto& [vertex, value] : carried)
                if (vertex == j) return value;
            dvec3 sum(0);
            for (const auto& [vertex, share] : duals)
                sum += share * dvec3(factor(vertex, j));
            carried.emplace_back(j, sum);
            return sum;
        };
        struct Seen {
            std::size_t texel;
            ivec2 away;
            dvec3 left, hats;
        };
        std::vector<Seen> inside;
        std::array<dvec3, 3> normal{dvec3(0), dvec3(0), dvec3(0)}, right = normal; // right: of each colour
        // What leaves outside of the filter: of R_d, less what vertices carry there.
        dvec3 energy(0), share(0);
        for (int v = 0; v < 3; ++v) {
            const std::uint32_t vertex = cornersOf(lit)[std::size_t(v)];
            energy += double(texel.area) * double(texel.place.weights[v]) * dvec3(whole_[vertex]);
            share[v] = hats.areas[vertex] / 3;
        }
        for (const auto& [vertex, dual] : duals) // factors times areas are symmetric
            energy -= dual * hats.areas[vertex] / 3 * dvec3(even_[vertex]);
        filtering_.forEachAround(lit, kBorder, [&](std::size_t to, ivec2 away) {
            dvec3 left = filtering_.factor(lit, to); // what the hats' values shall be
            for (int k = 0; k < 3; ++k)
                left -= double(weightsOf(to)[k]) * carriedTo(cornersOf(to)[std::size_t(k)]);
            const dvec3 at = hatsAt(lit, to);
            if (std::max(std::abs(away.x), std::abs(away.y)) < kBorder) {
                const double area = double(surface_.texels.list[to].area);
                energy -= area * left; // filter - carried
                share -= area * at;
                inside.push_back({to, away, left, at});
                return;
            }
            for (int a = 0; a < 3; ++a) {
                for (int b = 0; b < 3; ++b)
                    normal[std::size_t(a)][b] += at[a] * at[b];
                for (int c = 0; c < 3; ++c)
                    right[std::size_t(c)][a] += at[a] * left[c];
            }
        });
        // As many equations as the border has texels ask for its mean outside.
        constexpr double kCount = 4 * 2 * kBorder, kEnergy = kCount * kEnergyWeight;
        share /= spread;
        energy /= spread;
        for (int a = 0; a < 3; ++a) {
            for (int b = 0; b < 3; ++b)
                normal[std::size_t(a)][b] += kEnergy * share[a] * share[b];
            for (int c = 0; c < 3; ++c)
                right[std::size_t(c)][a] += kEnergy * share[a] * energy[c];
        }
        for (int v = 0; v < 3; ++v) {
            const std::uint32_t vertex = cornersOf(lit)[std::size_t(v)];
            normal[std::size_t(v)][v] += kCount * kRegular;
            const dvec3 diagonal = dualOf(duals, vertex) * (dvec3(whole_[vertex]) - dvec3(even_[vertex]));
            for (int c = 0; c < 3; ++c)
                right[std::size_t(c)][v] += kCount * kRegular * diagonal[c];
        }
        std::array<dvec3, 3> weights; // of each colour
        for (std::size_t c = 0; c < 3; ++c)
            weights[c] = solve(normal, right[c]);
        for (const Seen& seen : inside) {
            dvec3 rest = seen.left;
            for (int c = 0; c < 3; ++c)
                rest[c] -= glm::dot(seen.hats, weights[std::size_t(c)]);
            filters[seen.texel * kFactors + placeOf(-seen.away)] = vec3(rest);
        }
        return weights;
    }

    // Each texel gives what it has of its chart's own surface.
    Rows<vec3> directOf(const std::vector<std::array<dvec3, 3>>& weights) const {
        std::vector<std::vector<std::pair<std::uint32_t, vec3>>> rows(surface_.hats.count());
        for (std::uint32_t t = 0; t < weights.size(); ++t) {
            const Texel& texel = surface_.texels.list[t];
            if (texel.own == 0 || texel.area == 0) continue;
            for (int v = 0; v < 3; ++v) {
                const dvec3 weight(weights[t][0][v], weights[t][1][v], weights[t][2][v]);
                rows[cornersOf(t)[std::size_t(v)]].emplace_back(
                    t, vec3(double(texel.own / texel.area) * weight));
            }
        }
        Rows<vec3> joined;
        for (const auto& row : rows) {
            for (const auto& [column, value] : row) {
                joined.columns.push_back(column);
                joined.values.push_back(value);
            }
            joined.starts.push_back(std::uint32_t(joined.columns.size()));
        }
        return joined;
    }

    static constexpr double kEnergyWeight = 100, kRegular = 1e-3;

    const Surface& surface_;
    Filtering filtering_;
    const FactorRows& rows_;
    std::span<const vec3> whole_;
    std::vector<vec3> even_;
    std::vector<std::vector<std::pair<std::uint32_t, vec3>>> known_; // FactorRows::close()
    std::vector<std::vector<Dual>> exact_;      // of texels that have some of their chart
    std::vector<std::array<dvec3, 3>> weights_; // w, as fit() has them
};

} // namespace

void addPlainFilters(Stages& stages, double share, const Surface& surface, const Response& response,
                     Filters& made) {
    const auto filtering = std::make_shared<const Filtering>(surface, response);
    made.factors.assign(filtering->count() * kFactors, vec3(0));
    made.direct.starts.assign(surface.hats.count() + 1, 0);
    stages.forEach(share, filtering->count(), [filtering, &made](std::size_t to) {
        filtering->forEachAround(to, Filters::kRadius, [&](std::size_t lit, ivec2 away) {
            made.factors[to * kFactors + placeOf(away)] = vec3(filtering->factor(lit, to));
        });
    });
}

void addFittedFilters(Stages& stages, double share, const Surface& surface, const Response& response,
                      const FactorRows& rows, const Factors& factors, std::span<const vec3> whole,
                      Filters& made) {
    // It stays while one of the stages does.
    const auto fitting = std::make_shared<Fitting>(surface, response, rows, factors, whole);
    fitting->add(stages, share, made);
    stages.then([fitting]() -> Status { return Done{}; });
}

} // namespace lucent::throughput
