#include "truth/RenderRelief.h"

#include "truth/ColorMap.h"

#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>

namespace lucent::truth {

namespace {
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kTwoPi = 2 * std::numbers::pi;

/// Rotation about the fixed x, then y, then z axis.
glm::dmat3 rotation(vec3 degrees) {
    const auto about = [](double angle, int first, int second) {
        glm::dmat3 turn(1);
        turn[first][first] = turn[second][second] = std::cos(angle);
        turn[first][second] = std::sin(angle);
        turn[second][first] = -std::sin(angle);
        return turn;
    };
    const dvec3 angles = dvec3(degrees) * (kTwoPi / 360);
    return about(angles.z, 0, 1) * about(angles.y, 2, 0) * about(angles.x, 1, 2);
}

/// Direction on a lat-long map, turns from its left edge and cosine of the polar angle: row 0 is +y, the
/// centre column -z, to the right of it +x.
dvec3 mapDirection(double turns, double cosine) {
    const double azimuth = kTwoPi * (turns - 0.5), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    return {sine * std::sin(azimuth), cosine, -sine * std::cos(azimuth)};
}

/// Part of a lat-long map between two meridians (in turns) and two parallels (cosine of the polar angle).
struct SkyCell {
    double left, right, top, bottom;
    /// Share of the whole sphere.
    double weight() const { return (right - left) * (top - bottom) / 2; }
    /// Its middle by area; a cell all around a pole or the globe's belt has it on the axis.
    dvec3 direction() const {
        if (right - left == 1) return {0, top + bottom >= 0 ? 1 : -1, 0};
        return mapDirection((left + right) / 2, (top + bottom) / 2);
    }
};

/// The sphere in `count` cells of equal area: belts of about equal angle, each cut into about square cells.
std::vector<SkyCell> equalCells(int count) {
    std::vector<SkyCell> cells;
    const int belts = std::max(1, int(std::lround(std::sqrt(count * std::numbers::pi / 4))));
    const auto cellsAbove = [&](int belt) {
        return int(std::lround(count * (1 - std::cos(std::numbers::pi * belt / belts)) / 2));
    };
    for (int belt = 0; belt < belts; ++belt) {
        const int first = cellsAbove(belt), last = cellsAbove(belt + 1);
        const double top = 1 - 2.0 * first / count, bottom = 1 - 2.0 * last / count, columns = last - first;
        for (int column = 0; column < last - first; ++column)
            cells.push_back({column / columns, (column + 1) / columns, top, bottom});
    }
    return cells;
}

/// Cosine of the polar angle at the upper edge of a map's row.
double rowEdge(const Image& map, int row) { return std::cos(std::numbers::pi * row / map.height); }

/// Mean radiance of a map over a cell; every pixel counts with the solid angle of its part inside.
dvec3 meanRadiance(const Image& map, const SkyCell& cell) {
    dvec3 sum{0};
    double weights = 0;
    for (int y = 0; y < map.height; ++y) {
        const double tall = std::min(cell.top, rowEdge(map, y)) - std::max(cell.bottom, rowEdge(map, y + 1));
        if (tall <= 0) continue;
        const int first = int(cell.left * map.width), last = int(std::ceil(cell.right * map.width));
        for (int x = first; x < std::min(last, map.width); ++x) {
            const double wide =
                std::min(cell.right, double(x + 1) / map.width) - std::max(cell.left, double(x) / map.width);
            const float* pixel = map.at(x, y);
            sum += wide * tall * dvec3(pixel[0], pixel[1], pixel[2]);
            weights += wide * tall;
        }
    }
    return sum / weights;
}
} // namespace

std::vector<LightSource> environmentLights(const scene::Environment& environment, int count) {
    const Image& map = *environment.map;
    const glm::dmat3 worldFromMap = rotation(environment.rotation);
    std::vector<LightSource> lights;
    for (const SkyCell& cell : equalCells(count)) {
        LightSource light;
        light.place = worldFromMap * cell.direction();
        light.distant = true;
        light.weight = cell.weight();
        light.color = double(environment.intensity) * light.weight * meanRadiance(map, cell);
        lights.push_back(light);
    }
    return lights;
}

std::optional<SurfacePoint> firstHit(const Field& field, const Ray& ray, Stretch stretch) {
    const double hit = firstInside(field, ray, stretch);
    const dvec3 place = ray.anchor + ray.offset + hit * ray.direction;
    if (hit == kInfinity || hit == stretch.from) return {};
    if (hit > field.overFootprint(ray, stretch).from) return field.pointAbove(dvec2(place));
    if (place.z < field.bottom()) return {};

    const dvec2 gap = field.half() - glm::abs(dvec2(place));
    const int axis = gap.x < gap.y ? 0 : 1;
    SurfacePoint wall{place, dvec3(0)};
    wall.normal[axis] = place[axis] > 0 ? 1 : -1;
    wall.position[axis] = wall.normal[axis] * field.half()[axis];
    return wall;
}

namespace {
/// An object with its field and the lights in its own space.
struct Placed {
    const scene::Object* object;
    Field field;
    glm::dmat3 objectFromWorld; ///< rotation only
    std::vector<LightSource> lights;

