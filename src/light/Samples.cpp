#include "light/Samples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

namespace lucent::views {

namespace {

const float kGolden = kPi * (3 - std::sqrt(5.0f)); // angle between the points of a spiral (Vogel 1979)

float fractionOf(float value) { return value - std::floor(value); }

// Of the i-th of so many parts, or beside it by a share of one.
float middleOf(int i, int count, float offset) {
    return fractionOf((float(i) + 0.5f + offset) / float(count));
}

// Even over the unit disc.
vec2 inDisc(int i, int count, vec2 offset) {
    const float angle = float(i) * kGolden + 2 * kPi * offset.y;
    return std::sqrt(middleOf(i, count, offset.x)) * vec2(std::cos(angle), std::sin(angle));
}

// In the unit ball with density 1 / sqrt(1 - r²): directions on a spiral, and radii r = sin a whose share is
// (a - sin a cos a) 2 / pi.
vec3 inBall(int i, int count, vec2 offset) {
    // The golden ratio would go with the angles.
    const float share = fractionOf((float(i) + 0.5f) * std::sqrt(2.0f) + offset.x + offset.y);
    float low = 0, high = kPi / 2;
    for (int step = 0; step < 24; ++step) { // to the last digit of a float
        const float a = 0.5f * (low + high);
        (a - std::sin(a) * std::cos(a) < share * kPi / 2 ? low : high) = a;
    }
    const float z = 1 - 2 * middleOf(i, count, offset.x), aside = std::sqrt(1 - z * z);
    const float angle = float(i) * kGolden + 2 * kPi * offset.y;
    return std::sin(low) * vec3(aside * std::cos(angle), z, aside * std::sin(angle));
}

void add(std::vector<LampPoint>& points, const scene::PointLight& light, int samples, vec2 offset) {
    const int count = light.radius > 0 ? samples : 1;
    for (int i = 0; i < count; ++i) {
        const vec3 place = light.position + (count > 1 ? light.radius * inBall(i, count, offset) : vec3(0));
        points.push_back({.place = vec4(place, 1),
                          .centre = light.position,
                          .fades = light.falloff == scene::LightFalloff::InverseSquare,
                          .color = light.intensity / float(count) * light.color,
                          .isPart = count > 1,
                          .source = {.place = vec4(place, 1)},
                          .weight = 1 / float(count),
                          .part = light.radius / std::sqrt(float(count))});
    }
}

void add(std::vector<LampPoint>& points, const scene::DistantLight& light, int samples, vec2 offset) {
    const int count = light.angle > 0 ? samples : 1;
    const vec3 back = -glm::normalize(light.direction);
    const vec3 aside = std::abs(back.x) < 0.5f ? vec3(1, 0, 0) : vec3(0, 1, 0);
    const vec3 right = glm::normalize(glm::cross(back, aside)), up = glm::cross(back, right);
    const float radius = std::tan(glm::radians(light.angle / 2));
    for (int i = 0; i < count; ++i) {
        const vec2 at = count > 1 ? radius * inDisc(i, count, offset) : vec2(0);
        const vec4 place(glm::normalize(back + at.x * right + at.y * up), 0);
        points.push_back({.place = place,
                          .color = light.irradiance / float(count) * light.color,
                          .isPart = count > 1,
                          .source = {.place = place},
                          .weight = 1 / float(count),
                          .part = radius / std::sqrt(float(count))});
    }
}

void add(std::vector<LampPoint>& points, const scene::SpotLight& light, int, vec2) {
    const float inner = std::cos(glm::radians(light.innerAngle));
    const float outer = std::cos(glm::radians(light.outerAngle));
    const float scale = 1 / std::max(0.001f, inner - outer);
    const vec4 place(light.position, 1);
    const vec3 axis = glm::normalize(light.direction);
    const auto frame = light.image ? scene::pictureFrame(light) : scene::PictureFrame{vec3(0), vec3(0)};
    points.push_back({.place = place,
                      .centre = light.position,
                      .fades = true,
                      .color = light.intensity * light.color,
                      .axis = axis,
                      .cone = {scale, -outer * scale},
                      .exponent = 2,
                      .source = {place, axis, std::tan(glm::radians(light.outerAngle))},
                      .picture = light.image,
                      .pictureRight = frame.right,
                      .pictureUp = frame.up});
}

// Places of the rank-1 lattice of the golden ratio: even over the parallelogram for any number.
void add(std::vector<LampPoint>& points, const scene::AreaLight& light, int samples, vec2 offset) {
    const vec3 across = glm::cross(light.edgeU, light.edgeV);
    const float area = glm::length(across);
    const float inverseGolden = 0.5f * (std::sqrt(5.0f) - 1);
    for (int i = 0; i < samples; ++i) {
        const float u = middleOf(i, samples, offset.x);
        const float v = fractionOf((float(i) + 0.5f) * inverseGolden + offset.y);
        const vec3 place = light.corner + u * light.edgeU + v * light.edgeV;
        points.push_back({.place = vec4(place, 1),
                          .centre = place,
                          .fades = true,
                          .color = light.radiance * area / float(samples) * light.color,
                          .axis = across / area,
                          .cone = {1, 0},
                          .isPart = samples > 1,
                          .source = {.place = vec4(place, 1)},
                          .weight = 1 / float(samples),
                          .part = std::sqrt(area / (kPi * float(samples)))});
    }
}

// Of a lattice of so many points, near the golden ratio of them and without a common divisor.
int generatorOf(int count) {
    int generator = int(std::lround(float(count) * 0.5f * (std::sqrt(5.0f) - 1)));
    while (std::gcd(generator, count) > 1)
        ++generator;
    return generator;
}

constexpr std::string_view kEnvironmentSamplings[] = {"equal", "importance"};

} // namespace

const ParamTable& samplingParams() {
    static const Param list[] = {
        declare(&Sampling::lamp,
                {.id = "lampSamples",
                 .label = "Samples of a lamp",
                 .min = 1,
                 .max = 4096,
                 .low = 1,
                 .high = 256,
                 .logarithmic = true,
                 .group = Group::Light,
                 .doc =
                     "How many light samples stand for a lamp that has a size, others for each sample of a "
                     "pixel; each casts its own shadows. With more the edge of a soft shadow fades "
                     "smoothly; with few it shows several hard edges beside each other."}),
        declare(&Sampling::shadowSize,
                {.id = "shadowSize",
                 .label = "Shadow map",
                 .unit = "texels",
                 .min = 64,
                 .max = 4096,
                 .low = 256,
                 .high = 2048,
                 .logarithmic = true,
                 .group = Group::Light,
                 .doc = "Texels along a side of what a lamp sees: more make edges of shadows finer. Lamps "
                        "with a size have half as many for each of their samples."}),
        declare(&Sampling::directions,
                {.id = "directions",
                 .label = "Directions",
                 .min = 6,
                 .max = 65536,
                 .low = 16,
                 .high = 1024,
                 .logarithmic = true,
                 .group = Group::Environment,
                 .doc = "About how many light samples stand for the environment, shared out among the "
                        "samples of a pixel, each of which has others; each carries the mean of its part of "
                        "the map. More make shadows under a sky smooth."}),
        declare(&Sampling::environment,
                {.id = "environmentSampling",
                 .label = "Environment sampling",
                 .group = Group::Environment,
                 .doc = "Where those directions are: evenly all around, or more of them where the map is "
                        "bright.",
                 .choices = kEnvironmentSamplings}),
        declare(&Sampling::pixelSamples,
                {.id = "pixelSamples",
                 .label = "Samples of a pixel",
                 .min = 1,
                 .max = 256,
                 .low = 1,
                 .high = 16,
                 .group = Group::View,
                 .doc =
                     "Places over which the colour of a pixel is the mean, each with its own light samples, "
                     "drawn one after the other while the picture is still; 1: its middle alone."}),
    };
    static const ParamTable table = tableOf<Sampling>("sampling", list, "Light samples");
    return table;
}

const Sampling& samplingOf(const scene::Scene& scene) {
    static const Sampling usual;
    const auto found = scene.technique.find("sampling");
    return found == scene.technique.end() ? usual : found->second.as<Sampling>();
}

Sampling& samplingOf(scene::Scene& scene) {
    return *static_cast<Sampling*>(scene.technique.at("sampling").data());
}

bool samplingActs(const scene::Scene& scene, std::string_view id) {
    if (id == "lampSamples") return hasLargeLamp(scene);
    if (id == "shadowSize") // a relief finds its own shadow by a walk
        return scene.objects.size() > 1 || (!scene.objects.empty() && !scene.objects.front().isField());
    if (id == "pixelSamples") return scene.view.show == scene::Aov::Color;
    return hasEnvironment(scene);
}

vec2 pixelOffset(int sample, int count) {
    // Opposite ones follow each other: what is summed so far lies in the middle, too.
    const int turn = sample % 2 ? -(sample + 1) / 2 : sample / 2;
    const float row = float(turn) + (count % 2 ? 0 : 0.5f); // an even number has none in the middle
    const auto wrapped = [&](float at) { return at - std::floor(at + 0.5f); };
    return {wrapped(row / float(count)), wrapped(row * float(generatorOf(count)) / float(count))};
}

vec2 lightOffset(int sample, int count) {
    return {float(sample) / float(count), fractionOf(float(sample * generatorOf(count)) / float(count))};
}

std::vector<LampPoint> lampPoints(const scene::Scene& scene, int samples, vec2 offset) {
    std::vector<LampPoint> points;
    for (const scene::Light& light : scene.lights)
        std::visit([&](const auto& one) { add(points, one, samples, offset); }, light);
    return points;
}

LampPoint facing(LampPoint point, const vec3& place) {
    const vec3 way = point.centre - place, beside = vec3(point.place) - point.centre;
    if (point.place.w == 0 || beside == vec3(0) || way == vec3(0)) return point;
    const vec3 towards = glm::normalize(way);
    point.place = vec4(point.centre + beside - glm::dot(beside, towards) * towards, 1);
    point.source.place = point.place;
    return point;
}

light::PictureFrameBlock pictureBlock(const LampPoint& lamp) {
    return {.right = vec4(lamp.pictureRight, lamp.picture ? 1 : 0), .up = vec4(lamp.pictureUp, 0)};
}

bool hasEnvironment(const scene::Scene& scene) { return scene.environment && scene.environment->enabled; }

bool hasLargeLamp(const scene::Scene& scene) {
    return lampPoints(scene, 2).size() > lampPoints(scene, 1).size();
}

std::vector<LampPoint> lightSamples(const scene::Scene& scene, const Sampling& sampling, int sample,
                                    int samples) {
    const vec2 offset = lightOffset(sample, samples);
    std::vector<LampPoint> lights = lampPoints(scene, sampling.lamp, offset);
    if (!hasEnvironment(scene) || sampling.directions == 0) return lights;
    const bool isEven =
        sampling.environment == EnvironmentSampling::Equal; // others stand for small lights, too
    const auto directions = sampling.environment == EnvironmentSampling::Importance
                                ? importanceLights(*scene.environment, sampling.directions, sample, samples)
                                : environmentLights(*scene.environment, sampling.directions, offset);
    for (const EnvironmentLight& light : directions) {
        const vec4 place(light.direction, 0);
        const float cosine = 1 - 2 * light.weight; // of a cone of that solid angle
        lights.push_back({.place = place,
                          .color = 4 * kPi * light.weight * light.radiance,
                          .isPart = true,
                          .source = {.place = place},
                          .weight = light.weight,
                          .isEnvironment = true,
                          .extent = isEven ? std::sqrt(std::max(0.0f, 1 - cosine * cosine)) : 0,
                          .spread = light.spread});
    }
    return lights;
}

Image sampleTable(const std::vector<LampPoint>& samples, const std::optional<light::FlatWaterBlock>& water) {
    constexpr std::size_t kTexels = 5, kSamplesPerRow = 128, kPerRow = kTexels * kSamplesPerRow;
    std::size_t end =
        std::max<std::size_t>(1, (samples.size() + kSamplesPerRow - 1) / kSamplesPerRow) * kPerRow;
    std::vector<std::size_t> pictures; // where each sample's begins; 0: it has none
    for (const LampPoint& sample : samples) {
        pictures.push_back(sample.picture ? end : 0);
        if (sample.picture) end += 2 + sample.picture->pixels.size() / 3;
    }
    const std::size_t waterAt = water ? end : 0;
    if (water) end += sizeof(*water) / sizeof(vec4);
    Image table(int(kPerRow), int((end + kPerRow - 1) / kPerRow), 4);
    float* texel = table.pixels.data();
    const auto write = [&](const vec4& value) {
        for (int i = 0; i < 4; ++i)
            *texel++ = value[i];
    };
    const auto waterOf = [&](const LampPoint& sample) {
        if (sample.water == WaterPath::None) return 0.0f;
        return sample.water == WaterPath::Through ? -float(waterAt) : float(waterAt);
    };
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const LampPoint& sample = samples[i];
        write(sample.place);
        write(vec4(sample.centre, sample.fades ? 1 : 0));
        write(vec4(sample.color, sample.place.w == 0 ? waterOf(sample) : sample.exponent));
        write(vec4(sample.axis, sample.weight));
        write(vec4(sample.cone, sample.picture ? float(pictures[i]) : sample.extent, sample.part));
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!samples[i].picture) continue;
        const Image& picture = *samples[i].picture;
        texel = table.pixels.data() + 4 * pictures[i];
        write(vec4(samples[i].pictureRight, picture.width));
        write(vec4(samples[i].pictureUp, picture.height));
        for (std::size_t at = 0; at < picture.pixels.size(); at += 3)
            write(vec4(picture.pixels[at], picture.pixels[at + 1], picture.pixels[at + 2], 1));
    }
    if (water) std::memcpy(table.pixels.data() + 4 * waterAt, &*water, sizeof(*water));
    return table;
}

} // namespace lucent::views
