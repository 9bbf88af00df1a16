// views/textured.frag: what the textures of one mesh say of each point that a view shows of it.
//
// in    uSurface    the visible points (views/surface_pixel.glsl)
//       uColor, uEmission, uRoughness, uNormal  textures; a white one of one texel where there is none
// out   views/textured.glsl
// model bilinear between texels. Normals as glTF 2.0 has them (3.9.3), without stored tangents: over each triangle these
//       follow from how places and coordinates change
#pragma variants TEXTURED
#include "views/mesh_block.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "views/texture_at.glsl"
uniform sampler2D uColor;
uniform sampler2D uEmission;
uniform sampler2D uRoughness;
uniform sampler2D uNormal;
in vec3 vNormal;
in float vDepth;
in vec3 vColor;
in vec3 vPlace;
layout(location = 0) out vec4 oFactors;
layout(location = 1) out vec4 oFacets;
layout(location = 2) out vec4 oEmission;
const float kSame = 1e-4; // of a depth: what two programs may differ by

// Outward. Where coordinates do not say which way a texture lies the surface keeps its own.
vec3 texturedNormal(vec3 normal) {
    vec3 placeX = dFdx(vPlace), placeY = dFdy(vPlace);
    vec2 at = coordinateOf(mesh.wraps.w), atX = dFdx(at), atY = dFdy(at);
    float turn = atX.x * atY.y - atX.y * atY.x < 0.0 ? -1.0 : 1.0;
    vec3 alongU = turn * (placeX * atY.y - placeY * atX.y), alongV = turn * (placeY * atX.x - placeX * atY.x);
    vec3 tangent = alongU - dot(normal, alongU) * normal;
    float far = length(tangent);
    if (!(far > 0.0)) return normal;
    tangent /= far;
    vec3 up = cross(normal, tangent);
    if (dot(up, alongV) > 0.0) up = -up;
    vec3 stored = 2.0 * textureAt(uNormal, mesh.wraps.w).xyz - 1.0;
    stored.xy *= mesh.normalScale;
    return normalize(stored.x * tangent + stored.y * up + stored.z * normal);
}

void main() {
    vec3 normal = texturedNormal(normalize(vNormal));
    vec3 across = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
    SurfacePixel pixel = readSurface();
    if (pixel.object != mesh.object || abs(vDepth - pixel.z) > kSame * abs(pixel.z)) discard;
    vec3 toEye = -eyeRay(mesh.view, gl_FragCoord.xy);
    if (!gl_FrontFacing) normal = -normal;
    if (dot(normal, toEye) < 0.0) normal = dot(across, toEye) < 0.0 ? -across : across;
    vec4 roughness = textureAt(uRoughness, mesh.wraps.z);
    oFactors = vec4(vColor * textureAt(uColor, mesh.wraps.x).rgb, roughness.g);
    oFacets = vec4(octahedralFrom(normal), roughness.b, 1.0);
    oEmission = vec4(textureAt(uEmission, mesh.wraps.y).rgb, 1.0);
}
