#pragma once
/// Moves the vertices of one mesh: morph targets, then joints, then a wave. A vertex is a texel of images.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Mesh.h"
#include "scene/Scene.h"

#include <cstddef>
#include <string>
#include <vector>

namespace lucent::views {

/// Images with a texel a vertex are so wide: no GPU with WebGL2 has smaller textures.
inline constexpr int kVerticesPerRow = 2048;
/// Their size; the last row may not be full.
ivec2 vertexImageSize(std::size_t vertices);

/// A value for each vertex, RGBA32F: vertex i at (i % width, i / width), the last row filled up. What a row
/// is filled up with has length 1, as every normal has.
graph::Texture vertexTexture(gl::Device& device, const std::vector<vec3>& values, const char* label);

/// What a rig moves the vertices with, as textures; only what it moves is there.
class PoseTextures {
public:
    /// @param mesh  one that moves()
    PoseTextures(gl::Device& device, const scene::Mesh& mesh);

    bool hasTargets() const { return bool(targets_); }
    bool hasJoints() const { return bool(joints_); }
    /// Takes the pose of `rig`, which must be that of the mesh, at `time` [s] to the GPU.
    void take(gl::Device& device, const scene::Rig& rig, float time) const;
    /// What shaders/views/pose.frag samples beside the vertices at rest.
    std::vector<graph::Binding> bindings() const;
    std::size_t bytes() const;

private:
    void makeTargets(gl::Device& device, const scene::Mesh& mesh);
    void makeJoints(gl::Device& device, const scene::Mesh& mesh);

    std::vector<std::size_t> moved_;                  // targets that are there, in the rig's list
    graph::Texture targets_, weights_;                // an array of two layers a target; a texel a target
    graph::Texture joints_, jointWeights_, matrices_; // two a vertex; a row of four columns a joint
};

/// Positions and normals of a mesh's vertices, in the space of its object.
struct VertexImages {
    graph::TextureId positions, normals;
};

/// Draws the vertices as they stand at `time` [s].
///
/// @param rest  as they stand without motion, textures like `desc`
/// @param rig   null: none; the pose must have been taken
/// @param wave  null: none
/// @param name  of the object, for the reason
Result<VertexImages> recordMotion(graph::FrameGraph& graph, gl::Context& context, const VertexImages& rest,
                                  const graph::TextureDesc& desc, const PoseTextures* rig,
                                  const scene::Wave* wave, float time, const std::string& name);

/// Gives triangles their own normals again after they have moved; vertices 3i to 3i + 2 are a triangle.
Result<VertexImages> recordFlat(graph::FrameGraph& graph, gl::Context& context, const VertexImages& moved,
                                const graph::TextureDesc& desc, const std::string& name);

} // namespace lucent::views
