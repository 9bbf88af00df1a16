// views/voxel_slice.vert: see views/mesh_vertex.glsl.
#include "views/mesh_vertex.glsl"
