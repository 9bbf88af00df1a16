// caustics/alone.vert: over what is packed of cells in which beams carry not all light.
#include "caustics/lone_cells.vert"
