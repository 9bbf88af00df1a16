#include "truth/Relief.h"

#include "truth/ColorMap.h"

#include <algorithm>
#include <cmath>
#include <limits>

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
        std::sort(cuts, cuts + count);
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
    return double(object.material.depth) / double(object.transform.scale);
}

Shading shade(const Field& field, const scene::Object& object, const SurfacePoint& point,
              const dvec3& eyeDirection, std::span<const LightSource> lights, Attenuation attenuation) {
    const scene::Material& material = object.material;
    const double depth = depthInObject(object), scale = double(object.transform.scale);
    const double ks = double(material.specularity), kf = double(material.forwardScatter);
    // Place on the colour maps, (0, 0) at the first texel's outer corner.
    const dvec2 place =
        dvec2(point.position.x + field.half().x, field.half().y - point.position.y) / (2.0 * field.half());
    const dvec3 base = dvec3(material.base) * sampleMap(material.baseMap.get(), place);
    const dvec3 diffuse = dvec3(material.diffuse) * sampleMap(material.diffuseMap.get(), place);
    const dvec3 specular = dvec3(material.specular) * sampleMap(material.specularMap.get(), place);
    const dvec3 reflected = eyeDirection - 2 * glm::dot(point.normal, eyeDirection) * point.normal;

    Shading shading{(1 - ks) * base, 0};
    double weights = 0;
    for (const LightSource& light : lights) {
        const LightPath path = lightPath(point, depth, light);
        const double d = illumination(field, point, depth, light, attenuation);
        const double f = remap(glm::dot(eyeDirection, path.direction), material.scatterFalloff);
        const double s = remap(glm::dot(reflected, path.direction), material.specularFalloff);
        const double distance = scale * path.distance;
        const dvec3 arriving = light.inverseSquare ? light.color / (distance * distance) : light.color;
        shading.color += arriving * ((1 - ks) * ((1 - kf) + kf * f) * d * diffuse + ks * s * specular);
        shading.illumination += light.weight * d;
        weights += light.weight;
    }
    if (weights > 0) shading.illumination /= weights;
    return shading;
}

} // namespace lucent::truth
