// caustics/water.frag: rays of light that begin on a sheet of water, evenly spread over it from border to border.
//
// in    uPositions  its vertices, object space: a row of cells.x + 1 after the other
//       uShadow     USE_SHADOW: depths of what is opaque, seen from the light (views/shadow.glsl)
// out   as caustics/photon.glsl has them, VERTICES; oFlux before the water takes its part. WITH_BOOK: where their light
//       stays, but for that
// model Snell's law and Fresnel's share at one interface; heights and normals of the polynomial through the six vertices
//       around along each side; flux of a ray: irradiance times the area of its cell across the light
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
    vec2 cell;  // m, object space
    int faceCount;
    int channel; // whose index of refraction counts
    float area;  // m² of a ray's cell
} light;
#include "lib/fresnel.glsl"
#ifdef USE_SHADOW
#include "views/shadow.glsl"
#endif
uniform sampler2D uPositions;
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

vec3 vertexOf(ivec2 at) {
    int number = at.y * (light.cells.x + 1) + at.x;
    int width = textureSize(uPositions, 0).x;
    return texelFetch(uPositions, ivec2(number % width, number / width), 0).xyz;
}

const int kPoints = 6;

// What each of so many heights in a row adds to the height at a place among them, counted from the first, and to its rise
// from one to the next: Lagrange's polynomials and their derivatives.
void weigh(float at, int count, out float heights[kPoints], out float slopes[kPoints]) {
    for (int i = 0; i < count; ++i) {
        float value = 1.0;
        float slope = 0.0;
        for (int j = 0; j < count; ++j) {
            if (j == i) continue;
            float part = 1.0 / float(i - j);
            slope = part * (slope * (at - float(j)) + value);
            value *= part * (at - float(j));
        }
        heights[i] = value;
        slopes[i] = slope;
    }
}

// The surface at a place in cells, object space.
void surfaceAt(vec2 at, out vec3 place, out vec3 normal) {
    ivec2 count = min(ivec2(kPoints), light.cells + 1);
    ivec2 low = clamp(ivec2(at) - kPoints / 2 + 1, ivec2(0), light.cells + 1 - count);
    float x[kPoints], z[kPoints], alongX[kPoints], alongZ[kPoints];
    weigh(at.x - float(low.x), count.x, x, alongX);
    weigh(at.y - float(low.y), count.y, z, alongZ);
    vec3 sum = vec3(0.0); // height, its rise a cell along x and along z
    for (int row = 0; row < count.y; ++row)
        for (int column = 0; column < count.x; ++column) {
            float height = vertexOf(low + ivec2(column, row)).y;
            sum += height * vec3(x[column] * z[row], alongX[column] * z[row], x[column] * alongZ[row]);
        }
    vec2 corner = vertexOf(ivec2(0)).xz;
    place = vec3(corner.x + at.x * light.cell.x, sum.x, corner.y + at.y * light.cell.y);
    normal = vec3(-sum.y / light.cell.x, 1.0, -sum.z / light.cell.y);
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
    vec3 place, normal;
    surfaceAt(at, place, normal);
    place = (light.worldFromObject * vec4(place, 1.0)).xyz;
    normal = normalize(mat3(light.normalFromObject) * normal);
    vec3 up = light.normalFromObject[1].xyz;
    vec3 way = light.place.xyz - light.place.w * place;
    vec3 toLight = normalize(way);
    vec3 flux = light.tint.rgb * shiningTo(light.lamp, -toLight) / (light.lamp.axis.w > 0.5 ? dot(way, way) : 1.0);
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
    // Rays in the shadow go on without light: between them and their neighbours it fades as it does on the water.
    bool shines = mirrored < 1.0;
    oPlace = vec4(place, shines ? 1.0 : 0.0);
    oDirection = vec4(direction, -1.0);
    oFlux = shines ? vec4((1.0 - mirrored) * passed * flux, 64.0) : vec4(0.0); // all sixths are full
#endif
}
