#include "truth/Paint.h"

#include "scene/Painting.h"
#include "truth/Optics.h"

#include <algorithm>
#include <cmath>

namespace lucent::truth {

namespace {
glm::dvec4 texel(const Image& map, int x, int y) {
    const float* value = map.at(std::clamp(x, 0, map.width - 1), std::clamp(y, 0, map.height - 1));
    return {value[0], value[1], value[2], value[3]};
}

/// @param place  texels from the upper left corner
glm::dvec4 bilinear(const Image& map, const dvec2& place) {
    const dvec2 from = glm::floor(place - 0.5), part = place - 0.5 - from;
    const int x = int(from.x), y = int(from.y);
    return glm::mix(glm::mix(texel(map, x, y), texel(map, x + 1, y), part.x),
                    glm::mix(texel(map, x, y + 1), texel(map, x + 1, y + 1), part.x), part.y);
}
} // namespace

PaintedSurface::PaintedSurface(std::shared_ptr<const scene::Painting> painting, RayScene mesh,
                               std::vector<dvec2> places)
    : painting_(std::move(painting)), mesh_(std::move(mesh)), places_(std::move(places)) {}

Result<PaintedSurface> PaintedSurface::create(const scene::Object& object, double time) {
    const auto atlas = scene::atlasOf(object, object.painting->side());
    if (!atlas) return atlas.error();
    scene::Object parted = object;
    scene::MeshShape shape;
    shape.mesh = (*atlas)->mesh;
    parted.shape = std::move(shape);
    std::vector<Shape> shapes = {surfaceOf(parted, time)};
    Result<RayScene> mesh = RayScene::create(std::move(shapes));
    if (!mesh) return mesh.error();
    return PaintedSurface(object.painting, std::move(*mesh),
                          {(*atlas)->places.begin(), (*atlas)->places.end()});
}

Paint PaintedSurface::at(const dvec3& place) const {
    const auto nearest = mesh_.nearest(place);
    if (!nearest) return {};
    const std::uint32_t* corner = &std::get<Triangles>(mesh_.shape(0)).indices[3 * nearest->triangle];
    dvec2 on(0);
    for (int i = 0; i < 3; ++i)
        on += nearest->weights[i] * places_[corner[i]];
    const glm::dvec4 entering = bilinear(*painting_->entering, on),
                     leaving = bilinear(*painting_->leaving, on);
    return {dvec3(entering), entering.w, dvec3(leaving), leaving.w};
}

dvec2 PaintedSurface::sharpness() const {
    const Image& map = *painting_->entering;
    dvec2 range(scene::kMostSharpness, scene::kLeastSharpness);
    for (std::size_t i = 3; i < map.pixels.size(); i += 4)
        range = {std::min(range.x, double(map.pixels[i])), std::max(range.y, double(map.pixels[i]))};
    return range;
}

} // namespace lucent::truth
