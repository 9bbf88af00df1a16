#pragma once
/// A place in a square picture for every place of a surface: where paint is kept.

#include "scene/Mesh.h"

#include <memory>
#include <optional>
#include <vector>

namespace lucent::scene {

/// Charts of a mesh side by side in a square of `side` texels.
struct Atlas {
    std::shared_ptr<const Mesh> mesh; ///< the same triangles in the same order with the same normals and rig;
                                      ///< vertices are parted where charts end
    std::vector<vec2> places; ///< one a vertex of `mesh`, in texels from the picture's upper left corner: the
                              ///< middle of texel (x, y) is (x + 0.5, y + 0.5)
    int side = 0;
    double scale = 0; ///< texels a metre of what lies in its chart's plane
};

/// Parts the mesh into charts on which no two places meet, at one scale, with a texel between them that
/// belongs to neither's inside, so that bilinear reading never crosses. Depends on the mesh as it is bound
/// and on `side` alone.
///
/// @param side  texels, [16, 4096]
/// @return      Error for meshes with more charts than the picture holds
Result<std::shared_ptr<const Atlas>> atlasOf(const Mesh& mesh, int side);
/// How a mesh is parted.
struct Charting {
    int side = 512;      ///< texels, [16, 4096]
    double cosine = 0.5; ///< least between the normals of a triangle and its chart's plane, [0.5, 1)
    int border = 1;      ///< texels around each chart's box that are no other chart's, > 0
    /// Charts lie in planes across the mean normal of their triangles, turned such that their boxes are as
    /// small as can be, instead of along the axes of the mesh.
    bool fitted = false;
    bool operator==(const Charting&) const = default;
};
/// Makes one piece by piece, for who must not wait.
class AtlasMaking {
public:
    using Made = Result<std::shared_ptr<const Atlas>>;
    AtlasMaking(std::shared_ptr<const Mesh> mesh, const Charting& charting);
    ~AtlasMaking();
    /// One piece more; the atlas once it is whole.
    std::optional<Made> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};
/// The same in other ways: the one above is Charting{side}.
Result<std::shared_ptr<const Atlas>> atlasOf(const Mesh& mesh, const Charting& charting);
/// That of an object's mesh, made once and kept with the object.
Result<std::shared_ptr<const Atlas>> atlasOf(const Object& object, int side);

} // namespace lucent::scene
