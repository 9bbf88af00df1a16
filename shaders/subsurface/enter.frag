// subsurface/enter.frag: light that some of the light samples send into one scattering object, added to what earlier
// samples sent.
//
// in    uSurface    what the view shows (views/surface_pixel.glsl): OF_LAYER: a layer of the object with outward normals
//       uEntered    USE_SUM: the sum so far
//       uOther      USE_SUM: the second one
//       uOcclusion  USE_OCCLUSION: light/occlusion.glsl
//       uFlux       USE_FLUX: [W/m²] that caustics bring, of which F_t(1) enters: where they come from is not known
// out   oEntered.rgb [W/m²]
//       oOther.rgb   OF_LAYER: the directions that it came from, times its sum over the colours; else what the surface
//                    mirrors of lamps [W/(m² sr)]
// model share F_t(cos) V E cos; mirror facets (lib/ggx.glsl) with unpolarised Fresnel; roughness 0 shows no lamp,
//       whose points are of no size
#pragma variants - OF_LAYER
#pragma variants - USE_OCCLUSION
#pragma variants - USE_WATER
#pragma variants - USE_FLUX
#pragma variants - USE_SUM
#include "views/view.glsl"
layout(std140) uniform EnterBlock {
    View view;
    vec4 share; // of what enters that counts
    int object;
    float ior, roughness;
    int firstLight;
    int endLight;
    int placed;  // samples of lamps: those of the environment come after them
    int columns; // of light/occlusion.glsl
} enter;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "lib/ggx.glsl"
#include "views/surface_pixel.glsl"
#include "light/sample.glsl"
#include "light/occlusion.glsl"
#ifdef USE_SUM
uniform sampler2D uEntered;
uniform sampler2D uOther;
#endif
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
layout(location = 0) out vec4 oEntered;
layout(location = 1) out vec4 oOther;

float mirrored(vec3 normal, vec3 toLight, vec3 toEye) {
    if (dot(normal, toEye) <= 0.0 || dot(normal, toLight) <= 0.0) return 0.0;
    float fresnel = fresnelReflectance(clamp(dot(toEye, normalize(toLight + toEye)), 0.0, 1.0), 1.0 / enter.ior);
    return fresnel * facetShare(normal, toLight, toEye, enter.roughness * enter.roughness);
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != enter.object) discard;
    vec3 place = enter.view.eye.xyz + placeFrom(enter.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(enter.view, gl_FragCoord.xy);
#ifdef USE_SUM
    oEntered = texelFetch(uEntered, ivec2(gl_FragCoord.xy), 0);
    oOther = texelFetch(uOther, ivec2(gl_FragCoord.xy), 0);
#else
    oEntered = vec4(vec3(0.0), 1.0);
    oOther = oEntered;
#endif
#ifdef USE_FLUX
    vec3 flux = texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
    oEntered.rgb += enter.share.rgb * (1.0 - fresnelReflectance(1.0, 1.0 / enter.ior)) * flux;
#endif
    for (int i = enter.firstLight; i < enter.endLight; ++i) {
        LightSample light = lightSampleAt(i, place);
        float cosine = cosineOf(dot(normal, light.toLight), light.extent);
        if (cosine <= 0.0) continue;
        vec3 arriving = cosine * light.irradiance *
                        visibilityOf(i - enter.firstLight, ivec2(enter.view.size), enter.columns);
        vec3 entering = (1.0 - fresnelReflectance(min(cosine, 1.0), 1.0 / enter.ior)) * arriving;
        oEntered.rgb += enter.share.rgb * entering;
#ifdef OF_LAYER
        oOther.rgb += (entering.r + entering.g + entering.b) * light.toLight;
#else
        if (enter.roughness > 0.0 && i < enter.placed) oOther.rgb += mirrored(normal, light.toLight, toEye) * arriving;
#endif
    }
}
