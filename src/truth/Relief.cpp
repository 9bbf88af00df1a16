#include "truth/Relief.h"

#include "truth/ColorMap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The parts of a piece that are inside, as shares of its length; a quadratic has at most two.
struct InsideParts {
    Stretch parts[2];
    int count = 0;
};

InsideParts insideParts(const Piece& piece) {
    const double a = 2 * (piece.first - 2 * piece.middle + piece.last);
    const double b = piece.last - piece.first - a;
    const auto value = [&](double u) { return piece.first + u * (b + a * u); };

    double cuts[4] = {0, 1, 1, 1};
    int count = 1;
    const double discriminant = b * b - 4 * a * piece.first;
    if (discriminant > 0) {
        // In this form neither root is the difference of nearly equal numbers.
        const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
        for (const double root : {piece.first / q, q / a})
            if (root > 0 && root < 1) cuts[count++] = root;
        // Under the sanitizers GCC 12 sees std::sort() go past the end of so few (GCC bug 104165).
        if (count == 3 && cuts[2] < cuts[1]) std::swap(cuts[1], cuts[2]);
    }
    InsideParts inside;
    for (int i = 0; i < count; ++i)
        if (value(0.5 * (cuts[i] + cuts[i + 1])) > 0) inside.parts[inside.count++] = {cuts[i], cuts[i + 1]};
    return inside;
}

/// Cosine as the limit of the attenuation for depth -> 0: on a plane r = depth / cosine.
double limitOfAttenuation(double cosine, Attenuation attenuation) {
    if (cosine <= 0) return 0;
    cosine = std::min(cosine, 1.0); // of unit vectors, but for rounding
    return attenuation == Attenuation::Ratio ? cosine : std::exp(1 - 1 / cosine);
}

/// Maps [range.x, range.y] to [0, 1]; a step where both ends are equal.
double remap(double value, vec2 range) {
    const double low = double(range.x), high = double(range.y);
    if (low == high) return value >= low ? 1 : 0;
    return std::clamp((value - low) / (high - low), 0.0, 1.0);
}
} // namespace

double insideLength(const Field& field, const Ray& ray, Stretch stretch) {
    double length = 0;
    field.cut(ray, stretch, [&](const Piece& piece) {
        const InsideParts inside = insideParts(piece);
        for (int i = 0; i < inside.count; ++i)
            length += (inside.parts[i].to - inside.parts[i].from) * (piece.stretch.to - piece.stretch.from);
        return true;
    });
    return length;
}

double firstInside(const Field& field, const Ray& ray, Stretch stretch) {
    double first = kInfinity;
    field.cut(ray, stretch, [&](const Piece& piece) {
        const InsideParts inside = insideParts(piece);
        if (inside.count == 0) return true;
        first = piece.stretch.from;
        if (const double share = inside.parts[0].from; share > 0)
            first += share * (piece.stretch.to - piece.stretch.from);
        return false;
    });
    return first;
}

LightPath lightPath(const SurfacePoint& point, double depth, const LightSource& light) {
    if (light.distant) return {light.place, kInfinity};
    const dvec3 way = (light.place - point.position) + depth * point.normal;
    const double distance = glm::length(way);
    return {distance > 0 ? way / distance : point.normal, distance};
}

bool visible(const Field& field, const SurfacePoint& point, const LightSource& light) {
    const LightPath path = lightPath(point, 0, light);
    const double horizontal = glm::length(dvec2(path.direction));
    if (horizontal == 0) return true;
    const Ray ray{point.position, dvec3(0), path.direction};
    return firstInside(field, ray, {field.texel() / horizontal, path.distance}) == kInfinity;
}

double illumination(const Field& field, const SurfacePoint& point, double depth, const LightSource& light,
                    Attenuation attenuation) {
    const LightPath path = lightPath(point, depth, light);
    if (depth < 0.5 * field.texel()) {
        const double limit = limitOfAttenuation(glm::dot(point.normal, path.direction), attenuation);
        return limit > 0 && visible(field, point, light) ? limit : 0;
    }
    const Ray ray{point.position, -depth * point.normal, path.direction};
    const double inside = insideLength(field, ray, {0, path.distance});
    if (inside <= depth) return 1;
    return attenuation == Attenuation::Ratio ? depth / inside : std::exp(1 - inside / depth);
}

double depthInObject(const scene::Object& object) {
    return double(object.material.relief().depth) / double(object.transform.scale);
}

