#include "scene/HeightSource.h"

#include "scene/ImageUse.h"
#include "scene/Mesh.h"

#include <algorithm>

namespace lucent::scene {
namespace {

Result<SourcedHeights> fromHeights(std::span<const std::byte> bytes, const std::string& name) {
    Result<std::shared_ptr<const Image>> heights = decodeHeights(bytes, name);
    if (!heights) return heights.error();
    return SourcedHeights{*heights};
}

Result<SourcedHeights> fromNormals(std::span<const std::byte> bytes, const std::string& name) {
    const Result<Image> normals = decodeImage(bytes, name, Encoding::Linear);
    if (!normals) return normals.error();
    return heightsOfNormals(*normals, name);
}

Result<SourcedHeights> fromMesh(const HeightSource& source, std::span<const std::byte> bytes,
                                const std::string& name) {
    const Result<Mesh> mesh = decodeMesh(bytes, name);
    if (!mesh) return mesh.error();
    return SourcedHeights{std::make_shared<Image>(
        depthOfMesh(*mesh, source.meshRotate, source.resolution, source.margin, source.floorGap))};
}

} // namespace

Result<SourcedHeights> heightsOfNormals(const Image& normals, const std::string& name) {
    Result<Image> heights = heightsFromNormals(normals, name);
    if (!heights) return heights.error();
    const float highest = *std::max_element(heights->pixels.begin(), heights->pixels.end());
    if (highest > 0)
        for (float& height : heights->pixels)
            height /= highest;
    return SourcedHeights{std::make_shared<Image>(std::move(*heights)), highest};
}

Result<SourcedHeights> loadHeights(const HeightSource& source, std::span<const std::byte> bytes,
                                   const std::string& name) {
    if (source.kind == HeightSource::Kind::NormalMap) return fromNormals(bytes, name);
    return source.kind == HeightSource::Kind::Mesh ? fromMesh(source, bytes, name) : fromHeights(bytes, name);
}

void digHoles(HeightField& field) {
    const Image& heights = *field.heights;
    const Image& alpha = *field.alpha;
    const float side = std::max(field.footprint().x, field.footprint().y);
    const float depth = side / std::max(field.heightScale, 1e-4f * side);
    const float bottom = *std::min_element(heights.pixels.begin(), heights.pixels.end()) - depth;
    auto dug = std::make_shared<Image>(heights);
    for (int y = 0; y < heights.height; ++y)
        for (int x = 0; x < heights.width; ++x) {
            const int alphaX =
                (2 * x + 1) * alpha.width / (2 * heights.width); // below both limits: 16384^2 * 2
            const int alphaY = (2 * y + 1) * alpha.height / (2 * heights.height);
            if (*alpha.at(alphaX, alphaY) < 0.5f) *dug->at(x, y) = bottom;
        }
    field.heights = dug;
}

} // namespace lucent::scene
