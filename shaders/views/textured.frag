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
uniform sampler2D uColor;
uniform sampler2D uEmission;
uniform sampler2D uRoughness;
uniform sampler2D uNormal;
in vec3 vNormal;
in float vDepth;
in vec2 vCoordinate;
in vec3 vColor;
in vec3 vPlace;
layout(location = 0) out vec4 oFactors;
layout(location = 1) out vec4 oFacets;
layout(location = 2) out vec4 oEmission;
const float kSame = 1e-4; // of a depth: what two programs may differ by

// The texel that stands for one beyond the edges. Far outside floats no longer tell texels apart.
int wrapped(int at, int size, int wrap) {
    if (wrap == 1) return clamp(at, 0, size - 1);
    int period = wrap == 2 ? 2 * size : size;
    int inside = at - period * int(floor(float(at) / float(period)));
    return inside < size ? inside : 2 * size - 1 - inside;
}

vec4 textureAt(sampler2D map, float wraps) {
    ivec2 size = textureSize(map, 0);
    ivec2 wrap = ivec2(int(wraps) % 3, int(wraps) / 3);
    vec2 at = vCoordinate * vec2(size) - 0.5;
    ivec2 base = ivec2(floor(at));
    vec2 f = at - vec2(base);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 beside = ivec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - f, f, vec2(beside));
        ivec2 texel = ivec2(wrapped(base.x + beside.x, size.x, wrap.x), wrapped(base.y + beside.y, size.y, wrap.y));
        sum += share.x * share.y * texelFetch(map, texel, 0);
    }
    return sum;
}

// Outward. Where coordinates do not say which way a texture lies the surface keeps its own.
vec3 texturedNormal(vec3 normal) {
    vec3 placeX = dFdx(vPlace), placeY = dFdy(vPlace);
    vec2 atX = dFdx(vCoordinate), atY = dFdy(vCoordinate);
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
