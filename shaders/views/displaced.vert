// views/displaced.vert: see views/prism_hull.glsl.
#include "views/prism_hull.glsl"
