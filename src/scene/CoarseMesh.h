#pragma once
/// Meshes with fewer triangles, for previews.

#include "scene/Mesh.h"

namespace lucent::scene {

/// The same surface by fewer triangles: vertices that share a cell of a grid become one in their middle, and
/// triangles that keep less than three go (vertex clustering, Rossignac and Borrel 1993). It has the same
/// bounds.
///
/// @param cells  of the grid along the longest side of the mesh, 1 to 256
/// @return       positions, indices and normals alone; of no vertex: nothing
Mesh coarseMesh(const Mesh& mesh, int cells);

/// Gives objects that are meshes of files with many triangles such ones, bodies of height fields fewer
/// heights, and bounds the meshes of shapes (Object::mostCells). Those stay as they are by whose vertices
/// something else goes: textures, paint, displacement, subsurface scattering, what is worked out beforehand,
/// a rig, flat normals.
void coarsen(Scene& scene, int cells);

} // namespace lucent::scene
