#include "truth/Dipole.h"

#include "truth/EnteredLight.h"
#include "truth/Interface.h"
#include "truth/LampRays.h"
#include "truth/Photons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace lucent::truth {

namespace {
constexpr double kPi = std::numbers::pi;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Distances from a point over a plane, of which a share u lies within: z a source's distance from the plane
/// for the light it sends there, 1 - z / sqrt(r² + z²); or 1 - e^(-r / z).
struct Spread {
    double z;
    bool exponential;
    double most;                      ///< m: distances end here
    double whole = shareWithin(most); ///< that lies within `most`

    double shareWithin(double r) const {
        if (exponential) return -std::expm1(-r / z);
        const double d = std::sqrt(r * r + z * z);
        return r * r / (d * (d + z));
    }
    /// Over the plane, 1/m².
    double density(double r) const {
        if (r > most) return 0;
        if (exponential) return std::exp(-r / z) / (2 * kPi * r * z * whole);
        const double d = std::sqrt(r * r + z * z);
        return z / (2 * kPi * d * d * d * whole);
    }
};

/// R_d of one colour.
class Response {
public:
    /// @param most  m, the largest distance asked for
    Response(const Body& body, std::size_t channel, const DipoleOptions& options, double most)
        : offset_(options.geometry == DipoleGeometry::Offset) {
        const Inside& inside = body.insides[channel];
        const double thickness = body.thickness;
        if (options.profile == Diffusion::Multipole && !body.layers[channel].empty()) {
            std::vector<Layer> layers = body.layers[channel];
            layers.push_back({inside, thickness > 0 ? thickness : kInfinity});
            layered_ = std::make_shared<LayeredResponse>(layers, most);
            return;
        }
        const double scattering = inside.reducedScattering(), extinction = scattering + inside.absorption;
        if (scattering == 0) return;
        albedo_ = scattering / extinction;
        transport_ = std::sqrt(3 * inside.absorption * extinction);
        const double internal = internalReflection(inside.ior);
        const double boundary = 2 * (1 + internal) / (1 - internal) / (3 * extinction); // 2 A D
        const double depth = 1 / extinction;
        if (options.profile == Diffusion::Burley) {
            const double ends = std::sqrt(3 * (1 - albedo_));
            burleyTotal_ = 0.5 * albedo_ * std::exp(-ends) * (1 + std::exp(-2 * boundary * transport_));
            const double shape = 1.85 - burleyTotal_ + 7 * std::pow(std::abs(burleyTotal_ - 0.8), 3);
            burleyLength_ = depth / shape;
        } else if (options.profile == Diffusion::Multipole && thickness > 0) {
            addLayer(thickness, boundary, extinction);
        } else {
            sources_ = {{depth, depth}, {-depth - 2 * boundary, depth + 2 * boundary}};
        }
    }

    bool isDark() const { return layered_ ? layered_->isDark() : albedo_ == 0; }

    /// @param normal  unit, where light enters
    double at(const dvec3& from, const dvec3& normal, const dvec3& to) const {
        const double r = glm::distance(from, to);
        if (layered_) return layered_->at(r);
        if (burleyTotal_ > 0)
            return burleyTotal_ / (8 * kPi * burleyLength_ * r) *
                   (std::exp(-r / burleyLength_) + std::exp(-r / (3 * burleyLength_)));
        double sum = 0;
        for (const Source& source : sources_) {
            const double least = std::abs(source.depth);
            const double d = offset_ ? std::max(least, glm::distance(from - source.depth * normal, to))
                                     : std::hypot(r, source.depth);
            sum += source.weight * (transport_ + 1 / d) * std::exp(-transport_ * d) / (d * d);
        }
        return albedo_ / (4 * kPi) * sum;
    }

    /// The same of a medium this many times as dense: sharpness² R_d(sharpness r).
    double at(const dvec3& from, const dvec3& normal, const dvec3& to, double sharpness) const {
        if (sharpness == 1) return at(from, normal, to);
        return sharpness * sharpness * at(dvec3(0), normal, sharpness * (to - from));
    }

    /// How places are chosen for it: R_d is bounded by a multiple of the mean of these densities.
    ///
    /// @param scale  of the density of the medium
    void addSpreads(double scale, double most, std::vector<Spread>& spreads) const {
        if (isDark()) return;
        if (burleyTotal_ >
            0) { // a quarter of its light lies in the narrow part, three quarters in the wide one
            spreads.push_back({burleyLength_ / scale, true, most});
            for (int i = 0; i < 3; ++i)
                spreads.push_back({3 * burleyLength_ / scale, true, most});
        } else if (layered_) {
            spreads.push_back({layered_->depths().x / scale, false, most});
            spreads.push_back({layered_->depths().y / scale, false, most});
        } else {
            spreads.push_back({std::abs(sources_[0].depth) / scale, false, most});
            spreads.push_back({std::abs(sources_[1].depth) / scale, false, most});
        }
    }

private:
    /// Of diffuse light, below the surface (depth > 0) or above.
    struct Source {
        double depth, weight; ///< m
    };

