#pragma once
/// Meshes on the GPU: a texel a vertex, so that what moves is an image that a pass draws.

#include "scene/Mesh.h"
#include "views/Drawable.h"
#include "views/Paint.h"
#include "views/Pose.h"
#include "views/Triangles.h"
#include "views/Water.h"

#include <memory>
#include <optional>

namespace lucent::views {

/// The box around a mesh in its own space; remembered for the last few meshes.
Bounds meshBounds(const scene::Mesh& mesh);

/// A mesh as textures: as it is bound to what moves it, or, where nothing does, as its rig holds it.
class MeshTextures {
public:
    MeshTextures(gl::Context& context, std::shared_ptr<const scene::Mesh> mesh);

    const scene::Mesh& source() const { return *source_; }
    const graph::Texture& positions() const { return positions_; } ///< as vertexTexture() has them
    const graph::Texture& normals() const { return normals_; }
    const graph::Indices& indices() const { return indices_; }
    /// Makes coordinates() and colors() once: only textures need them.
    void addCoordinates(gl::Context& context);
    const graph::Texture& coordinates() const { return coordinates_; } ///< as coordinateTexture() has them
    const graph::Texture& colors() const {
        return colors_;
    } ///< as vertexTexture() has them; without, a white row
    /// Null for a mesh that does not move.
    const PoseTextures* pose() const { return pose_ ? &*pose_ : nullptr; }
    /// Makes triangles() once: only refractive objects need them.
    void addTriangles(gl::Context& context);
    /// The same piece by piece. @return whether there was more to do
    bool addTrianglesPart(gl::Context& context);
    const TriangleTextures* triangles() const { return triangles_ ? &*triangles_ : nullptr; }
    std::size_t bytes() const;

private:
    std::shared_ptr<const scene::Mesh> source_; // its address is the cache's key: it must not be reused
    graph::Texture positions_, normals_, coordinates_, colors_;
    graph::Indices indices_;
    std::optional<PoseTextures> pose_;
    std::optional<TriangleTextures> triangles_;
    std::unique_ptr<TriangleMaking> making_; // of those, begun
};

/// A mesh of the scene; water is one whose vertices a sheet moves.
struct DrawnMesh final : Drawable {
    using Drawable::Drawable;
    static Result<Ptr> create(const scene::Object& object, int index, ImageCache& images,
                              const Waters* waters);

    const MeshTextures* textures = nullptr;
    const MeshTextures* caster = nullptr; ///< what stands in the light's way; null: the same
    const WaterSheet* water = nullptr;    ///< of water that moves
    std::optional<Paint> paint{};         ///< of painted objects, whose mesh is their atlas'

    // as it stands in this frame; see posed()
    graph::TextureId positions, normals; ///< object space
    TriangleImages triangles{};          ///< of refractive meshes; the same for all
    int firstCorner = 0;                 ///< where this one's begin in them

    /// Declares that a pass reads its vertices.
    void sampleFrom(graph::PassBuilder& pass) const;

    const DrawnMesh* mesh() const override { return this; }
    /// One pass (two with flat normals) where it moves, none where it stands.
    Result<Ptr> posed(graph::FrameGraph& graph, gl::Context& context, float time,
                      std::vector<DrawnMesh*>& refractive) const override;
    Drawing drawing(gl::Context& context, graph::PassBuilder& pass, ViewKind kind, int number,
                    std::vector<std::string> defines) const override;
};

/// Draws one mesh with shaders/views/mesh_vertex.glsl.
///
/// @param number  by which the shader calls it
/// @param draw    how, and what else is bound
void drawMesh(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
              const DrawnMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw);

} // namespace lucent::views
