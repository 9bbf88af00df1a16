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
#endif
layout(location = 0) out vec4 oColor;

const float kPi = 3.14159265;

#ifdef USE_SKY
const int kFacets = 16; // chosen by eye: at roughness 0.3 more change nothing that one sees

vec3 mirroredSky(vec3 normal, vec3 toEye) {
    float alpha = max(shade.roughness * shade.roughness, 1e-6);
    vec3 x = normalize(abs(normal.y) < 0.9 ? cross(vec3(0.0, 1.0, 0.0), normal) : cross(vec3(1.0, 0.0, 0.0), normal));
    mat3 worldFromSurface = mat3(x, cross(normal, x), normal);
    vec3 eye = toEye * worldFromSurface;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kFacets; ++i) {
        vec3 facet = seenFacet(eye, alpha, latticePoint(i, kFacets));
        vec3 out_ = reflect(-eye, facet);
        if (out_.z <= 0.0) continue;
        float share = fresnelReflectance(clamp(dot(eye, facet), 0.0, 1.0), 1.0 / shade.ior) *
                      shadowedOne(out_.z, alpha);
        sum += share * mapRadiance(mat3(shade.mapFromWorld) * (worldFromSurface * out_));
    }
    return shade.intensity * sum / float(kFacets);
}
#endif

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
    if (cosine > 0.0) oColor.rgb += mirroredSky(normal, toEye);
#endif
#endif
}
