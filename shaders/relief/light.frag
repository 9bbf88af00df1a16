// relief/light.frag: light that some of the lights bring to each visible point of one height field, added to
// what earlier lights brought.
//
// in    uSurface  the visible points (views/surface_pixel.glsl)
//       uSum      light summed so far; not looked at in the first slice
//       uLights   512 lights a row, two texels each: (world position, or direction to it | kind), (colour | weight); kind 0 is
//                 a direction, 1 a position, 2 a position whose light fades with the square of the distance
// out   oSum.rgb  light towards the eye, linear Rec. 709, the thesis's units (no pi)
//       oSum.a    weighted sum of d, or of the quantity that SHOW_... names
// model height-field thesis 2017, 3.5, with the corrections in README "Where the thesis is loose"
#include "lib/quadratic.glsl"
#include "views/field.glsl"
#include "views/surface_pixel.glsl"
#include "lib/shading.glsl"
layout(std140) uniform ReliefBlock {
    Field field;
    vec4 eye;       // object space: position with w = 1, or direction of all eye rays with w = 0
    vec4 base;      // cB | ks
    vec4 diffuse;   // cD | kf
    vec4 specular;  // cS | t in object space
    vec4 falloffs;  // s_min, s_max, f_min, f_max
    mat4 objectFromWorld;
    float metres;   // world metres a metre of object space
    float radius;   // where the thesis's method puts lights that have no place
    int object;
    int firstLight;
    int endLight;
    int isFirst;    // nothing summed yet: start with the base colour
    int exponential;
    int steps;      // of methods with a fixed step
} relief;
uniform sampler2D uSum;
uniform sampler2D uLights;
#ifdef USE_BASE_MAP
uniform sampler2D uBaseMap;
#endif
#ifdef USE_DIFFUSE_MAP
uniform sampler2D uDiffuseMap;
#endif
#ifdef USE_SPECULAR_MAP
uniform sampler2D uSpecularMap;
#endif
layout(location = 0) out vec4 oSum;

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
    ivec2 at = ivec2(2 * (index % 512), index / 512);
    vec4 place = texelFetch(uLights, at, 0);
    vec4 color = texelFetch(uLights, at + ivec2(1, 0), 0);
    vec3 local = (relief.objectFromWorld * vec4(place.xyz, place.w == 0.0 ? 0.0 : 1.0)).xyz;
    if (place.w == 0.0) return Light(normalize(local), 1e30, color.rgb, color.a);
    vec3 way = local - p.position + relief.specular.a * p.normal;
    float far = max(length(way), 1e-30);
    float fade = place.w == 1.0 ? 1.0 : 1.0 / max(far * far * relief.metres * relief.metres, 1e-30);
    return Light(way / far, far, color.rgb * fade, color.a);
}

// Ray from the point moved by `depth` along `inward` towards the light; z is relative to the point.
Ray rayToLight(Shading p, vec3 inward, vec3 toLight) {
    vec2 g = p.g + vec2(inward.x, -inward.y) / relief.field.texelSize;
    return rayFrom(g, inward.z, toLight, p.reference, p.offset, relief.field);
}

// 1 where the point sees the light past what lies within one texel.
float visibility(Shading p, Light light, out int steps) {
    float across = length(light.toLight.xy);
    float from = across > 0.0 ? relief.field.texelSize / across : 1e30;
    steps = 0;
    if (from >= light.distance) return 1.0;
    Crossing crossing = walk(rayToLight(p, vec3(0.0), light.toLight), relief.field, from, light.distance, 0.0);
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

Shading shadingAt(SurfacePixel pixel) {
    Shading p;
    p.g = pixel.g;
    p.z = pixel.z;
    bool onField = pixel.face == 1;
    p.normal = onField ? normalAt(pixel.g, relief.field) : wallNormal(pixel.face);
    p.position = vec3(objectFromGrid(pixel.g, relief.field), pixel.z);
    p.reference = onField ? heightAt(pixel.g, relief.field) : 0.0;
    p.offset = onField ? 0.0 : pixel.z;
    return p;
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != relief.object) discard;
    Shading p = shadingAt(pixel);
    float ks = relief.base.a;
    float kf = relief.diffuse.a;
    vec3 base = relief.base.rgb;
    vec3 diffuse = relief.diffuse.rgb;
    vec3 specular = relief.specular.rgb;
    vec2 uv = (pixel.g - 0.5) / relief.field.texels;
#ifdef USE_BASE_MAP
    base *= textureLod(uBaseMap, uv, 0.0).rgb;
#endif
#ifdef USE_DIFFUSE_MAP
    diffuse *= textureLod(uDiffuseMap, uv, 0.0).rgb;
#endif
#ifdef USE_SPECULAR_MAP
    specular *= textureLod(uSpecularMap, uv, 0.0).rgb;
#endif
    vec3 below = p.position - relief.specular.a * p.normal;
    vec3 v = relief.eye.w == 0.0 ? relief.eye.xyz : normalize(below - relief.eye.xyz);
    vec3 r = reflect(v, p.normal); // the text's sign slips in 3.4; 4.3.5.2 has it right

    vec4 sum = relief.isFirst != 0 ? vec4((1.0 - ks) * base, 0.0)
                                   : texelFetch(uSum, ivec2(gl_FragCoord.xy), 0);
    for (int i = relief.firstLight; i < relief.endLight; ++i) {
        Light light = lightAt(i, p);
        int steps;
        float d = illumination(p, light, steps);
        float s = falloff(dot(r, light.toLight), relief.falloffs.x, relief.falloffs.y);
        float f = falloff(dot(v, light.toLight), relief.falloffs.z, relief.falloffs.w);
        vec3 scattered = (1.0 - ks) * ((1.0 - kf) + kf * f) * d * diffuse;
        sum.rgb += (scattered + ks * s * specular) * light.color;
#if defined(SHOW_ITERATIONS)
        sum.a += light.weight * float(steps);
#elif defined(SHOW_VISIBILITY)
        sum.a += light.weight * visibility(p, light, steps);
#else
        sum.a += light.weight * d;
#endif
    }
    oSum = sum;
}
