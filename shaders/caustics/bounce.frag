// caustics/bounce.frag: a ray of light that meets mirrors after what has bent or mirrored it first.
//
// in    views/layers.glsl  all surfaces of mirrors, seen from the light; uSolid: of what receives
//       uPlace, uDirection, uFlux  caustics/photon.glsl
// out   oPlace, oDirection, oFlux  the same, from the last mirror on
// not   glass behind a mirror, what lies beside the light's view, light that is mirrored more than kMostBounces times
#define TWO_SIDED
#define USE_SOLID
#include "views/view.glsl"
#include "caustics/mirrors.glsl"
layout(std140) uniform BounceBlock {
    View view; // of the light
    vec4 mirrors[kMostMirrors]; // reflectance
    int count; // layers
} layers;
#include "views/layers.glsl"
uniform sampler2D uPlace;
uniform sampler2D uDirection;
uniform sampler2D uFlux;
layout(location = 0) out vec4 oPlace;
layout(location = 1) out vec4 oDirection;
layout(location = 2) out vec4 oFlux;

const int kMostBounces = 16;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    oPlace = texelFetch(uPlace, at, 0);
    oDirection = texelFetch(uDirection, at, 0);
    oFlux = texelFetch(uFlux, at, 0);
    if (oPlace.w == 0.0 || oDirection.w > 0.0) return;
    vec3 origin = oPlace.xyz - layers.view.eye.xyz;
    int way = int(oPlace.w);
    for (int i = 0; i <= kMostBounces; ++i) {
        Crossing crossing = march(layers.view, rayOf(layers.view, origin, oDirection.xyz), 0);
        if (crossing.kind != kGlass) break;
        origin += crossing.t * oDirection.xyz;
        oDirection.xyz = reflect(oDirection.xyz, crossing.normal);
        oFlux.rgb *= i < kMostBounces ? layers.mirrors[crossing.object].rgb : vec3(0.0);
        way = (31 * way + 2 * crossing.object + 1) & 0xffff;
        oPlace = vec4(origin + layers.view.eye.xyz, float(way | 1));
    }
}
