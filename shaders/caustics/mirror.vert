// caustics/mirror.vert: everywhere; PIXELS: over what is packed of cells in which no beam carries all light.
#ifdef PIXELS
#include "caustics/lone_cells.vert"
#else
#include "lib/screen.vert"
#endif