    void addLayer(double thickness, double boundary, double extinction) {
        const double optical = thickness * extinction, collides = -std::expm1(-optical);
        // Of a distribution e^(-t) over [0, optical]; its series where the layer is thin.
        const double mean =
            optical < 1e-4 ? optical * (0.5 - optical / 12) : 1 - optical * std::exp(-optical) / collides;
        const double depth = mean / extinction, period = 2 * (thickness + 2 * boundary);
        constexpr double kLeast = 1e-9; // e^(-sigma d) that no longer counts
        const double absorbed = -std::log(kLeast) / (transport_ * period);
        const int images = int(std::ceil(std::min(20.0, absorbed)));
        const auto add = [&](int i) {
            const double real = i * period + depth, other = i * period - depth - 2 * boundary;
            sources_.push_back({real, collides * real});
            sources_.push_back({other, -collides * other});
        };
        add(0);
        for (int i = 1; i <= images; ++i) {
            add(i);
            add(-i);
        }
        // The rest of both sums as the integrals they approach (Euler, Maclaurin): over a wide plane it
        // counts.
        for (const double rest : {-(images + 0.5) * period, (images + 0.5) * period})
            sources_.push_back({rest, -collides * 2 * (depth + boundary) / period * std::abs(rest)});
    }

    bool offset_;
    double albedo_ = 0, transport_ = 0;
    std::vector<Source> sources_;
    std::shared_ptr<const LayeredResponse> layered_; ///< shared by copies
    double burleyTotal_ = 0;
    double burleyLength_ = 0; ///< m
};

/// What a body's colours have in common: responses, and how distances are chosen for them.
class Responses {
public:
    Responses(const Body& body, const DipoleOptions& options) : most_(2 * body.alone.around(0).radius) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            // Where paint makes light spread less or more, R_d is bounded by a multiple of the next of these.
            const dvec2 sharpness = body.painted ? body.painted->sharpness() : dvec2(1);
            colors.emplace_back(body, channel, options, most_ * std::max(1.0, sharpness.y));
            for (double scale = sharpness.x; scale <= sharpness.y; scale *= 4)
                colors.back().addSpreads(scale, most_, spreads_);
        }
    }
    /// The distance within which a share u of the mean of all spreads lies.
    double choose(double u) const {
        // Newton's steps that leave the bracket become bisections.
        double low = 0, high = most_, at = 0.5 * most_;
        for (int step = 0; step < 100 && high - low > 1e-12 * high; ++step) {
            const double over = shareWithin(at) - u;
            (over < 0 ? low : high) = at;
            const double next = at - over / (2 * kPi * at * density(at));
            if (std::abs(next - at) < 1e-12 * at) break;
            at = low < next && next < high ? next : 0.5 * (low + high);
        }
        return at;
    }
    /// Over a plane, 1/m².
    double density(double r) const {
        double sum = 0;
        for (const Spread& spread : spreads_)
            sum += spread.density(r);
        return sum / double(spreads_.size());
    }

    std::vector<Response> colors;

private:
    double shareWithin(double r) const {
        double sum = 0;
        for (const Spread& spread : spreads_)
            sum += spread.shareWithin(r) / spread.whole;
        return sum / double(spreads_.size());
    }
    std::vector<Spread> spreads_;
    double most_; ///< m: the body's extent
};

/// Each pixel's light is estimated so many times.
constexpr int kBeginnings = 8;
/// Caustics that enter a body, for each of these estimates the light of rays of its own.
using Caustics = std::array<EnteredLight, kBeginnings>;

/// Follows rays of light to all bodies of a scene.
std::vector<Caustics> causticsOn(const Bodies& bodies, const Illumination& illumination,
                                 const DipoleOptions& options) {
    std::vector<Caustics> all(bodies.all().size());
    const LampRays rays(bodies.optics(), illumination, Branching::Chain);
    if (!rays.exist()) return all;
    const int count = options.rays / kBeginnings;
    for (std::size_t beginning = 0; beginning < kBeginnings; ++beginning) {
        std::vector<std::vector<LightEntry>> entries(all.size());
        const auto enter = [&](const Arrival& arrival, const dvec3& flux) {
            const Body* body = arrival.at == Arrival::At::Opaque ? bodies.of(arrival.hit.shape) : nullptr;
            if (!body || glm::dot(arrival.hit.normal, arrival.direction) >= 0) return;
            const dvec3 normal = normalTowards(arrival.hit, -arrival.direction);
            const double cosine = std::clamp(-glm::dot(normal, arrival.direction), 0.0, 1.0);
            const Paint paint = body->paintAt(arrival.hit.position);
            const double transmitted = 1 - reflectance(cosine, 1 / body->surfaceIor);
            entries[std::size_t(body - bodies.all().data())].push_back(
                {arrival.hit.position, normal,
                 flux * arrival.weight * paint.translucency * paint.entering * (transmitted / count),
                 paint.sharpness});
        };
        for (int i = 0; i < count; ++i) {
            Random random(options.seed, kPhotonStream, beginning * std::size_t(count) + std::size_t(i));
            rays.follow(random, enter);
        }
        for (std::size_t body = 0; body < all.size(); ++body)
            all[body][beginning] = EnteredLight(std::move(entries[body]));
    }
    return all;
}

