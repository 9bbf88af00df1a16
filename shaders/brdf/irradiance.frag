// brdf/irradiance.frag: light of one point of a lamp on what each pixel shows of opaque objects.
//
// in    uBefore  USE_BEFORE: the sum so far
//       uShadow  USE_SHADOW: see views/shadow.glsl
// out   oSum.rgb [W/m²]  linear Rec. 709
// model irradiance color * cone * cos, over the squared distance where light fades; the disc of a lamp faces what it
//       lights, so each of its points counts as the one beside the lamp's middle that is seen in its place
#include "views/view.glsl"
layout(std140) uniform IrradianceBlock {
    View view;
    View faces[6];
    vec4 place;  // world: point, 1; or unit direction to the light, 0
    vec4 centre; // of the lamp; w: 1: its light fades
    vec4 color;  // a: exponent of the cone
    vec4 axis;   // unit: along which it shines most
    vec2 cone;   // scale and offset of the cosine to it
    int faceCount;
    int padding;
} light;
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#ifdef USE_SHADOW
#include "views/shadow.glsl"
#endif
#ifdef USE_BEFORE
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSum;

// The light's direction, and its irradiance on what faces it.
vec3 lightAt(vec3 place, out vec3 toLight) {
    toLight = light.place.xyz;
    if (light.place.w == 0.0) return light.color.rgb;
    vec3 way = light.centre.xyz - place;
    vec3 towards = way / max(length(way), 1e-30);
    vec3 beside = light.place.xyz - light.centre.xyz;
    way += beside - dot(beside, towards) * towards;
    float square = dot(way, way);
    if (square == 0.0) return vec3(0.0);
    toLight = way * inversesqrt(square);
    float cone = pow(clamp(light.cone.y - light.cone.x * dot(toLight, light.axis.xyz), 0.0, 1.0), light.color.a);
    return light.color.rgb * cone / (light.centre.w > 0.5 ? square : 1.0);
}

void main() {
#ifdef USE_BEFORE
    oSum = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
#else
    oSum = vec4(0.0);
#endif
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace) return;
    vec3 place = light.view.eye.xyz + placeFrom(light.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
    vec3 toLight;
    vec3 arriving = lightAt(place, toLight);
    float cosine = dot(normal, toLight);
    if (cosine <= 0.0) return;
#ifdef USE_SHADOW
    arriving *= lightReaching(place, normal);
#endif
    oSum.rgb += cosine * arriving;
}
