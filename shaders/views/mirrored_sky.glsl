// views/mirrored_sky.glsl: what a rough surface mirrors of the environment, past everything that stands in its way.
//
// Included after lib/fresnel.glsl, lib/ggx.glsl and views/environment.glsl.
#include "lib/surface_frame.glsl"
const int kFacets = 16; // chosen by eye: at roughness 0.3 more change nothing that one sees

// @param ior  of the inside over that of the outside
vec3 mirroredSky(vec3 normal, vec3 toEye, float roughness, float ior, mat3 mapFromWorld) {
    float alpha = max(roughness * roughness, 1e-6);
    mat3 worldFromSurface = surfaceFrame(normal);
    vec3 eye = toEye * worldFromSurface;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < kFacets; ++i) {
        vec3 facet = seenFacet(eye, alpha, latticePoint(i, kFacets));
        vec3 out_ = reflect(-eye, facet);
        if (out_.z <= 0.0) continue;
        float share = fresnelReflectance(clamp(dot(eye, facet), 0.0, 1.0), 1.0 / ior) * shadowedOne(out_.z, alpha);
        sum += share * mapRadiance(mapFromWorld * (worldFromSurface * out_));
    }
    return sum / float(kFacets);
}
