#include "scene/CoarseMesh.h"

#include <algorithm>
#include <utility>

namespace lucent::scene {

namespace {

constexpr std::size_t kManyTriangles = 20000;

// Cells of a grid around a mesh, of the same width along all axes.
class Grid {
public:
    Grid(const std::vector<vec3>& positions, int cells) {
        for (const vec3& position : positions) {
            low_ = glm::min(low_, position);
            high_ = glm::max(high_, position);
        }
        const vec3 extent = high_ - low_;
        width_ = std::max({extent.x, extent.y, extent.z, 1e-30f}) / float(cells);
        count_ = glm::ivec3(extent / width_) + 1;
    }
    vec3 low() const { return low_; }
    vec3 high() const { return high_; }
    std::size_t size() const { return std::size_t(count_.x) * std::size_t(count_.y) * std::size_t(count_.z); }
    std::size_t cellOf(vec3 position) const {
        const glm::ivec3 cell = glm::clamp(glm::ivec3((position - low_) / width_), glm::ivec3(0), count_ - 1);
        return (std::size_t(cell.z) * std::size_t(count_.y) + std::size_t(cell.y)) * std::size_t(count_.x) +
               std::size_t(cell.x);
    }

private:
    vec3 low_{1e30f}, high_{-1e30f};
    float width_ = 1;
    glm::ivec3 count_{1};
};

// Where a mesh ends along an axis, it ends in its middles too.
void keepBounds(const std::vector<vec3>& positions, const std::vector<std::uint32_t>& clusters,
                const Grid& grid, std::vector<vec3>& middles) {
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            if (const float at = positions[i][axis]; at == grid.low()[axis] || at == grid.high()[axis])
                middles[clusters[i]][axis] = at;
}

// Triangles between clusters, each once.
std::vector<std::uint32_t> trianglesBetween(const std::vector<std::uint32_t>& indices,
                                            const std::vector<std::uint32_t>& clusters) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        std::array<std::uint32_t, 3> one{clusters[indices[i]], clusters[indices[i + 1]],
                                         clusters[indices[i + 2]]};
        if (one[0] == one[1] || one[1] == one[2] || one[2] == one[0]) continue;
        std::rotate(one.begin(), std::min_element(one.begin(), one.end()), one.end());
        triangles.push_back(one);
    }
    std::sort(triangles.begin(), triangles.end());
    triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
    std::vector<std::uint32_t> all;
    all.reserve(3 * triangles.size());
    for (const auto& one : triangles)
        all.insert(all.end(), one.begin(), one.end());
    return all;
}

// Whether something else goes by its vertices.
bool needsVertices(const Object& object) { return object.displacement || object.painting || object.bake; }

// Whether its mesh, which is made of its shape, has more cells than that.
bool hasMoreCells(const Object& object, int cells) {
    if (isPrecomputed(object)) return false; // light goes by its vertices
    if (const auto* water = std::get_if<Water>(&object.shape)) return water->cells > cells;
    const bool isFlat =
        std::holds_alternative<Plane>(object.shape) || std::holds_alternative<Box>(object.shape);
    return !isFlat || object.wave.amplitude != vec3(0);
}

bool isCoarsened(const MeshShape& file) {
    const Mesh& mesh = *file.mesh;
    return !file.flatNormals && mesh.indices.size() > 3 * kManyTriangles && mesh.coordinates.empty() &&
           mesh.colors.empty() && mesh.rig.nodes.empty();
}

// Every n-th height, so that there are still twice as many as cells along the longest side. @return n
int strideOf(const Image& heights, int cells) {
    int stride = 1;
    const auto leaves = [&](int every) {
        return heights.width % every == 0 && heights.height % every == 0 &&
               std::max(heights.width, heights.height) / every >= 2 * cells;
    };
    while (leaves(2 * stride))
        stride *= 2;
    return stride;
}

Image fewerHeights(const Image& heights, int cells) {
    const int stride = strideOf(heights, cells);
    Image fewer(heights.width / stride, heights.height / stride, 1);
    for (int y = 0; y < fewer.height; ++y)
        for (int x = 0; x < fewer.width; ++x)
            *fewer.at(x, y) = *heights.at(x * stride + stride / 2, y * stride + stride / 2);
    return fewer;
}

// What is kept with an object of what its mesh is made of.
template <class Source, class Make>
std::shared_ptr<const Source> coarseOf(const Object& object, const std::shared_ptr<const Source>& source,
                                       int cells, const Make& make) {
    return object.kept.of<std::shared_ptr<const Source>>(
        std::pair(source, cells), [&] { return std::make_shared<const Source>(make(*source, cells)); });
}

} // namespace

Mesh coarseMesh(const Mesh& mesh, int cells) {
    if (mesh.positions.empty()) return {};
    const std::vector<vec3> normals =
        mesh.normals.empty() ? areaWeightedNormals(mesh.positions, mesh.indices) : mesh.normals;
    const Grid grid(mesh.positions, cells);
    constexpr std::uint32_t kNone = ~0u;
    std::vector<std::uint32_t> inCell(grid.size(), kNone), clusters(mesh.positions.size());
    Mesh coarse;
    std::vector<float> counts;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        std::uint32_t& cluster = inCell[grid.cellOf(mesh.positions[i])];
        if (cluster == kNone) {
            cluster = std::uint32_t(counts.size());
            coarse.positions.emplace_back(0);
            coarse.normals.emplace_back(0);
            counts.push_back(0);
        }
        clusters[i] = cluster;
        coarse.positions[cluster] += mesh.positions[i];
        coarse.normals[cluster] += normals[i];
        ++counts[cluster];
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
        coarse.positions[i] =
            glm::clamp(coarse.positions[i] / counts[i], grid.low(), grid.high()); // rounding
        const float length = glm::length(coarse.normals[i]);
        coarse.normals[i] = length > 0 ? coarse.normals[i] / length : vec3(0, 1, 0);
    }
    keepBounds(mesh.positions, clusters, grid, coarse.positions);
    coarse.indices = trianglesBetween(mesh.indices, clusters);
    return coarse;
}

void coarsen(Scene& scene, int cells) {
    for (Object& object : scene.objects) {
        if (needsVertices(object) || object.isField()) continue;
        auto* file = std::get_if<MeshShape>(&object.shape);
        auto* body = std::get_if<HeightField>(&object.shape);
        if (!file && !body)
            object.mostCells = hasMoreCells(object, cells) ? cells : 0;
        else if (object.material.isScattering())
            continue;
        else if (body && strideOf(*body->heights, cells) > 1)
            body->heights = coarseOf(object, body->heights, cells, fewerHeights);
        else if (file && isCoarsened(*file))
            file->mesh = coarseOf(object, file->mesh, cells, coarseMesh);
    }
}

} // namespace lucent::scene
