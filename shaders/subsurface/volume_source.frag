// subsurface/volume_source.frag: see subsurface/volume_source.vert.
//
// out   oSource  [W/m²] over a face of the cell, added up
#include "subsurface/volume.glsl"
uniform sampler2D uCell;
flat in vec3 vFlux;
flat in vec3 vPlace;
layout(location = 0) out vec4 oSource;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 between;
    ivec3 base = cellsAround(vPlace, between);
    ivec3 corner = cellAt(texel) - base;
    if (any(lessThan(corner, ivec3(0))) || any(greaterThan(corner, ivec3(1)))) discard;
    oSource = vec4(vFlux * shareOf(corner, between) * takes(texelFetch(uCell, texel, 0).r), 1.0);
}
