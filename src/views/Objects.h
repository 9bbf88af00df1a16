#pragma once
/// The objects of a scene as views draw them.

#include "views/Meshes.h"
#include "views/Surface.h"
#include "views/Water.h"

#include <vector>

namespace lucent::views {

/// The objects that a picture shows.
struct Drawn {
    std::vector<DrawnObject> fields;
    DrawnMeshes meshes;

    std::size_t count() const { return fields.size() + meshes.solid.size() + meshes.glass.size(); }
};
/// @param hiddenToo  those that the camera does not see as well
/// @param waters     the scene's, advanced to the time that is drawn
Result<Drawn> drawnOf(const scene::Scene& scene, ImageCache& images, const Waters& waters,
                      bool hiddenToo = false);

/// Every object that a picture needs, hidden ones too, as it stands.
struct Posed {
    std::vector<DrawnObject> fields;
    std::vector<PosedMesh> solid, glass;

    /// Those that the camera does not leave out.
    static std::vector<PosedMesh> visible(const std::vector<PosedMesh>& meshes);
};
/// Poses all meshes once for all passes of a graph.
///
/// @param all   with hidden ones
/// @param kept  triangles of refractive objects
Result<Posed> recordPosed(graph::FrameGraph& graph, gl::Context& context, const Drawn& all, float time,
                          KeptTriangles* kept);

/// Those refractive objects that light does not pass as if they were not there (scene::changesNoLight()).
std::vector<DrawnMesh> changingLight(const scene::Scene& scene, std::vector<DrawnMesh> glass);
std::vector<PosedMesh> changingLight(const scene::Scene& scene, std::vector<PosedMesh> glass);

/// Adds a pass that leaves an image empty.
void recordNothing(graph::FrameGraph& graph, const char* reason, graph::TextureId target);

} // namespace lucent::views
