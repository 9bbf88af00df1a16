// subsurface/shade.frag: what the surface of one scattering object sends to the eye.
//
// in    uRadiosity    [shade.unit] light that leaves (subsurface/splat.frag)
//       uHighlight    USE_LAMPS: subsurface/highlight.frag
//       uPaint        PAINTED: what is painted on these pixels (views/paint.glsl, what leaves)
//       uMatt         PAINTED: the same surface as if it were opaque (brdf/shade.frag)
//       uEnvironment  USE_SKY: see views/environment.glsl
// out   oColor.rgb    linear Rec. 709, or with SHOW_RADIOSITY the radiosity; a: 1
// model B F_t(cos) / (pi mean), with the mean F_t over the directions in which B leaves: what B counts leaves
//       (a mean of 1 is the dissertation's eq. 6.13, which loses it); and the highlights. PAINTED: translucency and
//       factor times that, and the rest of the surface matt
// not   in a highlight: objects
#pragma variants - USE_LAMPS
#pragma variants - USE_SKY
#pragma variants - SHOW_RADIOSITY
#pragma variants - PAINTED
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "lib/ggx.glsl"
#include "views/surface_pixel.glsl"
layout(std140) uniform SubsurfaceShadeBlock {
    View view;
    mat4 mapFromWorld;
    float ior, roughness;
    float mean;      // F_t
    float intensity; // of the environment
    int object;
    float unit;      // [W/m²] of uRadiosity
} shade;
uniform sampler2D uRadiosity;
#ifdef USE_LAMPS
uniform sampler2D uHighlight;
#endif
#ifdef PAINTED
uniform sampler2D uPaint;
uniform sampler2D uMatt;
#endif
#ifdef USE_SKY
#include "views/environment.glsl"
#include "views/mirrored_sky.glsl"
#endif
layout(location = 0) out vec4 oColor;

const float kPi = 3.14159265;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != shade.object) discard;
    vec3 radiosity = shade.unit * texelFetch(uRadiosity, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef PAINTED
    vec4 paint = texelFetch(uPaint, ivec2(gl_FragCoord.xy), 0);
    radiosity *= paint.a * paint.rgb;
#endif
#ifdef SHOW_RADIOSITY
    oColor = vec4(radiosity, 1.0);
#else
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(shade.view, gl_FragCoord.xy);
    float cosine = max(dot(normal, toEye), 0.0);
    float leaving = 1.0 - fresnelReflectance(cosine, 1.0 / shade.ior);
    oColor = vec4(radiosity * leaving / (kPi * shade.mean), 1.0);
#ifdef PAINTED
    oColor.rgb += (1.0 - paint.a) * texelFetch(uMatt, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_LAMPS
    oColor.rgb += texelFetch(uHighlight, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_SKY
    if (cosine > 0.0) oColor.rgb += shade.intensity * mirroredSky(normal, toEye, shade.roughness, shade.ior, mat3(shade.mapFromWorld));
#endif
#endif
}
