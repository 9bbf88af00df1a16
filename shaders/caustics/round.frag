// caustics/round.frag: depths of receivers in the map's paraboloids, by those in plane views of the light.
//
// in    uShadow, uBehind, uBack  caustics/receivers.glsl
// out   oDepth   [m] from the light; 1e30: nothing there
//       oBehind  USE_BEHIND: of the receivers behind
// model between texels as rays find receivers: planes stay planes
#pragma variants PARABOLOIDS
#pragma variants - USE_BEHIND
#include "views/view.glsl"
layout(std140) uniform RoundBlock {
    View faces[6];
    View halves[2];
    int faceCount;
} light;
#include "caustics/map_view.glsl"
#include "caustics/receivers.glsl"
layout(location = 0) out float oDepth;
#ifdef USE_BEHIND
layout(location = 1) out float oBehind;
#endif

float distanceAlong(vec3 way, int layer) {
    int number = faceOf(light.faces[0].eye.xyz + way);
    View face = light.faces[number];
    vec3 seen = inView(face, way);
    vec2 pixel = pixelOf(face, seen);
    if (seen.z <= 0.0 || any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, face.size))) return 1e30;
    float depth = surfaceDepth(number, pixel, layer);
    return depth > kFar ? 1e30 : depth / seen.z;
}

void main() {
    float size = light.halves[0].size.x;
    int half_ = gl_FragCoord.x < size ? 0 : 1;
    vec3 way = wayThrough(light.halves[half_], gl_FragCoord.xy - vec2(size * float(half_), 0.0));
    oDepth = distanceAlong(way, 0);
#ifdef USE_BEHIND
    oBehind = distanceAlong(way, 1);
#endif
}
