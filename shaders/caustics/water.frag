// caustics/water.frag: rays of light that begin on a sheet of water, evenly spread over it from border to border.
//
// in    uPositions, uNormals  its vertices, object space: a row of cells.x + 1 after the other
//       uShadow               USE_SHADOW: depths of what is opaque, seen from the light (views/shadow.glsl)
// out   as caustics/photon.glsl has them, VERTICES; oFlux before the water takes its part. WITH_BOOK: where their light
//       stays, but for that
// model Snell's law and Fresnel's share at one interface; heights and normals bilinear between vertices; flux of a ray:
//       irradiance times the area of its cell across the light
// not   waves that stand in each other's light
#pragma variants - USE_SHADOW
#pragma variants - WITH_BOOK
#include "caustics/lamp.glsl"
#include "views/glass_block.glsl"
layout(std140) uniform WaterRaysBlock {
    View faces[6]; // of the light on what may hide the water
    mat4 worldFromObject;
    mat4 normalFromObject;
    Lamp lamp;
    Glass water;
    vec4 place; // of the light: world; 1, or unit direction to it, 0
    vec4 tint;  // of the light, as part of white
    ivec2 cells;
    ivec2 grid; // rays
    int faceCount;
    int channel; // whose index of refraction counts
    float area;  // m² of a ray's cell
} light;
#include "lib/fresnel.glsl"
#ifdef USE_SHADOW
#include "views/shadow.glsl"
#endif
uniform sampler2D uPositions;
uniform sampler2D uNormals;
#ifdef WITH_BOOK
layout(location = 0) out vec4 oMet;
layout(location = 1) out vec4 oAbsorbed;
layout(location = 2) out vec4 oReflected;
layout(location = 3) out vec4 oLost;
#else
layout(location = 0) out vec4 oPlace;
layout(location = 1) out vec4 oDirection;
layout(location = 2) out vec4 oFlux;
#endif

vec3 vertexOf(sampler2D vertices, ivec2 at) {
    int number = at.y * (light.cells.x + 1) + at.x;
    int width = textureSize(vertices, 0).x;
    return texelFetch(vertices, ivec2(number % width, number / width), 0).xyz;
}

vec3 between(sampler2D vertices, vec2 at) {
    ivec2 low = min(ivec2(at), light.cells - 1);
    vec2 f = at - vec2(low);
    return mix(mix(vertexOf(vertices, low), vertexOf(vertices, low + ivec2(1, 0)), f.x),
               mix(vertexOf(vertices, low + ivec2(0, 1)), vertexOf(vertices, low + 1), f.x), f.y);
}

// The share of a ray's cell that lies on the sheet, of the six triangles around it (caustics/grid.glsl).
float shareOf(ivec2 ray) {
    bvec2 first = equal(ray, ivec2(0));
    bvec2 last = equal(ray, light.grid - 1);
    float count = 6.0;
    if (first.x || last.x) count -= 3.0;
    if (first.y || last.y) count -= 3.0;
    if (all(first) || all(last)) count += 1.0;
    else if ((first.x || last.x) && (first.y || last.y)) count += 2.0;
    return count / 6.0;
}

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    vec2 at = vec2(ray) / vec2(light.grid - 1) * vec2(light.cells);
    vec3 place = (light.worldFromObject * vec4(between(uPositions, at), 1.0)).xyz;
    vec3 normal = normalize(mat3(light.normalFromObject) * between(uNormals, at));
    vec3 up = light.normalFromObject[1].xyz;
    vec3 way = light.place.xyz - light.place.w * place;
    vec3 toLight = normalize(way);
    float cone = pow(clamp(light.lamp.cone.y - light.lamp.cone.x * dot(toLight, light.lamp.axis.xyz), 0.0, 1.0),
                     light.lamp.color.a);
    vec3 flux = light.tint.rgb * light.lamp.color.rgb * cone / (light.lamp.axis.w > 0.5 ? dot(way, way) : 1.0);
    float cosine = max(dot(normal, toLight), 0.0);
    flux *= light.area * cosine / dot(normal, up);
#ifdef USE_SHADOW
    flux *= lightReaching(place, normal);
#endif
    float eta = 1.0 / light.water.ior[light.channel];
    vec3 direction = refract(-toLight, normal, eta);
    float mirrored = light.water.ior.a > 0.5 ? fresnelReflectance(cosine, eta) : 0.0;
    if (direction == vec3(0.0)) mirrored = 1.0;
    float passed = light.water.absorption.a;
#ifdef WITH_BOOK
    float own = shareOf(ray);
    oMet = vec4(own * flux, own);
    oReflected = vec4(own * mirrored * flux, 1.0);
    oAbsorbed = vec4(own * (1.0 - mirrored) * (1.0 - passed) * flux, 1.0);
    oLost = vec4(0.0);
#else
    bool shines = mirrored < 1.0 && flux != vec3(0.0);
    oPlace = vec4(place, shines ? 1.0 : 0.0);
    oDirection = vec4(direction, 0.0);
    oFlux = shines ? vec4((1.0 - mirrored) * passed * flux, 64.0) : vec4(0.0); // all sixths are full
#endif
}
