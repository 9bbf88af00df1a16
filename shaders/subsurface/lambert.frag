// subsurface/lambert.frag: light of one point of a lamp, or of the environment, that leaves one object where it entered.
//
// in    uBefore  USE_BEFORE: the sum so far
//       uShadow  USE_SHADOW: see views/shadow.glsl
// out   oSum.rgb [W/m²]
// model whole F_t(cos) E cos; FROM_SKY: whole times irradiance with F_t in it
#pragma variants - USE_SHADOW FROM_SKY
#pragma variants - USE_BEFORE
#include "views/view.glsl"
layout(std140) uniform LambertBlock {
    View view;
    View faces[6];
    vec4 place, color, axis; // subsurface/lamp.glsl
    vec4 sky[9];
    vec4 whole; // share of what entered that leaves
    vec2 cone;
    int faceCount;
    int object;
    float ior;
} light;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "views/surface_pixel.glsl"
#ifdef FROM_SKY
#include "subsurface/sky.glsl"
#else
#include "subsurface/lamp.glsl"
#endif
#ifdef USE_SHADOW
#include "views/shadow.glsl"
#endif
#ifdef USE_BEFORE
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSum;

vec3 entering(vec3 place, vec3 normal) {
#ifdef FROM_SKY
    return skyLight(normal);
#else
    vec3 toLight;
    vec3 arriving = lightAt(place, toLight);
    float cosine = dot(normal, toLight);
    if (cosine <= 0.0) return vec3(0.0);
#ifdef USE_SHADOW
    arriving *= lightReaching(place, normal);
#endif
    return cosine * (1.0 - fresnelReflectance(min(cosine, 1.0), 1.0 / light.ior)) * arriving;
#endif
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != light.object) discard;
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, pixel.z);
    oSum = vec4(light.whole.rgb * entering(place, fromOctahedral(pixel.g)), 1.0);
#ifdef USE_BEFORE
    oSum.rgb += texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
}
