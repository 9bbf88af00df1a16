// relief/light.frag: light that some of the lights bring to each visible point of one height field, added to
// what earlier lights brought.
//
// in    uSurface     the visible points (views/surface_pixel.glsl)
//       uSum         light summed so far; not looked at in the first slice
//       uLights      the lights (relief/model.glsl)
//       uOcclusion   USE_OCCLUSION: light/occlusion.glsl
//       uFlux        USE_FLUX: [W/m²] irradiance that caustics add, taken as a matt surface takes it
//       uIrradiance  USE_TRANSFER: the environment's light on each texel, times the forward scatter, and the mean of d
//                    (relief/gather.frag); texels may be fewer than the field's. Walls have none: there all lights are summed
//       uGloss       USE_TRANSFER: the environment's part in the specular term by the direction of reflection
//       LIGHTLESS    no light in this slice and no gloss: the point is not shaded
// out   oSum.rgb     light towards the eye, [W/(m² sr)], linear Rec. 709; SHOW_IRRADIANCE: [W/m²] on the surface, whatever its colour
//       oSum.a       weighted sum of d, or of the quantity that SHOW_... names
// model height-field thesis 2017, 3.5
#pragma variants - METHOD_MARCH METHOD_COUNTING USE_TRANSFER
#pragma variants - SHOW_ITERATIONS SHOW_VISIBILITY SHOW_IRRADIANCE
#pragma variants - USE_BASE_MAP
#pragma variants - USE_DIFFUSE_MAP
#pragma variants - USE_SPECULAR_MAP
#pragma variants - USE_OCCLUSION
#pragma variants - USE_WATER
#pragma variants - USE_FLUX
#pragma variants - LIGHTLESS
#include "relief/model.glsl"
#include "views/surface_pixel.glsl"
#include "light/occlusion.glsl"
uniform sampler2D uSum;
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
#ifdef USE_BASE_MAP
uniform sampler2D uBaseMap;
#endif
#ifdef USE_DIFFUSE_MAP
uniform sampler2D uDiffuseMap;
#endif
#ifdef USE_SPECULAR_MAP
uniform sampler2D uSpecularMap;
#endif
#ifdef USE_TRANSFER
uniform sampler2D uIrradiance;
uniform sampler2D uGloss;

// Bilinear between texel centres, the edges clamped: 32-bit textures need not be filtered by the GPU.
vec4 irradianceAt(vec2 uv) {
    ivec2 size = textureSize(uIrradiance, 0);
    vec2 at = clamp(uv * vec2(size) - 0.5, vec2(0.0), vec2(size) - 1.0);
    ivec2 low = ivec2(at);
    ivec2 high = min(low + 1, size - 1);
    vec2 f = at - vec2(low);
    return mix(mix(texelFetch(uIrradiance, low, 0), texelFetch(uIrradiance, ivec2(high.x, low.y), 0), f.x),
               mix(texelFetch(uIrradiance, ivec2(low.x, high.y), 0), texelFetch(uIrradiance, high, 0), f.x), f.y);
}

// uGloss is a map of directions in object space: columns by azimuth, all around; rows by height z.
vec3 glossAt(vec3 direction) {
    ivec2 size = textureSize(uGloss, 0);
    float azimuth = direction.x == 0.0 && direction.y == 0.0 ? 0.0 : atan(direction.y, direction.x);
    vec2 at = vec2(azimuth / 6.283185307 + 0.5, 0.5 + 0.5 * direction.z) * vec2(size) - 0.5;
    at.y = clamp(at.y, 0.0, float(size.y) - 1.0);
    ivec2 low = ivec2(floor(at));
    ivec2 high = ivec2((low.x + 1) % size.x, min(low.y + 1, size.y - 1));
    vec2 f = at - vec2(low);
    low.x = (low.x + size.x) % size.x;
    vec4 south = mix(texelFetch(uGloss, low, 0), texelFetch(uGloss, ivec2(high.x, low.y), 0), f.x);
    vec4 north = mix(texelFetch(uGloss, ivec2(low.x, high.y), 0), texelFetch(uGloss, high, 0), f.x);
    return mix(south, north, f.y).rgb;
}
#endif
layout(location = 0) out vec4 oSum;

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
    float ks = relief.base.a;
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
#ifdef SHOW_IRRADIANCE
    base = vec3(0.0);
#endif
    vec4 sum = relief.isFirst != 0 ? vec4((1.0 - ks) * base, 0.0)
                                   : texelFetch(uSum, ivec2(gl_FragCoord.xy), 0);
#ifdef USE_FLUX
    vec3 flux = texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef SHOW_IRRADIANCE
    sum.rgb += flux;
#else
    sum.rgb += (1.0 - ks) * relief.factor * diffuse * flux;
#endif
#endif
#ifdef USE_TRANSFER
    bool transferred = pixel.face == 1;
    if (transferred && relief.isFirst != 0) {
        vec4 light = irradianceAt(uv);
        sum += vec4((1.0 - ks) * diffuse * light.rgb, light.a);
    }
#endif
#ifndef LIGHTLESS
    Shading p = shadingAt(pixel);
    vec3 below = p.position - relief.specular.a * p.normal;
    vec3 v = relief.eye.w == 0.0 ? relief.eye.xyz : normalize(below - relief.eye.xyz);
    vec3 r = reflect(v, p.normal); // the text's sign slips in 3.4; 4.3.5.2 has it right
    int end = relief.endLight;
#ifdef USE_TRANSFER
    if (transferred) {
        end = min(end, relief.placed);
        if (relief.isFirst != 0) sum.rgb += ks * specular * glossAt(r);
    }
#endif
    float kf = relief.diffuse.a;
    for (int i = relief.firstLight; i < end; ++i) {
        Light light = lightAt(i, p);
        if (light.weight == 0.0) continue;
        int steps;
        float seen = visibilityOf(i - relief.firstLight, relief.viewSize, relief.columns);
#ifdef SHOW_IRRADIANCE
        float cosine = max(dot(p.normal, light.toLight), 0.0);
        if (cosine > 0.0) sum.rgb += seen * visibility(p, light, steps) * cosine * light.color / relief.factor;
#else
        float d = illumination(p, light, steps);
        float s = falloff(dot(r, light.toLight), relief.falloffs.x, relief.falloffs.y);
        float f = falloff(dot(v, light.toLight), relief.falloffs.z, relief.falloffs.w);
        vec3 scattered = (1.0 - ks) * ((1.0 - kf) + kf * f) * d * diffuse;
        sum.rgb += seen * (scattered + ks * s * specular) * light.color;
#if defined(SHOW_ITERATIONS)
        sum.a += light.weight * float(steps);
#elif defined(SHOW_VISIBILITY)
        sum.a += light.weight * seen * visibility(p, light, steps);
#else
        sum.a += light.weight * d;
#endif
#endif
    }
#endif
    oSum = sum;
}