namespace {
/// What reaches the eye from a point by way of one light: colour, and d times the light's weight.
class Gathering {
public:
    Gathering(const Field& field, const scene::Object& object, const SurfacePoint& point,
              const dvec3& eyeDirection, Attenuation attenuation)
        : field_(field), relief_(object.material.relief()), point_(point), eyeDirection_(eyeDirection),
          reflected_(eyeDirection - 2 * glm::dot(point.normal, eyeDirection) * point.normal),
          depth_(depthInObject(object)), scale_(double(object.transform.scale)), attenuation_(attenuation) {
        const dvec2 place = field.placeOnMap(point.position);
        diffuse_ = dvec3(object.material.diffuse) * sampleMap(object.material.diffuseMap.get(), place);
        specular_ = dvec3(relief_.specular) * sampleMap(object.material.specularMap.get(), place);
        base_ = dvec3(object.material.base) * sampleMap(object.material.baseMap.get(), place);
    }

    dvec3 unlit() const { return (1 - double(relief_.specularity)) * base_; }

    void add(const LightSource& light) {
        sum_ += arriving(light);
        weights_ += light.weight;
    }
    /// The light of one cell of a sky or disc, known from two independent pairs of samples, each with half of
    /// it: the variance of their sum is expected to be the square of their difference.
    void addCell(const std::array<LightSource, 4>& lights) {
        const glm::dvec4 one = arriving(lights[0]) + arriving(lights[1]);
        const glm::dvec4 other = arriving(lights[2]) + arriving(lights[3]);
        sum_ += one + other;
        variance_ += (one - other) * (one - other);
        for (const LightSource& light : lights)
            weights_ += light.weight;
    }
    void addDisc(const LightSource& lamp, DiscSampling& discs) {
        const int rings = int(std::ceil(std::sqrt(discs.samples / 4.0)));
        const double share = 1.0 / (4.0 * rings * rings);
        const dvec3 below = point_.position - depth_ * point_.normal;
        for (int cell = 0; cell < rings * rings; ++cell) {
            const auto places = mirroredPairs(discs.random);
            std::array<LightSource, 4> lights;
            for (std::size_t i = 0; i < 4; ++i) {
                lights[i] = pointOnDisc(lamp, below, placeInDiscCell(rings, cell, places[i]));
                lights[i].color *= share;
                lights[i].weight *= share;
            }
            addCell(lights);
        }
    }

    Shading result() const {
        Shading shading{unlit() + dvec3(sum_), 0, dvec3(variance_), 0};
        if (weights_ > 0) {
            shading.illumination = sum_.w / weights_;
            shading.illuminationVariance = variance_.w / (weights_ * weights_);
        }
        return shading;
    }

private:
    glm::dvec4 arriving(const LightSource& light) const {
        const LightPath path = lightPath(point_, depth_, light);
        const double d = illumination(field_, point_, depth_, light, attenuation_);
        const double f = remap(glm::dot(eyeDirection_, path.direction), relief_.scatterFalloff);
        const double s = remap(glm::dot(reflected_, path.direction), relief_.specularFalloff);
        const double ks = double(relief_.specularity), kf = double(relief_.forwardScatter);
        const double distance = scale_ * path.distance;
        const dvec3 color = light.inverseSquare ? light.color / (distance * distance) : light.color;
        return {color * ((1 - ks) * ((1 - kf) + kf * f) * d * diffuse_ + ks * s * specular_),
                light.weight * d};
    }

    const Field& field_;
    const scene::Relief& relief_;
    const SurfacePoint& point_;
    dvec3 eyeDirection_, reflected_;
    double depth_, scale_;
    Attenuation attenuation_;
    dvec3 base_, diffuse_, specular_;
    glm::dvec4 sum_{0}, variance_{0}; ///< colour and d
    double weights_ = 0;
};
} // namespace

Shading shade(const Field& field, const scene::Object& object, const SurfacePoint& point,
              const dvec3& eyeDirection, const Lighting& lighting, Attenuation attenuation,
              DiscSampling discs) {
    Gathering gathering(field, object, point, eyeDirection, attenuation);
    for (const LightSource& lamp : lighting.lamps) {
        if (lamp.radius > 0)
            gathering.addDisc(lamp, discs);
        else
            gathering.add(lamp);
    }
    const auto& sky = lighting.environment;
    for (std::size_t cell = 0; cell + 4 <= sky.size(); cell += 4)
        gathering.addCell({sky[cell], sky[cell + 1], sky[cell + 2], sky[cell + 3]});
    return gathering.result();
}

} // namespace lucent::truth
