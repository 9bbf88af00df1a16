#pragma once
/// The triangles of refractive meshes as images, each with a number. Layered images say which triangle a
/// pixel shows; from there a ray goes over the mesh to the one that it pierces
/// (shaders/views/triangles.glsl).

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Mesh.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace lucent::views {

struct DrawnMesh;

/// A mesh whose triangles each have their last corner to themselves: flat varyings take the last vertex, so
/// that its number is the triangle's while vertices are still shared and drawn once. Vertices are copied only
/// for triangles that find all their corners taken: those of closed meshes are two for each vertex.
struct TriangleTable {
    /// No triangle, no corner. Numbers are below it: three bytes, which a float holds exactly.
    static constexpr std::uint32_t kNone = 0xffffff;
    struct Triangle {
        std::array<std::uint32_t, 2> corners{kNone, kNone}; ///< the third has the triangle's own number
        /// Beyond the edges from corner 0 to 1, 1 to 2 and 2 to 0; kNone where nothing lies there, or
        /// something the other way round. Vertices in one place are one, so that seams are no edges;
        /// triangles with two corners in one place are nobody's neighbours.
        std::array<std::uint32_t, 3> across{kNone, kNone, kNone};
    };
    std::vector<std::uint32_t> sources; ///< of each corner: which vertex it is; first all vertices themselves
    std::vector<std::uint32_t> indices; ///< three corners a triangle, in the mesh's order and sense
    std::vector<Triangle> triangles;    ///< by number; of corners that end no triangle all is kNone
};
TriangleTable tableOf(const scene::Mesh& mesh);

/// The same piece by piece, for who must not wait.
class TriangleMaking {
public:
    explicit TriangleMaking(std::shared_ptr<const scene::Mesh> mesh);
    ~TriangleMaking();
    /// One piece more, of some milliseconds; the table once it is whole.
    std::optional<TriangleTable> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The table of one mesh as textures in rows of kVerticesPerRow.
class TriangleTextures {
public:
    TriangleTextures(gl::Context& context, TriangleTable table);

    const graph::Indices& indices() const { return indices_; }
    const graph::Texture& sources() const { return sources_; } ///< R32UI
    const graph::Texture& links() const { return links_; } ///< RGBA32UI, shaders/views/triangle_links.glsl
    int count() const { return count_; }                   ///< of corners
    std::size_t bytes() const;

private:
    int count_ = 0;
    graph::Indices indices_;
    graph::Texture sources_, links_;
};

/// Corners and triangles of all refractive meshes of a frame, whatever view shows them.
struct TriangleImages {
    graph::TextureId corners; ///< RGBA32F: place in the world, packed normal of the triangle of that number
    graph::TextureId normals; ///< RGBA32F: of the corners, world, unit
    graph::TextureId links;   ///< RGBA32UI, numbers counted over all meshes
};

/// Images that outlive the frame, so that meshes that stand are put into them once.
struct KeptTriangles {
    graph::Texture corners, normals, links;
    bool current = false; ///< they hold the meshes as they stand: who keeps them says so
};

/// Puts refractive meshes into images, one behind the other, and tells each of them where.
/// Error (Fault::Machine) where a texture, or a float, cannot number so many.
///
/// @param kept  where they stay, and are only drawn where they are not current; null: images of this frame
Status recordTriangles(graph::FrameGraph& graph, gl::Context& context, const std::vector<DrawnMesh*>& meshes,
                       KeptTriangles* kept = nullptr);

/// What shaders/views/triangles.glsl samples.
void sampleTriangles(graph::PassBuilder& pass, const TriangleImages& images);
std::vector<graph::Binding> triangleBindings(const graph::Resources& resources, const TriangleImages& images);

} // namespace lucent::views
