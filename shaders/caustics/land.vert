// caustics/land.vert: everywhere; PIXELS: where no beam carries light.
#ifdef PIXELS
#include "caustics/lone_cells.glsl"
uniform sampler2D uPlace;
void main() { drawLoneCell(textureSize(uPlace, 0).x); }
#else
#include "lib/screen.vert"
#endif
