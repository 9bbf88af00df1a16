#pragma once
/// Meshes on the GPU: a texel a vertex, so that what moves is an image that a pass draws.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Mesh.h"
#include "scene/Scene.h"
#include "views/Eye.h"
#include "views/Paint.h"
#include "views/Pose.h"
#include "views/Triangles.h"
#include "views/Water.h"

#include <memory>
#include <optional>
#include <vector>

namespace lucent::views {

class ImageCache;

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
    /// Null for a mesh that does not move.
    const PoseTextures* pose() const { return pose_ ? &*pose_ : nullptr; }
    /// Makes triangles() once: only refractive objects need them.
    void addTriangles(gl::Context& context);
    const TriangleTextures* triangles() const { return triangles_ ? &*triangles_ : nullptr; }
    std::size_t bytes() const;

private:
    std::shared_ptr<const scene::Mesh> source_; // its address is the cache's key: it must not be reused
    graph::Texture positions_, normals_;
    graph::Indices indices_;
    std::optional<PoseTextures> pose_;
    std::optional<TriangleTextures> triangles_;
};

/// A mesh of the scene.
struct DrawnMesh {
    const scene::Object* object = nullptr;
    int index = 0; ///< in the scene
    const MeshTextures* mesh = nullptr;
    const WaterSheet* water = nullptr; ///< of water that moves
    std::optional<Paint> paint{};      ///< of painted objects, whose mesh is their atlas'
};

/// Which objects a view shows.
struct DrawnMeshes {
    std::vector<DrawnMesh> solid; ///< opaque ones and mirrors
    std::vector<DrawnMesh> glass; ///< refractive ones
};
/// @param hiddenToo  those that the camera does not see as well
/// @param waters     the scene's, advanced to the time that is drawn; null: water lies still
Result<DrawnMeshes> drawnMeshes(const scene::Scene& scene, ImageCache& images, bool hiddenToo = false,
                                const Waters* waters = nullptr);

/// A mesh as it stands in this frame.
struct PosedMesh {
    DrawnMesh drawn;
    graph::TextureId positions, normals; ///< object space
    TriangleImages triangles{};          ///< of refractive meshes; the same for all
    int firstCorner = 0;                 ///< where this one's begin in them
};
/// Moves the vertices of what moves, for all views of the frame alike: one pass a mesh (two with flat
/// normals), none for what stands, and one for the triangles of all that is refractive. The graph must run
/// before this is called for another time: rigs are on the GPU in one pose.
///
/// @param kept  of recordTriangles()
Result<std::vector<PosedMesh>> recordPose(graph::FrameGraph& graph, gl::Context& context,
                                          const std::vector<DrawnMesh>& meshes, float time,
                                          KeptTriangles* kept = nullptr);

/// The box around all of them in world space, at any time.
Bounds boundsOfAll(const std::vector<DrawnMesh>& meshes);
Bounds boundsOfAll(const std::vector<PosedMesh>& meshes);

/// Draws one mesh with shaders/views/mesh_vertex.glsl.
///
/// @param number  by which the shader calls it
/// @param draw    how, and what else is bound
void drawMesh(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
              const PosedMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw);
/// The same for a refractive mesh with its numbered triangles (shaders/views/peel.vert).
void drawTriangles(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
                   const PosedMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw);

} // namespace lucent::views
