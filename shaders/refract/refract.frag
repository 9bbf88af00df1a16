// refract/refract.frag: what the eye sees through refractive objects.
//
// in    views/layers.glsl   all their surfaces
//       uOpaque             the shaded opaque surfaces and the background; a: coverage
//       views/environment.glsl
// out   oColor  COLOR: linear Rec. 709; DIRECTION: the last direction of green light; a: coverage, of DIRECTION 0
//               where the ray was given up or left the picture inside an object (its colour is what it shows if it
//               goes on as it does)
// model Snell's law at every interface (thesis 2008, ch. 3); total reflection followed; of Fresnel's reflections
//       the first one that the eye meets (dissertation 2007, 5); absorption along the geometric way
// not   reflections inside, light from what the view does not show
#include "views/glass_block.glsl"
#include "views/view.glsl"
layout(std140) uniform RefractBlock {
    View view;
    mat4 mapFromWorld;
    Glass glass[kMostGlass];
    int count;       // layers
    int hasEnvironment;
    float intensity; // of the environment
    int around;      // a bit for each object whose box holds the eye
} layers;
#include "views/glass.glsl"
#include "views/environment.glsl"
#ifdef USE_SOLID
uniform sampler2D uOpaque;
#endif
layout(location = 0) out vec4 oColor;

vec4 environmentAt(vec3 direction) {
    if (layers.hasEnvironment == 0) return vec4(0.0);
    return vec4(layers.intensity * mapRadiance(mat3(layers.mapFromWorld) * direction), 1.0);
}

// Follows a beam to its end; `first` is a crossing that is known already.
vec4 follow(inout Beam beam, Crossing crossing, bool known, int channel) {
    int reflections = 0;
    for (int i = 0; i < kMostInterfaces; ++i) {
        if (!known) {
            Ray ray = rayOf(layers.view, beam.origin, beam.direction);
            crossing = march(layers.view, ray, beam.inside);
            if (crossing.kind != kNothing) beam.weight *= leftAfter(beam, crossing.t);
            beam.origin += crossing.t * beam.direction;
        }
        known = false;
        if (crossing.kind == kNothing) {
            vec4 light = environmentAt(beam.direction);
            return crossing.entered && beam.inside != 0 ? vec4(light.rgb, -1.0) : light;
        }
        if (crossing.kind == kLost) return vec4(0.0, 0.0, 0.0, -1.0);
#ifdef USE_SOLID
        if (crossing.kind == kSolid) return vec4(texelFetch(uOpaque, crossing.pixel, 0).rgb, 1.0);
#endif
        if (cross_(beam, crossing, channel).x > 0.0 && ++reflections > kMostTotalReflections) break;
    }
    return vec4(0.0, 0.0, 0.0, -1.0);
}

// Objects that the eye is inside of: of those around it the ones whose nearest surface in this pixel shows its
// back.
int insideAtEye(ivec2 pixel) {
    if (layers.around == 0) return 0;
    int seen = ~layers.around, inside = 0;
    for (int layer = 0; layer < layers.count; ++layer) {
        vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
        if (texel.w == 0.0) break;
        int bit = 1 << objectOf(texel);
        if ((seen & bit) == 0 && !facesView(texel)) inside |= bit;
        seen |= bit;
    }
    return inside;
}

vec4 throughGlass(ivec2 pixel, vec4 texel, vec3 eye, int channel) {
    Beam start = Beam(placeFrom(layers.view, vec2(pixel) + 0.5, texel.x), eye, insideAtEye(pixel), vec3(1.0));
    start.weight = leftAfter(start, length(start.origin));
    Crossing first = firstCrossing(pixel, texel, eye);
    Beam beam = start;
    vec2 mirrored = cross_(beam, first, channel);
    if (mirrored.x > 0.0) beam.inside = start.inside;
    Beam onwards = beam;
    vec4 light = follow(onwards, first, false, channel);
#ifdef SHOW_DIRECTION
    return vec4(onwards.direction, light.a < 0.0 ? 0.0 : 1.0);
#else
    vec4 color = vec4(onwards.weight * max(light.rgb, 0.0), 1.0);
    if (mirrored.y > 0.0) {
        Beam back = start;
        back.direction = reflect(eye, first.normal);
        back.weight *= mirrored.y;
        vec4 reflection = follow(back, first, false, channel);
        color.rgb += back.weight * max(reflection.rgb, 0.0);
    }
    return color;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 eye = eyeRay(layers.view, gl_FragCoord.xy);
#ifdef SHOW_LAYERS
    float count = 0.0;
    while (count < float(layers.count) && texelFetch(uLayers, ivec3(pixel, int(count)), 0).w > 0.0) ++count;
    oColor = vec4(vec3(count), 1.0);
    return;
#endif
    vec4 texel = layers.count > 0 ? texelFetch(uLayers, ivec3(pixel, 0), 0) : vec4(0.0);
#ifdef USE_SOLID
    vec4 solid = texelFetch(uSolid, pixel, 0);
    if (solid.a > 0.0 && (texel.w == 0.0 || solid.r <= texel.x)) {
#ifdef SHOW_DIRECTION
        oColor = vec4(eye, 1.0);
#else
        oColor = vec4(texelFetch(uOpaque, pixel, 0).rgb, 1.0);
#endif
        return;
    }
#endif
    if (texel.w == 0.0) {
#ifdef SHOW_DIRECTION
        oColor = vec4(eye, 1.0);
#else
        oColor = environmentAt(eye);
#endif
        return;
    }
#if defined(SHOW_DIRECTION) || !defined(USE_DISPERSION)
    oColor = throughGlass(pixel, texel, eye, 1);
#else
    vec4 color = vec4(0.0, 0.0, 0.0, 1.0); // WebGL lets no output be indexed
    for (int channel = 0; channel < 3; ++channel) color[channel] = throughGlass(pixel, texel, eye, channel)[channel];
    oColor = color;
#endif
}
