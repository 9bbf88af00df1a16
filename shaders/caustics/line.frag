// caustics/line.frag: light that a ray leaves on what a pixel shows, if it meets that there.
//
// in    uSurface  views/surface_pixel.glsl
// out   oFlux [light.unit]
// model the ray meets the tangent plane of what the pixel shows within the part of the ray that the pixel shows: of
//       the pixels along a line, one on each plane
// not   a ray ends on no surface: what lies behind the one that it meets, and the camera sees, is lit too
#include "caustics/lines_block.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
flat in vec3 vOrigin;
flat in vec3 vDirection;
flat in vec2 vRange;
flat in vec4 vEnds;
flat in vec2 vDepths;
flat in vec3 vFlux;
layout(location = 0) out vec4 oFlux;

// Metres along the ray at a share of its way in the picture.
float metresAt(float share) {
    float near = share * vDepths.x;
    return mix(vRange.x, vRange.y, near / ((1.0 - share) * vDepths.y + near));
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace) discard;
    vec3 normal = fromOctahedral(pixel.g);
    float slope = dot(vDirection, normal);
    if (slope >= 0.0) discard;
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, pixel.z);
    float t = dot(place - vOrigin, normal) / slope;

    vec2 way = vEnds.zw - vEnds.xy;
    bool upright = abs(way.y) > abs(way.x);
    float length_ = upright ? way.y : way.x;
    float beside = (upright ? gl_FragCoord.y - vEnds.y : gl_FragCoord.x - vEnds.x) - 0.5;
    vec2 shares = vec2(0.0, 1.0);
    if (abs(length_) > 1e-4) shares = clamp(vec2(beside, beside + 1.0) / length_, 0.0, 1.0);
    else if (abs(beside + 0.5) > 0.5) discard;
    vec2 range = vec2(metresAt(min(shares.x, shares.y)), metresAt(max(shares.x, shares.y)));
    if (t < range.x || t >= range.y) discard;
    oFlux = vec4(vFlux, 1.0);
}
