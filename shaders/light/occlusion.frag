// light/occlusion.frag: how much of one light sample is kept from what each pixel of a view shows.
//
// in    uSurface    the visible points (views/surface_pixel.glsl)
//       uShadow     views/shadow.glsl
//       uPlaces     OF_PLACES: world places of the points, xyz
// out   oOcclusion  1 - visibility, in one channel; added to what the others hold
//
// OF_FIELD: of one height field, whose shadow on itself is left to whoever walks through it: the plane that its point is
// compared by faces the light. Else of all other shapes. OVER_WATER, BELOW_WATER: of light by way of a sheet of water, where
// it reaches a place so: before it enters, and from there on.
#pragma variants - OF_FIELD OF_PLACES
#pragma variants - OVER_WATER BELOW_WATER
#include "views/view.glsl"
#include "light/flat_water.glsl"
layout(std140) uniform OcclusionBlock {
    View view;
    View faces[6];
    mat4 worldFromObject; // OF_FIELD: this and the rest
    vec4 source;          // world: position, 1; or unit direction to the light, 0
    vec4 channel;         // in the one that is drawn the share of the sample that the shadow stands for, else 0
    vec2 corner;          // of the copy of the view that is drawn, pixels
    vec2 texels;
    float texelSize;
    int object;
    int faceCount;
    FlatWater water;      // OVER_WATER, BELOW_WATER
} light;
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "views/shadow.glsl"
#ifdef OF_PLACES
uniform sampler2D uPlaces;
#endif
layout(location = 0) out vec4 oOcclusion;

void main() {
    vec2 at = gl_FragCoord.xy - light.corner;
    SurfacePixel pixel = surfaceAt(ivec2(at));
#ifdef OF_FIELD
    if (pixel.object != light.object) discard;
    vec2 p = (pixel.g - 0.5 - 0.5 * light.texels) * light.texelSize;
    vec3 place = (light.worldFromObject * vec4(p.x, -p.y, pixel.z, 1.0)).xyz;
    vec3 normal = vec3(0.0);
#else
    if (pixel.face != kMeshFace) discard;
#ifdef OF_PLACES
    vec3 place = texelFetch(uPlaces, ivec2(at), 0).xyz;
#else
    vec3 place = light.view.eye.xyz + placeFrom(light.view, at, pixel.z);
#endif
    vec3 normal = fromOctahedral(pixel.g);
#endif
    vec3 toLight = light.source.xyz - (light.source.w == 0.0 ? vec3(0.0) : place);
#if defined(OVER_WATER) || defined(BELOW_WATER)
    vec3 entry, bent;
    if (!entersWater(light.water, place, light.source.xyz, entry, bent)) discard;
    toLight = bent;
#endif
#ifdef OF_FIELD
    normal = normalize(toLight);
#endif
    if (dot(normal, toLight) <= 0.0) discard; // faces away
#ifdef OVER_WATER
    place = entry;
    normal = light.water.up.xyz;
#endif
    oOcclusion = (1.0 - lightReaching(place, normal)) * light.channel;
}
