// light/flat_water.glsl: parallel light by way of a sheet of water, as if that lay still: of an environment, whose light
// waves neither gather nor part by much.
#include "light/flat_water_block.glsl"

bool isOnWater(FlatWater water, vec3 place) {
    vec3 v = place - water.middle.xyz;
    vec2 at = vec2(dot(v, water.sideX.xyz), dot(v, water.sideZ.xyz));
    return all(lessThanEqual(abs(at), vec2(water.sideX.w, water.sideZ.w)));
}

// Whether light reaches a place beneath the water by way of its surface, nothing else in its way.
//
// @param toLight  unit
// @param entry    where it enters the water
// @param bent     unit, from the place towards there
bool entersWater(FlatWater water, vec3 place, vec3 toLight, out vec3 entry, out vec3 bent) {
    vec3 up = water.up.xyz;
    float depth = dot(water.middle.xyz - place, up);
    bent = -refract(-toLight, up, 1.0 / water.middle.w);
    float rise = dot(bent, up); // 0: all of it is mirrored, by what is thinner than air
    entry = place + depth / max(rise, 1e-6) * bent;
    return depth > 0.0 && rise > 0.0 && dot(toLight, up) > 0.0 && isOnWater(water, entry);
}

// Whether the straight way there passes through the surface from beneath: no light comes along it.
bool crossesWater(FlatWater water, vec3 place, vec3 toLight) {
    float depth = dot(water.middle.xyz - place, water.up.xyz), rise = dot(toLight, water.up.xyz);
    return depth > 0.0 && rise > 0.0 && isOnWater(water, place + depth / rise * toLight);
}
