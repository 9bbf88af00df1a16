// views/surface.frag: the first point of a height field that an eye ray meets.
//
// in    uFirst    AS_SHADOW, BEHIND: as in views/shadow.frag; SECOND: views/second.glsl
// out   oSurface  see surface_pixel.glsl; SECOND: of what the first object hides
//       oDepth    AS_SHADOW: [m] along the view, as in views/shadow.frag
// model the bilinear field itself, met exactly; side walls down to field.bottom; open below
#pragma variants - AS_SHADOW SECOND
#pragma variants - BEHIND if AS_SHADOW
#include "views/surface_block.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uAlpha;
#ifdef AS_SHADOW
layout(location = 0) out float oDepth;
#else
layout(location = 0) out vec4 oSurface;
#endif
#ifdef BEHIND
uniform sampler2D uFirst;
const float kSame = 1e-5; // of a depth: what rounding may part
#endif
#ifdef SECOND
#include "views/second.glsl"
#endif

// Coverage at g: the alpha image stretched over the footprint, bilinear between its texel centres.
float coverageAt(vec2 g) {
    ivec2 size = textureSize(uAlpha, 0);
    vec2 at = (g - 0.5) / surface.field.texels * vec2(size) - 0.5;
    vec2 cell = floor(at);
    vec2 f = at - cell;
    ivec2 low = clamp(ivec2(cell), ivec2(0), size - 1);
    ivec2 high = clamp(ivec2(cell) + 1, ivec2(0), size - 1);
    return mix(mix(texelFetch(uAlpha, low, 0).r, texelFetch(uAlpha, ivec2(high.x, low.y), 0).r, f.x),
               mix(texelFetch(uAlpha, ivec2(low.x, high.y), 0).r, texelFetch(uAlpha, high, 0).r, f.x), f.y);
}

// The wall through which a ray enters the footprint.
int wallFace(vec2 g, vec3 direction) {
    vec2 fromLow = abs(g - 0.5);
    vec2 fromHigh = abs(g - 0.5 - surface.field.texels);
    // g.y grows towards -y; only sides that face the ray can be entered
    float left = direction.x > 0.0 ? fromLow.x : 1e30;
    float right = direction.x < 0.0 ? fromHigh.x : 1e30;
    float bottom = direction.y > 0.0 ? fromHigh.y : 1e30;
    float top = direction.y < 0.0 ? fromLow.y : 1e30;
    float nearest = min(min(left, right), min(bottom, top));
    return nearest == left ? 2 : nearest == right ? 3 : nearest == bottom ? 4 : 5;
}

void main() {
#ifdef SECOND
    if (isFirst(surface.object)) discard;
#endif
    // The ray from the pixel's own coordinates: what rasterisers interpolate carries their rounding of corners.
    vec4 onFarPlane = surface.objectFromPixel * vec4(gl_FragCoord.xy - surface.corner - 0.5 * surface.size, 1.0, 1.0);
    vec3 far = onFarPlane.xyz / onFarPlane.w;
    bool parallel = surface.eye.w == 0.0;
    vec3 direction = parallel ? surface.eye.xyz : normalize(far - surface.eye.xyz);
    float reach = parallel ? 1e6 * (1.0 + length(far)) : distance(far, surface.eye.xyz);
    vec2 g = gridFromObject(far.xy, surface.field);
    float reference = 0.5 * (surface.field.lowest + surface.field.highest);
    float z0 = far.z - reference * surface.field.heightScale;
    Ray ray = rayFrom(g, z0, direction, reference, 0.0, surface.field);
    float slope = dot(surface.cut.xyz, direction), above = dot(surface.cut, vec4(far, 1.0));
    if (slope <= 0.0 && above < 0.0) discard;
    float from = slope > 0.0 ? max(-reach, -above / slope) : -reach;
    Crossing hit = walk(ray, surface.field, from, reach, 0.0);
    if (hit.entry > reach) discard;

    vec2 hitG = vec2(ray.base) + ray.origin + hit.entry * ray.step;
    hitG = clamp(hitG, vec2(0.5), surface.field.texels + 0.5);
    bool isWall = hit.entry <= clipToFootprint(ray, surface.field, -reach, reach).x;
    float z = isWall ? far.z + hit.entry * direction.z
                     : heightAt(hitG, surface.field) * surface.field.heightScale;
    if (isWall && (z < surface.field.bottom || direction.xy == vec2(0.0))) discard;
    float coverage = surface.hasAlpha != 0 ? clamp(coverageAt(hitG), 0.0, 1.0) : 1.0;
    if (coverage == 0.0) discard;
    vec4 place = vec4(objectFromGrid(hitG, surface.field), z, 1.0);
#ifdef AS_SHADOW
    oDepth = dot(surface.depthFromObject, place);
#ifdef BEHIND
    if (oDepth <= (1.0 + kSame) * texelFetch(uFirst, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    gl_FragDepth = clamp((oDepth - surface.depths.x) / (surface.depths.y - surface.depths.x), 0.0, 1.0);
#else
    int face = isWall ? wallFace(hitG, direction) : 1;
    oSurface = vec4(hitG, z, packSurface(surface.object, face, coverage));
    vec4 clip = surface.clipFromObject * place;
    gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
#endif
}
