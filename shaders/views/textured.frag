// views/textured.frag: what the textures of one mesh say of each point that a view shows of it.
//
// in    uSurface  the visible points (views/surface_pixel.glsl), and views/material_textures.glsl
// out   views/textured.glsl
#pragma variants TEXTURED
#include "views/mesh_block.glsl"
#include "views/surface_pixel.glsl"
#include "views/material_textures.glsl"
in vec3 vNormal;
in float vDepth;
in vec4 vCoordinate;
in vec3 vColor;
in vec3 vPlace;
const float kSame = 1e-4; // of a depth: what two programs may differ by

void main() {
    vec2 at = coordinateOf(vCoordinate, mesh.wraps.w);
    vec3 normal = texturedNormal(normalize(vNormal), dFdx(vPlace), dFdy(vPlace), dFdx(at), dFdy(at), vCoordinate,
                                 mesh.wraps.w, mesh.normalScale);
    vec3 across = normalize(cross(dFdx(vPlace), dFdy(vPlace)));
    SurfacePixel pixel = readSurface();
    if (pixel.object != mesh.object || abs(vDepth - pixel.z) > kSame * abs(pixel.z)) discard;
    vec3 toEye = -eyeRay(mesh.view, gl_FragCoord.xy);
    if (!gl_FrontFacing) normal = -normal;
    if (dot(normal, toEye) < 0.0) normal = dot(across, toEye) < 0.0 ? -across : across;
    writeTextures(normal, vColor, vCoordinate, mesh.wraps);
}