/// Lines through a body on which places are looked for: close to one place along its normal and across, or
/// anywhere along the world's axes.
class Lines {
public:
    /// Parallel ones.
    struct Family {
        dvec3 direction, first, second; ///< perpendicular to each other
        bool close;                     ///< distances from the place are those of the responses; else even
        int count;
    };

    /// @param count  of all families, about
    Lines(const dvec3& place, const dvec3& normal, const Responses& responses, const Sphere& ball, int count)
        : responses_(responses), place_(place), ball_(ball) {
        const dvec3 aside = std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 first = glm::normalize(glm::cross(normal, aside));
        add({normal, first, glm::cross(normal, first)}, true, {0.5, 0.07, 0.07}, count);
        add({dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1)}, false, {0.12, 0.12, 0.12}, count);
    }

    const std::vector<Family>& families() const { return families_; }
    /// @param chance  [0,1) each
    WorldRay line(const Family& family, dvec2 chance) const {
        const double away = family.close ? responses_.choose(chance.x) : ball_.radius * std::sqrt(chance.x);
        const double angle = 2 * kPi * chance.y;
        const dvec3 across = away * (std::cos(angle) * family.first + std::sin(angle) * family.second);
        return {(family.close ? place_ : ball_.center) + across, family.direction, kInfinity, -kInfinity};
    }
    /// What a place on a line of a family counts, m²: all families' counts of it have the mean of its area.
    /// Many lines of others make it count less by the square (power heuristic, Veach, Guibas 1995): a family
    /// that grazes the surface, of which chance decides whether it meets it, does no harm.
    double areaOf(const Hit& hit, const Family& own) const {
        double squares = 0;
        for (const Family& family : families_)
            squares += std::pow(density(hit, family), 2);
        return squares > 0 ? density(hit, own) / squares : 0;
    }

private:
    /// Lines of a family that meet an area around a place, 1/m².
    double density(const Hit& hit, const Family& family) const {
        const double across = glm::length(glm::cross(hit.position - place_, family.direction));
        const double evenly = 1 / (kPi * ball_.radius * ball_.radius);
        return family.count * std::abs(glm::dot(hit.normal, family.direction)) *
               (family.close ? responses_.density(across) : evenly);
    }
    void add(const std::array<dvec3, 3>& axes, bool close, const std::array<double, 3>& shares, int count) {
        for (std::size_t i = 0; i < 3; ++i)
            families_.push_back({axes[i], axes[(i + 1) % 3], axes[(i + 2) % 3], close,
                                 std::max(1, int(std::lround(shares[i] * count)))});
    }
    const Responses& responses_;
    dvec3 place_;
    Sphere ball_;
    std::vector<Family> families_;
};
} // namespace

struct DipoleEstimator::State {
    DipoleOptions options;
    Eye eye;
    ivec2 size;
    std::unique_ptr<Bodies> bodies; ///< in one place: others know it
    Illumination illumination;
    Surroundings surroundings;
    std::vector<Responses> responses; ///< of each body
    std::vector<Caustics> caustics;   ///< on each body

    std::size_t numberOf(const Body& body) const { return std::size_t(&body - bodies->all().data()); }
    dvec3 sample(const Body& body, const dvec3& to, const Lines& lines, const Lines::Family& family,
                 WorldRay line, Random& random) const;
    dvec3 ofCaustics(std::size_t body, std::size_t beginning, const dvec3& to) const;
};

/// What caustics that entered a body send to a place.
dvec3 DipoleEstimator::State::ofCaustics(std::size_t body, std::size_t beginning, const dvec3& to) const {
    dvec3 sum(0);
    caustics[body][beginning].visit(to, [&](const LightEntry& entry) {
        for (int c = 0; c < 3; ++c)
            if (const Response& color = responses[body].colors[std::size_t(c)]; !color.isDark())
                sum[c] += entry.flux[c] * color.at(entry.place, entry.normal, to, entry.sharpness);
    });
    return sum;
}

