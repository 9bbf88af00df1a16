// brdf/textured.glsl: the material of a pixel that textures change.
#include "views/textured.glsl"
const float kLeastFacets = 1e-3; // alpha of facets whose densities stay finite in a float
const float kMostNarrow = 0.25;  // alpha up to which lobes show objects: scene::kMostMirroringRoughness²

// Whether the pixel shows something with textures; then the numbers of its material (brdf/models.glsl) are changed.
bool takeTextures(inout vec3 normal, inout vec3 diffuse, inout float alpha, inout float metallic) {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 facets = texelFetch(uFacets, at, 0), factors = texelFetch(uFactors, at, 0);
    if (facets.w == 0.0) return false;
    normal = fromOctahedral(facets.xy);
    diffuse *= factors.rgb;
    alpha *= factors.a * factors.a;
    metallic *= facets.z;
    return true;
}
