#pragma once
/// A place in a square picture for every place of a surface: where paint is kept.

#include "scene/Mesh.h"

#include <memory>
#include <vector>

namespace lucent::scene {

/// Charts of a mesh side by side in a square of `side` texels.
struct Atlas {
    std::shared_ptr<const Mesh> mesh; ///< the same triangles in the same order with the same normals and rig;
                                      ///< vertices are parted where charts end
    std::vector<vec2> places; ///< one a vertex of `mesh`, in texels from the picture's upper left corner: the
                              ///< middle of texel (x, y) is (x + 0.5, y + 0.5)
    int side = 0;
};

/// Parts the mesh into charts on which no two places meet, at one scale, with a texel between them that
/// belongs to neither's inside, so that bilinear reading never crosses. Depends on the mesh as it is bound
/// and on `side` alone.
///
/// @param side  texels, [16, 4096]
/// @return      Error for meshes with more charts than the picture holds
Result<std::shared_ptr<const Atlas>> atlasOf(const Mesh& mesh, int side);
/// That of an object's mesh, made once and kept with the object.
Result<std::shared_ptr<const Atlas>> atlasOf(const Object& object, int side);

} // namespace lucent::scene