/// What the places on one line of a family send to a place, by the area that each counts.
dvec3 DipoleEstimator::State::sample(const Body& body, const dvec3& to, const Lines& lines,
                                     const Lines::Family& family, WorldRay line, Random& random) const {
    const Responses& own = responses[numberOf(body)];
    dvec3 sum(0);
    for (Hits hits = body.alone.coincidentHits(line); hits.count > 0;
         hits = body.alone.coincidentHits(line)) {
        for (Hit from : hits) {
            from.shape = body.object;
            const dvec3 light = illumination.irradiance(from, from.normal, random, body.surfaceIor);
            if (light == dvec3(0)) continue;
            const double area = lines.areaOf(from, family);
            if (!(area > 0)) continue; // in one point, which nobody chooses
            const dvec3 normal = normalTowards(from, from.normal);
            const Paint paint = body.paintAt(from.position);
            const dvec3 entering = light * paint.translucency * paint.entering;
            for (int c = 0; c < 3; ++c)
                if (const Response& color = own.colors[std::size_t(c)]; !color.isDark())
                    sum[c] += entering[c] * color.at(from.position, normal, to, paint.sharpness) * area;
        }
        line.begin = hits.at[0].distance + body.alone.gap();
    }
    return sum;
}

DipoleEstimator::DipoleEstimator(std::unique_ptr<State> state) : state_(std::move(state)) {}
DipoleEstimator::DipoleEstimator(DipoleEstimator&&) noexcept = default;
DipoleEstimator::~DipoleEstimator() = default;

Result<DipoleEstimator> DipoleEstimator::create(const scene::Scene& scene, ivec2 size,
                                                const DipoleOptions& options) {
    Result<Bodies> found = Bodies::create(scene);
    if (!found) return found.error();
    auto bodies = std::make_unique<Bodies>(std::move(*found));
    auto surroundings =
        Surroundings::create(scene, *bodies, size, options.aov, options.samples, options.seed);
    if (!surroundings) return surroundings.error();
    Illumination illumination(scene, bodies->optics());
    std::vector<Responses> responses;
    for (const Body& body : bodies->all())
        responses.emplace_back(body, options);
    std::vector<Caustics> caustics = causticsOn(*bodies, illumination, options);
    return DipoleEstimator(std::make_unique<State>(
        State{options, Eye(scene.camera, size), size, std::move(bodies), std::move(illumination),
              std::move(*surroundings), std::move(responses), std::move(caustics)}));
}

const Bodies& DipoleEstimator::bodies() const { return *state_->bodies; }

Estimate DipoleEstimator::radiosity(const Body& body, const Hit& hit, std::uint64_t number) const {
    // Steps of an even sequence in a square: powers of the root of x³ = x + 1 (Roberts 2018).
    constexpr double kRoot = 1.324717957244746;
    const dvec2 step(1 / kRoot, 1 / (kRoot * kRoot));
    const std::size_t own = state_->numberOf(body);
    const Lines lines(hit.position, hit.normal, state_->responses[own], body.alone.around(0),
                      (state_->options.samples + kBeginnings - 1) / kBeginnings);
    Estimate estimate;
    for (std::size_t beginning = 0; beginning < kBeginnings; ++beginning) {
        Random random(state_->options.seed, number, beginning);
        dvec3 sum = state_->ofCaustics(own, beginning, hit.position);
        for (const Lines::Family& family : lines.families()) {
            const dvec2 first = random.nextPair();
            for (int i = 0; i < family.count; ++i) {
                const WorldRay line = lines.line(family, glm::fract(first + double(i) * step));
                sum += state_->sample(body, hit.position, lines, family, line, random);
            }
        }
        estimate.add(sum);
    }
    return estimate;
}

Pixel DipoleEstimator::solve(ivec2 pixel) const {
    const auto place = state_->bodies->seenAt(state_->eye, pixel);
    if (!place) return state_->surroundings.solve(pixel);
    const auto number = std::uint64_t(pixel.y) * std::uint64_t(state_->size.x) + std::uint64_t(pixel.x);
    const Estimate estimate = radiosity(*place->body, place->hit, number);
    const Paint paint = place->body->paintAt(place->hit.position);
    dvec3 share = paint.translucency * paint.leaving;
    if (state_->options.aov == scene::Aov::Color) {
        const double cosine = glm::dot(normalTowards(place->hit, place->viewer), place->viewer);
        share *= place->body->lobe(cosine);
        if (!state_->options.normalisedExit) share *= place->body->meanTransmittance;
    }
    const Pixel surface = state_->surroundings.ofSurface(*place, pixel);
    return {share * estimate.mean() + surface.value,
            share * share * estimate.varianceOfMean() + surface.variance, 1};
}

} // namespace lucent::truth
