#pragma once
/// Triangles, and the heights that a height field can take from them.

#include "base/File.h"
#include "base/Image.h"
#include "base/Math.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lucent::scene {

struct Mesh {
    std::vector<vec3> positions;        ///< m
    std::vector<std::uint32_t> indices; ///< three a triangle, counter-clockwise seen from outside
};

/// The plain form in which meshes reach the loader: "LUCENTM1", counts, positions, indices, little-endian.
/// The readers write it from glTF, natively and in the page alike.
Bytes encodeMesh(const Mesh& mesh);
/// Error "NAME: what; expected" for truncated files and indices out of range.
Result<Mesh> decodeMesh(std::span<const std::byte> bytes, const std::string& name);

/// The mesh's depth as heights (height-field thesis 2017, 3.1.2): seen along -z after `rotation`, the
/// bounding box fitted into `size` texels with square texels and a margin of `margin` of the larger side (of
/// a narrow picture at least one texel stays free). Depth is taken exactly at texel centres; both sides of a
/// triangle count.
///
/// @param rotation  degrees about the fixed x, y, z axes
/// @return          1 channel; nearest visible point = 1, farthest = `floorGap`, background 0; all 1 where
/// the
///                  mesh is a plane seen from straight above
Image depthOfMesh(const Mesh& mesh, vec3 rotation, ivec2 size, float margin, float floorGap);

/// Heights from a normal map by least-squares integration (thesis 3.1.3 sums along paths, which depends on
/// the path): the field whose slopes between texels are nearest to the map's.
///
/// @param normals  3 channels as stored, n = 2 c - 1, +y up in the picture (OpenGL convention), texels square
/// @return         1 channel in texel widths, smallest value 0. Error where n_z <= 0 or a
///                 value is not finite, naming the texel.
Result<Image> heightsFromNormals(const Image& normals, const std::string& name);

} // namespace lucent::scene
