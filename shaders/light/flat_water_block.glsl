// light/flat_water_block.glsl: a sheet of water that lies still.
struct FlatWater {
    vec4 middle;     // world; w: index of refraction
    vec4 up;         // unit; w: 1 with Fresnel's reflection
    vec4 sideX;      // unit; w: half its length along it [m]
    vec4 sideZ;
    vec4 absorption; // 1/m; a: transmission
};
