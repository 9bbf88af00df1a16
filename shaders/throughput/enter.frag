// throughput/enter.frag: the illumination map: light that some of the light samples send into the texels of an object's
// atlas, added to what earlier samples sent.
//
// in    uSurface, uPlaces  throughput/place.frag
//       uEntered    USE_SUM: the sum so far
//       uOcclusion  USE_OCCLUSION: light/occlusion.glsl
//       uFlux       USE_FLUX: [W/m²] that glass, mirrors and water carry there; it arrives straight on
// out   oEntered.rgb [W/m²]
// model share F_t(cos) V E cos. SCHLICK: 1 - F_t as (1 - cos)^5 from its value straight on (Schlick 1994), as the paper
//       has it
#pragma variants - USE_OCCLUSION
#pragma variants - USE_WATER
#pragma variants - USE_SUM
#pragma variants - SCHLICK
#pragma variants - USE_FLUX
layout(std140) uniform ThroughputEnterBlock {
    ivec2 size;
    float ior; // 1: all light enters
    int firstLight;
    int endLight;
    int columns; // of light/occlusion.glsl
} enter;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "views/surface_pixel.glsl"
#include "light/sample.glsl"
#include "light/occlusion.glsl"
uniform sampler2D uPlaces;
#ifdef USE_SUM
uniform sampler2D uEntered;
#endif
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
layout(location = 0) out vec4 oEntered;

float reflected(float cosine) {
#ifdef SCHLICK
    float straight = (enter.ior - 1.0) / (enter.ior + 1.0);
    float rest = 1.0 - cosine;
    return straight * straight + (1.0 - straight * straight) * rest * rest * rest * rest * rest;
#else
    return fresnelReflectance(cosine, 1.0 / enter.ior);
#endif
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace) discard;
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 place = texelFetch(uPlaces, at, 0).xyz;
    vec3 normal = fromOctahedral(pixel.g);
#ifdef USE_SUM
    oEntered = texelFetch(uEntered, at, 0);
#else
    oEntered = vec4(vec3(0.0), 1.0);
#endif
#ifdef USE_FLUX
    oEntered.rgb += (1.0 - reflected(1.0)) * texelFetch(uFlux, at, 0).rgb;
#endif
    for (int i = enter.firstLight; i < enter.endLight; ++i) {
        LightSample light = lightSampleAt(i, place);
        float cosine = cosineOf(dot(normal, light.toLight), light.extent);
        if (cosine <= 0.0) continue;
        oEntered.rgb += (1.0 - reflected(min(cosine, 1.0))) * cosine * light.irradiance *
                        visibilityOf(i - enter.firstLight, enter.size, enter.columns);
    }
}