    dvec3 pointFromWorld(const dvec3& point) const {
        const scene::Transform& transform = object->transform;
        return objectFromWorld * (point - dvec3(transform.translate)) / double(transform.scale);
    }
};

std::vector<LightSource> worldLights(const scene::Scene& scene, const ReliefOptions& options) {
    std::vector<LightSource> lights;
    for (const scene::Light& light : scene.lights) {
        LightSource source;
        if (const auto* point = std::get_if<scene::PointLight>(&light)) {
            source.place = dvec3(point->position);
            source.inverseSquare = point->falloff == scene::LightFalloff::InverseSquare;
            source.color = double(point->intensity) * dvec3(point->color);
        } else if (const auto* sun = std::get_if<scene::DistantLight>(&light)) {
            source.place = -glm::normalize(dvec3(sun->direction));
            source.distant = true;
            source.color = double(sun->irradiance) * dvec3(sun->color);
        }
        lights.push_back(source);
    }
    std::size_t count = lights.size();
    if (scene.environment && scene.environment->enabled) {
        const auto environment = environmentLights(*scene.environment, options.environmentLights);
        lights.insert(lights.end(), environment.begin(), environment.end());
        ++count;
    }
    if (options.normalise)
        for (LightSource& light : lights)
            light.color /= double(count);
    return lights;
}

Placed place(const scene::Object& object, std::span<const LightSource> lights) {
    Placed placed{&object, Field(object.shape), glm::transpose(rotation(object.transform.rotate)), {}};
    for (LightSource light : lights) {
        light.place =
            light.distant ? placed.objectFromWorld * light.place : placed.pointFromWorld(light.place);
        placed.lights.push_back(light);
    }
    return placed;
}

/// Camera rays in world space. Orthographic ones come from infinity.
struct Eye {
    dvec3 origin, forward, right, up;
    dvec2 extent; ///< half width and height of the picture: metres, or per metre of distance
    bool perspective;

