// subsurface/volume_source.vert: light that entered at a point, laid down where it first scatters.
//
// in    uPlace, uFlux, uNormal  points (subsurface/points.glsl), the normals being the light's way inside
//       uCell
// out   vFlux   flat; for each cell of full share
//       vPlace  flat
// model exponential fall along the refracted ray, in kDepths parts of equal light. A place outside the body (thin parts,
//       grazing rays) moves back along the ray, to where the light entered at last
#include "subsurface/volume.glsl"
uniform sampler2D uPlace;
uniform sampler2D uFlux;
uniform sampler2D uNormal;
uniform sampler2D uCell;
flat out vec3 vFlux;
flat out vec3 vPlace;

const int kDepths = 4;

// x: what the cells around a place would take of light there; y: how much of them lies in the body.
vec2 insideShares(vec3 place) {
    vec3 between;
    ivec3 base = cellsAround(place, between);
    vec2 sum = vec2(0.0);
    for (int i = 0; i < 8; ++i) {
        float volumeInside = texelFetch(uCell, texelOf(base + cornerOf(i)), 0).r;
        sum += shareOf(cornerOf(i), between) * vec2(takes(volumeInside), volumeInside);
    }
    return sum;
}

const float kWithin = 0.3; // a flat surface has half of the cells around it inside

void main() {
    gl_PointSize = 2.0;
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
    int number = gl_VertexID / (2 * kDepths);
    int part = (gl_VertexID >> 1) % kDepths;
    ivec2 texel = ivec2(number % volume.columns, number / volume.columns);
    vec3 flux = texelFetch(uFlux, texel, 0).rgb;
    vFlux = vec3(0.0);
    vPlace = vec3(0.0);
    if (flux == vec3(0.0)) return;

    vec3 place = texelFetch(uPlace, texel, 0).xyz;
    vec3 along = texelFetch(uNormal, texel, 0).xyz; // refracted

    // Optical depths between which this part of the light scatters, and their mean.
    float from = -log(1.0 - float(part) / float(kDepths));
    bool isLast = part == kDepths - 1;
    float to = isLast ? 1e9 : -log(1.0 - float(part + 1) / float(kDepths));
    float mean = isLast ? from + 1.0
                        : float(kDepths) * ((from + 1.0) * exp(-from) - (to + 1.0) * exp(-to));
    vec3 share = exp(-volume.extinction.rgb * (from / volume.albedo.a));
    if (!isLast) share -= exp(-volume.extinction.rgb * (to / volume.albedo.a));

    vec3 way = mean / volume.albedo.a * along;
    vPlace = place + way;
    vec2 inside = insideShares(vPlace);
    for (int i = 0; i < 4 && inside.y < kWithin; ++i) {
        way *= i == 3 ? 0.0 : 0.5;
        vPlace = place + way;
        inside = insideShares(vPlace);
    }
    if (inside.x <= 0.0) return;
    vFlux = flux * volume.albedo.rgb * share / (inside.x * volume.low.w * volume.low.w);
    vec3 between;
    ivec3 base = cellsAround(vPlace, between);
    base.z += gl_VertexID & 1;
    vec2 size = vec2(textureSize(uCell, 0));
    gl_Position = vec4(2.0 * vec2(texelOf(base) + 1) / size - 1.0, 0.0, 1.0);
}
