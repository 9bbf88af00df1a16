// subsurface/volume_leave.frag: light that leaves the body at the places that the camera shows.
//
// in    uSurface  views/surface_pixel.glsl
//       uInside, uFluence
// out   oRadiosity.rgb [W/m²]
// model the flux through the surface of each cell around, phi / (2 A + d / D) with its distance d to the surface at the
//       pixel, weighed by how near the cell is
#include "subsurface/volume.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uInside;
uniform sampler2D uFluence;
layout(location = 0) out vec4 oRadiosity;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != volume.object) discard;
    vec3 normal = fromOctahedral(pixel.g);
    vec3 place = volume.view.eye.xyz + placeFrom(volume.view, gl_FragCoord.xy, pixel.z);
    vec3 light = vec3(0.0);
    float sum = 0.0;
    for (int deeper = 0; deeper < 4 && sum < 0.1; ++deeper) {
        vec3 between;
        ivec3 base = cellsAround(place - 0.5 * float(deeper) * volume.low.w * normal, between);
        light = vec3(0.0);
        sum = 0.0;
        for (int i = 0; i < 8; ++i) {
            ivec3 cell = base + cornerOf(i);
            ivec2 texel = texelOf(cell);
            float weight = shareOf(cornerOf(i), between) * texelFetch(uInside, texel, 0).r;
            float away = max(dot(normal, place - middleOf(cell)), 0.0) / volume.low.w;
            sum += weight;
            light += weight * texelFetch(uFluence, texel, 0).rgb / (volume.diffusion.a + away / volume.diffusion.rgb);
        }
    }
    oRadiosity = vec4(sum > 0.0 ? light / sum : vec3(0.0), 1.0);
}
