#include "scene/HeightSource.h"

#include "scene/ImageUse.h"
#include "scene/Mesh.h"

#include <algorithm>

namespace lucent::scene {
namespace {

SourcedHeights fromIntegration(Image heights) {
    const float highest = *std::max_element(heights.pixels.begin(), heights.pixels.end());
    if (highest > 0)
        for (float& height : heights.pixels)
            height /= highest;
    return {std::make_shared<Image>(std::move(heights)), highest};
}

} // namespace

Result<SourcedHeights> heightsOfNormals(const Image& normals, const std::string& name) {
    Result<Image> heights = heightsFromNormals(normals, name);
    if (!heights) return heights.error();
    return fromIntegration(std::move(*heights));
}

struct HeightsMaking::State {
    HeightSource source;
    std::string name;
    ReadFile read;
    std::unique_ptr<ImageReading> reading{};
    std::optional<Image> map{};
    std::optional<Mesh> mesh{};
    std::unique_ptr<NormalsIntegration> normals{};
    std::optional<DepthMaking> depth{};

    // The file is the first piece.
    std::optional<Result<SourcedHeights>> begin() {
        Result<Bytes> bytes = read(name);
        if (!bytes) return bytes.error();
        if (source.kind == HeightSource::Kind::Mesh) return beginMesh(*bytes);
        reading = std::make_unique<ImageReading>(std::move(*bytes), name, Encoding::Linear);
        return std::nullopt;
    }
    std::optional<Result<SourcedHeights>> readSome() {
        std::optional<Result<Image>> decoded = reading->advance();
        if (!decoded) return std::nullopt;
        if (!*decoded) return Result<SourcedHeights>(decoded->error());
        map = std::move(**decoded);
        return std::nullopt;
    }
    std::optional<Result<SourcedHeights>> beginMesh(std::span<const std::byte> bytes) {
        Result<Mesh> decoded = decodeShape(bytes, name);
        if (!decoded) return decoded.error();
        mesh = std::move(*decoded);
        return std::nullopt;
    }
    std::optional<Result<SourcedHeights>> advance() {
        if (normals) {
            std::optional<Result<Image>> made = normals->advance();
            if (!made) return std::nullopt;
            return *made ? Result<SourcedHeights>(fromIntegration(std::move(**made))) : made->error();
        }
        if (map && source.kind == HeightSource::Kind::Heights) {
            const Result<std::shared_ptr<const Image>> heights = heightsOf(*map, name);
            return heights ? SourcedHeights{*heights} : Result<SourcedHeights>(heights.error());
        }
        if (map) {
            normals = std::make_unique<NormalsIntegration>(*map, name);
            map.reset();
            reading.reset();
            return std::nullopt;
        }
        if (mesh) {
            depth.emplace(*mesh, source.meshRotate, source.resolution, source.margin, source.floorGap);
            mesh.reset();
            return std::nullopt;
        }
        if (reading) return readSome();
        if (!depth) return begin();
        std::optional<Image> made = depth->advance();
        if (!made) return std::nullopt;
        return SourcedHeights{std::make_shared<Image>(std::move(*made))};
    }
};

HeightsMaking::HeightsMaking(HeightSource source, std::string name, ReadFile read)
    : state_(std::make_unique<State>(State{std::move(source), std::move(name), std::move(read)})) {}
HeightsMaking::~HeightsMaking() = default;

std::optional<Result<SourcedHeights>> HeightsMaking::advance() { return state_->advance(); }

Result<SourcedHeights> loadHeights(const HeightSource& source, std::span<const std::byte> bytes,
                                   const std::string& name) {
    HeightsMaking making(source, name, [&](const std::string&) { return Bytes(bytes.begin(), bytes.end()); });
    for (;;)
        if (std::optional<Result<SourcedHeights>> made = making.advance()) return std::move(*made);
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
