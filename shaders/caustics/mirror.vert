// caustics/mirror.vert: everywhere; PIXELS: where no beam carries light.
#ifdef PIXELS
#include "caustics/lone_cells.glsl"
uniform sampler2D uSurface;
void main() { drawLoneCell(textureSize(uSurface, 0).x); }
#else
#include "lib/screen.vert"
#endif
