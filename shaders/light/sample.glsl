// light/sample.glsl: the light samples that stand for all lamps and the environment.
//
// USE_WATER: some of the samples come by way of water.
//
// in    uLights   128 samples a row, five texels each:
//                 world position, 1; or unit direction to the light, 0
//                 centre of the lamp [m] | 1: its light falls off with the square of the distance
//                 irradiance on what faces it [W/m²], or that at 1 m | exponent of the cone; of a direction: where the
//                 water begins that it comes through, less than 0, or passes beside; 0: none
//                 unit direction of the cone's axis | share in means over the light
//                 scale and offset of the cosine to the axis | extent; of a place: where its picture begins, 0: none | part
//           and pictures behind them, each with two texels before it: to its right edge, and its width; to its upper edge,
//           and its height (scene::PictureFrame); and a sheet of water, texel by texel a FlatWater
// model the disc of a lamp faces what it lights, so each of its samples counts as the one beside the lamp's middle that is
//       seen in its place
#include "lib/fresnel.glsl"
#ifdef USE_WATER
#include "light/flat_water.glsl"
#endif
uniform sampler2D uLights;

struct LightSample {
    vec3 toLight;    // unit, world
    float distance;  // m; 1e30: without a place
    vec3 irradiance; // on what faces it, nothing in its way [W/m²]
    float weight;    // share in means over the light; 0: no light of the sample comes here, whatever stands in its way
    float extent;    // sine of the angle by which its directions spread; 0: one direction
    float part;      // half the angle under which what it stands for of its lamp is seen, radians; of large ones a tangent
};

vec4 lightTexel(int index) {
    int width = textureSize(uLights, 0).x;
    return texelFetch(uLights, ivec2(index % width, index / width), 0);
}

// What a lamp projects in a direction, bilinear between texel centres; dark beside the picture.
vec3 projectedBy(int picture, vec3 axis, vec3 direction) {
    vec4 right = lightTexel(picture), up = lightTexel(picture + 1);
    float along = dot(direction, axis);
    if (along <= 0.0) return vec3(0.0);
    vec2 at = 0.5 + 0.5 * vec2(dot(direction, right.xyz), -dot(direction, up.xyz)) / along;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return vec3(0.0);
    ivec2 size = ivec2(right.w, up.w);
    vec2 texel = at * vec2(size) - 0.5;
    ivec2 low = clamp(ivec2(floor(texel)), ivec2(0), size - 1);
    ivec2 high = clamp(ivec2(floor(texel)) + 1, ivec2(0), size - 1);
    vec2 part = fract(texel);
    int first = picture + 2;
    return mix(mix(lightTexel(first + low.y * size.x + low.x).rgb, lightTexel(first + low.y * size.x + high.x).rgb, part.x),
               mix(lightTexel(first + high.y * size.x + low.x).rgb, lightTexel(first + high.y * size.x + high.x).rgb, part.x),
               part.y);
}

#ifdef USE_WATER
FlatWater waterAt(int first) {
    return FlatWater(lightTexel(first), lightTexel(first + 1), lightTexel(first + 2), lightTexel(first + 3),
                     lightTexel(first + 4));
}

// The light that comes through a sheet of water: a beam of it is as wide on the surface beneath as above, and narrower or
// wider across. @return whether it reaches the place
bool passWater(FlatWater water, vec3 place, inout LightSample light) {
    vec3 entry, bent;
    if (!entersWater(water, place, light.toLight, entry, bent)) return false;
    float cosine = dot(light.toLight, water.up.xyz);
    float passed = water.absorption.a * cosine / dot(bent, water.up.xyz);
    if (water.up.w > 0.5) passed *= 1.0 - fresnelReflectance(cosine, 1.0 / water.middle.w);
    light.irradiance *= passed * exp(-water.absorption.rgb * distance(place, entry));
    light.toLight = bent;
    return true;
}
#endif

LightSample lightSampleAt(int index, vec3 place) {
    ivec2 at = ivec2(5 * (index % 128), index / 128);
    vec4 source = texelFetch(uLights, at, 0);
    vec4 color = texelFetch(uLights, at + ivec2(2, 0), 0);
    vec4 axis = texelFetch(uLights, at + ivec2(3, 0), 0);
    vec4 cone = texelFetch(uLights, at + ivec2(4, 0), 0);
    if (source.w == 0.0) {
        LightSample light = LightSample(source.xyz, 1e30, color.rgb, axis.w, cone.z, cone.w);
#ifdef USE_WATER
        if (color.a > 0.0 ? crossesWater(waterAt(int(color.a)), place, light.toLight)
                          : color.a < 0.0 && !passWater(waterAt(int(-color.a)), place, light)) {
            light.irradiance = vec3(0.0);
            light.weight = 0.0;
        }
#endif
        return light;
    }
    vec4 centre = texelFetch(uLights, at + ivec2(1, 0), 0);
    vec3 way = centre.xyz - place;
    vec3 towards = way / max(length(way), 1e-30);
    vec3 beside = source.xyz - centre.xyz;
    way += beside - dot(beside, towards) * towards;
    float distance = length(way);
    if (distance == 0.0) return LightSample(vec3(0.0, 1.0, 0.0), 1e-30, vec3(0.0), axis.w, 0.0, 0.0);
    vec3 toLight = way / distance;
    float inCone = pow(clamp(cone.y - cone.x * dot(toLight, axis.xyz), 0.0, 1.0), color.a);
    float falloff = centre.w > 0.5 ? 1.0 / max(distance * distance, 1e-30) : 1.0;
    if (cone.z > 0.0) color.rgb *= projectedBy(int(cone.z), axis.xyz, -toLight);
    return LightSample(toLight, distance, inCone * falloff * color.rgb, axis.w, 0.0, cone.w / distance);
}

// Mean cosine, 0 below the horizon, over the cone of directions of a sample whose middle has this cosine: above the
// horizon the cone's mean direction is (1 + cos) / 2 long; where the horizon cuts it, a quadratic in place of the segment
// of a disc, and the factor gives both the same mean at the horizon itself.
float cosineOf(float cosine, float extent) {
    float reach = 0.85 * extent;
    float mean = 0.5 + 0.5 * sqrt(1.0 - extent * extent);
    if (cosine >= reach) return mean * cosine;
    if (cosine <= -reach) return 0.0;
    float above = cosine + reach;
    return mean * above * above / (4.0 * reach);
}
