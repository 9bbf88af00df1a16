// subsurface/highlight.frag: light of one point of a lamp that the surface of one object mirrors.
//
// in    uBefore  USE_BEFORE: the sum so far
//       uShadow  USE_SHADOW: see views/shadow.glsl
// out   oSum.rgb [W/(m² sr)]
// model mirror facets (subsurface/ggx.glsl) with unpolarised Fresnel; roughness 0 shows no lamp, whose points are of no
//       size
#pragma variants - USE_SHADOW
#pragma variants - USE_BEFORE
#include "views/view.glsl"
layout(std140) uniform HighlightBlock {
    View view;
    View faces[6];
    vec4 place, color, axis; // subsurface/lamp.glsl
    vec2 cone;
    int faceCount;
    int object;
    float ior, roughness;
} light;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "subsurface/ggx.glsl"
#include "views/surface_pixel.glsl"
#ifdef USE_SHADOW
#include "views/shadow.glsl"
#endif
#ifdef USE_BEFORE
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSum;

#include "subsurface/lamp.glsl"

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != light.object) discard;
#ifdef USE_BEFORE
    oSum = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
#else
    oSum = vec4(0.0);
#endif
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(light.view, gl_FragCoord.xy);
    vec3 toLight;
    vec3 arriving = lightAt(place, toLight);
    float cosine = dot(normal, toLight);
    if (cosine <= 0.0 || dot(normal, toEye) <= 0.0 || light.roughness == 0.0) return;
#ifdef USE_SHADOW
    arriving *= lightReaching(place, normal);
#endif
    float fresnel = fresnelReflectance(clamp(dot(toEye, normalize(toLight + toEye)), 0.0, 1.0), 1.0 / light.ior);
    float alpha = light.roughness * light.roughness;
    oSum.rgb += cosine * fresnel * facetShare(normal, toLight, toEye, alpha) * arriving;
}
