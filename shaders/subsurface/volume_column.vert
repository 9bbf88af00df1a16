// subsurface/volume_column.vert: see views/mesh_vertex.glsl.
#include "views/mesh_vertex.glsl"
