// throughput/mirror.frag: what the surface of one object mirrors of some of the lamps' samples towards the eye, added to
// what it mirrors of earlier ones.
//
// in    uSurface    views/surface_pixel.glsl
//       uMirrored   USE_SUM: the sum so far
//       uOcclusion  USE_OCCLUSION: light/occlusion.glsl
// out   oMirrored.rgb [W/(m² sr)]
// model facets (lib/ggx.glsl) with unpolarised Fresnel
#pragma variants - USE_OCCLUSION
#pragma variants - USE_SUM
#include "views/view.glsl"
layout(std140) uniform ThroughputMirrorBlock {
    View view;
    float ior, roughness;
    int object;
    int firstLight;
    int endLight;
    int columns; // of light/occlusion.glsl
} mirror;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "lib/ggx.glsl"
#include "views/surface_pixel.glsl"
#include "light/sample.glsl"
#include "light/occlusion.glsl"
#ifdef USE_SUM
uniform sampler2D uMirrored;
#endif
layout(location = 0) out vec4 oMirrored;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != mirror.object) discard;
    vec3 place = mirror.view.eye.xyz + placeFrom(mirror.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(mirror.view, gl_FragCoord.xy);
#ifdef USE_SUM
    oMirrored = texelFetch(uMirrored, ivec2(gl_FragCoord.xy), 0);
#else
    oMirrored = vec4(vec3(0.0), 1.0);
#endif
    if (dot(normal, toEye) <= 0.0) return;
    for (int i = mirror.firstLight; i < mirror.endLight; ++i) {
        LightSample light = lightSampleAt(i, place);
        float cosine = cosineOf(dot(normal, light.toLight), light.extent);
        if (cosine <= 0.0 || dot(normal, light.toLight) <= 0.0) continue;
        float fresnel =
            fresnelReflectance(clamp(dot(toEye, normalize(light.toLight + toEye)), 0.0, 1.0), 1.0 / mirror.ior);
        oMirrored.rgb += fresnel * facetShare(normal, light.toLight, toEye, mirror.roughness * mirror.roughness) *
                         cosine * light.irradiance *
                         visibilityOf(i - mirror.firstLight, ivec2(mirror.view.size), mirror.columns);
    }
}
