// subsurface/volume_leave.frag: light that leaves the body at the places that the camera shows.
//
// in    uSurface  views/surface_pixel.glsl
//       uCell     subsurface/volume_cells.frag
//       uFluence
// out   oRadiosity.rgb [W/m²]
// model what the fluence of each cell around would let through the surface at the pixel (leavingFrom of its depth), and
//       of those the weighted least-squares fit a + b u + c v + e depth², u and v along the surface, at the pixel: a. The
//       last term is what light that enters there bends. In sheets, thinner than a cell, depths are those of the sheet
#include "subsurface/volume.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uCell;
uniform sampler2D uFluence;
layout(location = 0) out vec4 oRadiosity;

const float kReach = 2.0; // [widths]: so far the fit looks, within four cells a side
const float kRidge = 1e-3; // keeps the fit flat where cells say nothing of a slope

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != volume.object) discard;
    vec3 normal = fromOctahedral(pixel.g);
    vec3 place = volume.view.eye.xyz + placeFrom(volume.view, gl_FragCoord.xy, pixel.z);
    vec3 right = normalize(abs(normal.x) < 0.6 ? vec3(0.0, normal.z, -normal.y) : vec3(-normal.z, 0.0, normal.x));
    vec3 up = cross(normal, right);
    vec3 between;
    ivec3 base = cellsAround(place, between) - 1;
    mat4 moments = mat4(0.0);
    mat4x3 light = mat4x3(0.0);
    for (int i = 0; i < 64; ++i) {
        ivec3 corner = ivec3(i & 3, (i >> 2) & 3, i >> 4);
        vec3 away = (vec3(corner - 1) - between) / kReach;
        float rest = 1.0 - dot(away, away);
        ivec3 cell = base + corner;
        if (rest <= 0.0 || any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, volume.cells.xyz))) continue;
        ivec2 texel = texelOf(cell);
        vec4 own = texelFetch(uCell, texel, 0);
        if (own.r == 0.0) continue;
        vec3 offset = (middleOf(cell) - place) / volume.low.w;
        float depth = -dot(offset, normal);
        if (own.g > 0.0) depth = mix(own.r / own.g, depth, smoothstep(0.0, 0.5, own.a));
        vec4 terms = vec4(1.0, dot(offset, right), dot(offset, up), depth * depth);
        float weight = max(own.r, 0.5 * own.g) * rest * rest;
        moments += outerProduct(weight * terms, terms);
        light += outerProduct(weight * texelFetch(uFluence, texel, 0).rgb * leavingFrom(depth), terms);
    }
    oRadiosity = vec4(vec3(0.0), 1.0);
    if (moments[0][0] <= 0.0) return;
    float ridge = kRidge * moments[0][0];
    moments += mat4(0.0, 0.0, 0.0, 0.0, 0.0, ridge, 0.0, 0.0, 0.0, 0.0, ridge, 0.0, 0.0, 0.0, 0.0, ridge);
    oRadiosity.rgb = max(light * (inverse(moments / moments[0][0])[0] / moments[0][0]), 0.0);
}
