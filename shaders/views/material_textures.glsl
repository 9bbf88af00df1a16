// views/material_textures.glsl: what the textures of a material say of one place.
//
// in    uColor, uEmission, uRoughness, uNormal  textures; a white one of one texel where there is none
// out   views/textured.glsl
// model bilinear between texels. Normals as glTF 2.0 has them (3.9.3), without stored tangents: over each triangle these
//       follow from how places and coordinates change
#include "lib/octahedral.glsl"
#include "views/texture_at.glsl"
uniform sampler2D uColor;
uniform sampler2D uEmission;
uniform sampler2D uRoughness;
uniform sampler2D uNormal;
layout(location = 0) out vec4 oFactors;
layout(location = 1) out vec4 oFacets;
layout(location = 2) out vec4 oEmission;

// The normal that the texture makes of an outward one.
//
// placeX, placeY  how the place changes along two directions on the triangle,
// atX, atY        and how the coordinates do. Where these do not say which way the texture lies the surface keeps its own
//                 normal
vec3 texturedNormal(vec3 normal, vec3 placeX, vec3 placeY, vec2 atX, vec2 atY, vec4 coordinates, float code,
                    float scale) {
    float turn = atX.x * atY.y - atX.y * atY.x < 0.0 ? -1.0 : 1.0;
    vec3 alongU = turn * (placeX * atY.y - placeY * atX.y), alongV = turn * (placeY * atX.x - placeX * atY.x);
    vec3 tangent = alongU - dot(normal, alongU) * normal;
    float far = length(tangent);
    if (!(far > 0.0)) return normal;
    tangent /= far;
    vec3 up = cross(normal, tangent);
    if (dot(up, alongV) > 0.0) up = -up;
    vec3 stored = 2.0 * textureAt(uNormal, coordinates, code).xyz - 1.0;
    stored.xy *= scale;
    return normalize(stored.x * tangent + stored.y * up + stored.z * normal);
}

// normal  towards the eye
// wraps   of color, emission, roughness and normal
void writeTextures(vec3 normal, vec3 color, vec4 coordinates, vec4 wraps) {
    vec4 roughness = textureAt(uRoughness, coordinates, wraps.z);
    oFactors = vec4(color * textureAt(uColor, coordinates, wraps.x).rgb, roughness.g);
    oFacets = vec4(octahedralFrom(normal), roughness.b, 1.0);
    oEmission = vec4(textureAt(uEmission, coordinates, wraps.y).rgb, 1.0);
}
