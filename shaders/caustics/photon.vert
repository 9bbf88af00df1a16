// caustics/photon.vert: everywhere; PIXELS: where no beam carries light.
#ifdef PIXELS
#include "caustics/lone_cells.glsl"
uniform highp sampler2DArray uLayers;
void main() { drawLoneCell(textureSize(uLayers, 0).x); }
#else
#include "lib/screen.vert"
#endif
