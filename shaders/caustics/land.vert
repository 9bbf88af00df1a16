// caustics/land.vert: everywhere; PACKED: over what is packed of cells in which beams carry not all light.
#ifdef PACKED
#include "caustics/lone_cells.vert"
#else
#include "lib/screen.vert"
#endif