    Eye(const scene::Camera& camera, ivec2 size)
        : origin(camera.eye), forward(glm::normalize(dvec3(camera.target) - dvec3(camera.eye))),
          right(glm::normalize(glm::cross(forward, dvec3(camera.up)))), up(glm::cross(right, forward)),
          perspective(camera.type == scene::Camera::Type::Perspective) {
        const double half =
            perspective ? std::tan(double(camera.fov) * kTwoPi / 720) : double(camera.height) / 2;
        extent = half * dvec2(double(size.x) / size.y, 1);
    }
    /// @param place  [-1,1] each, y up
    Ray ray(dvec2 place) const {
        const dvec3 aside = place.x * extent.x * right + place.y * extent.y * up;
        if (perspective) return {origin, dvec3(0), glm::normalize(forward + aside)};
        return {origin, aside, forward};
    }
};

/// What a ray sees first.
struct Sight {
    const Placed* object = nullptr;
    SurfacePoint point{};
    double distance = kInfinity; ///< m in the world, from where the ray is measured
    double coverage = 0;
};

/// Place on a map that is stretched over the footprint, (0, 0) at its first texel's outer corner.
dvec2 onMap(const Field& field, const dvec3& position) {
    return dvec2(position.x + field.half().x, field.half().y - position.y) / (2.0 * field.half());
}

Sight look(const Ray& ray, bool perspective, std::span<const Placed> objects) {
    Sight nearest;
    for (const Placed& placed : objects) {
        // Measured from the place on the ray that is nearest to the object's origin, where digits are
        // densest.
        const dvec3 direction = placed.objectFromWorld * ray.direction;
        const dvec3 origin = placed.pointFromWorld(ray.anchor + ray.offset);
        const double foot = -glm::dot(origin, direction);
        const Ray local{dvec3(0), origin + foot * direction, direction};
        const auto hit = firstHit(placed.field, local, {perspective ? -foot : -kInfinity, kInfinity});
        if (!hit) continue;
        const Image* alpha = placed.object->shape.alpha.get();
        const double coverage = sampleMap(alpha, onMap(placed.field, hit->position)).x;
        const double distance =
            glm::dot(hit->position - origin, direction) * double(placed.object->transform.scale);
        if (coverage > 0 && distance < nearest.distance) nearest = {&placed, *hit, distance, coverage};
    }
    return nearest;
}

/// The picture's value at one ray: red, green, blue, coverage.
glm::dvec4 trace(const Ray& ray, bool perspective, std::span<const Placed> objects, scene::Aov aov,
                 Attenuation attenuation) {
    const Sight sight = look(ray, perspective, objects);
    if (!sight.object) return glm::dvec4(0);
    const Placed& placed = *sight.object;
    dvec3 eyeDirection = placed.objectFromWorld * ray.direction;
    if (perspective) {
        const double depth = depthInObject(*placed.object);
        const dvec3 below = sight.point.position - depth * sight.point.normal;
        eyeDirection = glm::normalize(below - placed.pointFromWorld(ray.anchor + ray.offset));
    }
    const Shading shading =
        shade(placed.field, *placed.object, sight.point, eyeDirection, placed.lights, attenuation);
    return {aov == scene::Aov::Color ? shading.color : dvec3(shading.illumination), sight.coverage};
}

void renderRow(Image& image, int y, const Eye& eye, std::span<const Placed> objects, scene::Aov aov,
               Attenuation attenuation, const std::atomic<bool>& cancel) {
    for (int x = 0; x < image.width && !cancel; ++x) {
        const dvec2 place = 2.0 * (dvec2(x, y) + 0.5) / dvec2(image.size()) - 1.0;
        const glm::dvec4 value =
            trace(eye.ray({place.x, -place.y}), eye.perspective, objects, aov, attenuation);
        for (int channel = 0; channel < 4; ++channel)
            image.at(x, y)[channel] = float(value[channel]);
    }
}
} // namespace

Result<Image> renderRelief(const scene::Scene& scene, ivec2 size, scene::Aov aov,
                           const ReliefOptions& options, const std::function<void(double)>& progress,
                           const std::atomic<bool>& cancel) {
    if (aov != scene::Aov::Color && aov != scene::Aov::Illumination)
        return Error{"truth: AOV \"" + std::string(scene::aovNames()[std::size_t(aov)]) +
                     "\" has no reference; must be color or d"};
    const std::vector<LightSource> lights = worldLights(scene, options);
    std::vector<Placed> objects;
    for (const scene::Object& object : scene.objects)
        if (object.visible) objects.push_back(place(object, lights));

    const Eye eye(scene.camera, size);
    Image image(size.x, size.y, 4);
    std::atomic<int> nextRow = 0, doneRows = 0;
    const auto work = [&] {
        for (int y; !cancel && (y = nextRow++) < size.y; ++doneRows)
            renderRow(image, y, eye, objects, aov, options.attenuation, cancel);
    };
    const int count =
        options.threads > 0 ? options.threads : int(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::thread> workers;
    for (int i = 0; i < count; ++i)
        workers.emplace_back(work);
    while (!cancel && doneRows < size.y) {
        progress(double(doneRows) / size.y);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    for (std::thread& worker : workers)
        worker.join();
    if (cancel) return Error{"truth: stopped before the picture was complete", Fault::Machine};
    progress(1);
    return image;
}

} // namespace lucent::truth
