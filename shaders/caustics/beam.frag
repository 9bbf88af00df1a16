// caustics/beam.frag: light that one triangle of the grid leaves on a texel of the map; drawn with addition, so that
// folded sheets of light add up.
flat in vec3 vFlux;
layout(location = 0) out vec4 oFlux;
void main() { oFlux = vec4(vFlux, 1.0); }
