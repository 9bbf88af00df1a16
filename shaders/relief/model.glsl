// relief/model.glsl: the illumination d of one point of a height field by one light (height-field thesis 2017, ch. 3,
// with the corrections of web/docs/papers.html).
//
// in    uLights  light/sample.glsl
#include "lib/quadratic.glsl"
#include "views/field.glsl"
#include "lib/shading.glsl"
#include "light/sample.glsl"
layout(std140) uniform ReliefBlock {
    Field field;
    vec4 eye;       // object space: position with w = 1, or direction of all eye rays with w = 0
    vec4 base;      // cB | ks
    vec4 diffuse;   // cD | kf
    vec4 specular;  // cS | t in object space
    vec4 falloffs;  // s_min, s_max, f_min, f_max
    mat4 objectFromWorld, worldFromObject;
    float metres;   // world metres a metre of object space
    float radius;   // where the thesis's method puts lights that have no place
    int object;
    int firstLight;
    int endLight;
    int isFirst;    // nothing summed yet: start with the base colour
    int exponential;
    int steps;      // of methods with a fixed step
    int placed;     // lights [0, placed) have no part in what uIrradiance holds; all of them without one
    ivec4 tile;     // of the transfer: see relief/trace.frag
    vec2 grid;      // texels of the transfer
    ivec2 viewSize; // pixels
    int columns;    // of light/occlusion.glsl
    float share;    // of one lamp, or of the environment, in means over the light
    float factor;   // radiance that a white surface with d = 1 has for an irradiance of 1: 1 / pi, or the share of it
} relief;

// The shading point: on the surface, and moved below it along the real normal (4.3.1 moves along z).
struct Shading {
    vec2 g;
    float z;         // m, object space
    vec3 normal;
    vec3 position;   // object space
    float reference; // stored height at the point, with ...
    float offset;    // ... what it stands above that, m: 0 on the field
};

struct Light {
    vec3 toLight;   // unit, from the moved point
    float distance; // m, object space; 1e30: without a place
    vec3 color;
    float weight;
};

Light lightAt(int index, Shading p) {
    vec3 below = p.position - relief.specular.a * p.normal;
    LightSample light = lightSampleAt(index, (relief.worldFromObject * vec4(below, 1.0)).xyz);
    float distance = light.distance < 1e30 ? light.distance / relief.metres : 1e30;
    return Light(normalize(mat3(relief.objectFromWorld) * light.toLight), distance, relief.factor * light.irradiance,
                 relief.share * light.weight);
}

// Ray from the point moved by `depth` along `inward` towards the light; z is relative to the point.
Ray rayToLight(Shading p, vec3 inward, vec3 toLight) {
    vec2 g = p.g + vec2(inward.x, -inward.y) / relief.field.texelSize;
    return rayFrom(g, inward.z, toLight, p.reference, p.offset, relief.field);
}

// 1 where the point sees the light past what lies within one texel.
float visibility(Shading p, Light light, out int steps) {
    vec3 toLight = light.toLight;
    float distance = light.distance;
    if (distance < 1e30) { // seen from the point itself, not from where it was moved to
        vec3 way = distance * toLight - relief.specular.a * p.normal;
        distance = max(length(way), 1e-30);
        toLight = way / distance;
    }
    float across = length(toLight.xy);
    float from = across > 0.0 ? relief.field.texelSize / across : 1e30;
    steps = 0;
    if (from >= distance) return 1.0;
    Crossing crossing = walk(rayToLight(p, vec3(0.0), toLight), relief.field, from, distance, 0.0);
    steps = crossing.steps;
    return crossing.inside > 0.0 ? 0.0 : 1.0;
}

// Length inside the solid from N equal steps over the ray clipped to the field's box, samples in mid-step.
float marchedLength(Ray ray, float far) {
    vec2 span = clipToFootprint(ray, relief.field, 0.0, far);
    float ceiling = relativeHeight(relief.field.highest, ray, relief.field);
    if (ray.rise > 0.0) span.y = min(span.y, (ceiling - ray.z0) / ray.rise);
    if (span.x >= span.y) return 0.0;
    float stepLength = (span.y - span.x) / float(relief.steps);
    int inside = 0;
    for (int i = 0; i < relief.steps; ++i) {
        float s = span.x + (float(i) + 0.5) * stepLength;
        vec2 g = vec2(ray.base) + (ray.origin + s * ray.step);
        if (ray.z0 + s * ray.rise < relativeHeight(heightAt(g, relief.field), ray, relief.field)) inside += 1;
    }
    return float(inside) * stepLength;
}

// The thesis's loop word for word (4.3.1): points at a fixed step from below the surface to the light, one more
// for each that lies inside; d = 1 / s. The point is moved along z, and more steps do not make it converge.
float countedIllumination(Shading p, Light light) {
    float t = relief.specular.a;
    vec3 start = p.position - vec3(0.0, 0.0, t);
    vec3 lamp = light.distance < 1e30 ? p.position - t * p.normal + light.distance * light.toLight
                                      : relief.radius * light.toLight;
    vec3 increment = (lamp - start) / float(relief.steps);
    float s = 1.0;
    for (int i = 0; i <= relief.steps; ++i) {
        vec3 at = start + float(i) * increment;
        vec2 g = gridFromObject(at.xy, relief.field);
        bool over = all(greaterThanEqual(g, vec2(0.5))) && all(lessThanEqual(g, relief.field.texels + 0.5));
        if (over && at.z < heightAt(g, relief.field) * relief.field.heightScale) s += 1.0;
    }
    return 1.0 / s;
}

// d of the model: t over the length inside the solid. Below half a texel the bilinear facets would answer for
// the surface; there its limit for t -> 0 holds: Lambert's cosine on what the light sees.
float illumination(Shading p, Light light, out int steps) {
    steps = relief.steps;
#ifdef METHOD_COUNTING
    return countedIllumination(p, light);
#else
    float t = relief.specular.a;
    bool exponential = relief.exponential != 0;
    if (t < 0.5 * relief.field.texelSize) {
        float cosine = dot(p.normal, light.toLight);
        steps = 0;
        return cosine > 0.0 ? attenuate(1.0 / cosine, exponential) * visibility(p, light, steps) : 0.0;
    }
    Ray ray = rayToLight(p, -t * p.normal, light.toLight);
#ifdef METHOD_MARCH
    float inside = marchedLength(ray, light.distance);
#else
    Crossing crossing = walk(ray, relief.field, 0.0, light.distance, 1e30);
    steps = crossing.steps;
    float inside = crossing.inside;
#endif
    return attenuate(inside / t, exponential);
#endif
}

