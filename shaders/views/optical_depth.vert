// views/optical_depth.vert: see views/mesh_vertex.glsl.
#include "views/mesh_vertex.glsl"
