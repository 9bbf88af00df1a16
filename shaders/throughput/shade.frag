// throughput/shade.frag: what the surface of one baked object sends to the eye.
//
// in    uSurface  views/surface_pixel.glsl
//       uSeen     [W/m²] throughput/seen.frag
//       uPaint       PAINTED: what is painted on these pixels (views/paint.glsl, what leaves): the surface texture T_p
//                    (2002 paper, eq. 13 and 14), by which what texels carry and what vertices carry count
//       uMirrored    USE_LAMPS: throughput/mirror.frag
//       uEnvironment USE_SKY: see views/environment.glsl
// out   oColor.rgb linear Rec. 709, or with SHOW_RADIOSITY the radiosity; a: 1
// model B F_t(cos) / (pi mean), with the mean F_t over the directions in which B leaves: what B counts leaves
#pragma variants - SHOW_RADIOSITY
#pragma variants - USE_LAMPS
#pragma variants - USE_SKY
#pragma variants - PAINTED
#include "views/view.glsl"
layout(std140) uniform ThroughputShadeBlock {
    View view;
    mat4 mapFromWorld;
    float ior, roughness;
    float mean;      // F_t
    float intensity; // of the environment
    int object;
} shade;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "lib/ggx.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uSeen;
#ifdef PAINTED
uniform sampler2D uPaint;
#endif
#ifdef USE_LAMPS
uniform sampler2D uMirrored;
#endif
#ifdef USE_SKY
#include "views/environment.glsl"
#include "views/mirrored_sky.glsl"
#endif
layout(location = 0) out vec4 oColor;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != shade.object) discard;
    vec3 radiosity = texelFetch(uSeen, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef PAINTED
    radiosity *= texelFetch(uPaint, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef SHOW_RADIOSITY
    oColor = vec4(radiosity, 1.0);
#else
    const float kPi = 3.14159265;
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(shade.view, gl_FragCoord.xy);
    float cosine = max(dot(normal, toEye), 0.0);
    oColor = vec4(radiosity * (1.0 - fresnelReflectance(cosine, 1.0 / shade.ior)) / (kPi * shade.mean), 1.0);
#ifdef USE_LAMPS
    oColor.rgb += texelFetch(uMirrored, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_SKY
    if (cosine > 0.0)
        oColor.rgb += shade.intensity * mirroredSky(normal, toEye, shade.roughness, shade.ior, mat3(shade.mapFromWorld));
#endif
#endif
}
