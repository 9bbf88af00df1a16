// views/textured.vert: see views/mesh_vertex.glsl.
#include "views/mesh_vertex.glsl"
