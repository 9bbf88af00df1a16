// refract/bisection.glsl: rays through depths of surfaces behind each other (multiple-refractions thesis 2008, 3.5 to
// 3.7): the first surface by its normal, every other one by halving the way to the farthest depth of its layer.
//
// in    views/depth_layers.glsl, uDeepest of views/deepest.frag
// model a ray meets the layers one after the other and ends at the last surface of a pixel, or one that lies within a
//       slice of it. It goes on from the middle of the pixel in which it was found to meet a layer. Normals are
//       NORMALS_STORED, or come from the depths of the 3 x 3 pixels around (NORMALS_NEIGHBOURS) or of the four
//       pixels NORMALS_DELTA away
// not   total reflection, and rays that turn back or run along the screen: such end where they are. What is opaque
//       behind glass
#include "lib/depth_normal.glsl"
#include "views/depth_layers.glsl"
uniform sampler2D uDeepest;

const int kHalvings = 5; // of the thesis

float deepestOf(int layer) { return texelFetch(uDeepest, ivec2((layer >> 2) & 3, layer >> 4), 0)[layer & 3]; }

// kNoDepth beside the picture.
float depthAt(ivec2 pixel, int layer) {
    bool shown = all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(layers.view.size)));
    return shown ? depthOf(pixel, layer, layers.depths) : kNoDepth;
}

#ifndef NORMALS_STORED
// A pixel's place along right, up and forward, in metres.
vec3 placeAcross(ivec2 pixel, float depth) {
    vec2 p = (vec2(pixel) + 0.5 - layers.view.middle) *
             vec2(length(layers.view.right.xyz), length(layers.view.up.xyz));
    return vec3(p * (layers.view.eye.w > 0.5 ? depth : 1.0), depth);
}

vec3 placeBeside(ivec2 pixel, ivec2 offset, int layer, vec3 middle) {
    float depth = depthAt(pixel + offset, layer);
    return depth == kNoDepth ? middle : placeAcross(pixel + offset, depth);
}

// Outward.
vec3 normalFromDepths(ivec2 pixel, int layer, float depth, bool entered) {
    vec3 middle = placeAcross(pixel, depth);
#ifdef NORMALS_NEIGHBOURS
    vec3 ring[8];
    ivec2 offset = ivec2(1, 0);
    for (int i = 0; i < 8; ++i) {
        ring[i] = placeBeside(pixel, offset, layer, middle);
        // An eighth of a turn on along the square.
        offset = clamp(offset + ivec2(-offset.y, offset.x), ivec2(-1), ivec2(1));
    }
    vec3 n = normalFromFan(middle, ring);
#else
    const int d = NORMALS_DELTA;
    vec3 n = normalFromDifferences(
        placeBeside(pixel, ivec2(-d, 0), layer, middle), placeBeside(pixel, ivec2(d, 0), layer, middle),
        placeBeside(pixel, ivec2(0, -d), layer, middle), placeBeside(pixel, ivec2(0, d), layer, middle));
#endif
    vec3 towardsEye = n.x * normalize(layers.view.right.xyz) + n.y * normalize(layers.view.up.xyz) +
                      n.z * layers.view.forward.xyz;
    return entered ? towardsEye : -towardsEye;
}
#endif

// A normal that light can come from on this way: at outlines differences of depths may turn too far.
vec3 turned(vec3 n, vec3 direction, bool entered) {
    float side = entered ? 1.0 : -1.0, slope = dot(n, direction);
    return side * slope < 0.0 ? n : normalize(n - (slope + side * 1e-4) * direction);
}

// Slices know neither objects nor sides: all is the object that the beam met first, and surfaces are entered and left
// in turn.
Crossing crossingOf(ivec2 pixel, int layer, float depth, Walk walk, vec3 direction) {
    Crossing crossing;
    crossing.kind = kGlass;
    crossing.pixel = pixel;
#ifdef FROM_PEEL
    vec4 texel = texelFetch(uLayers, ivec3(pixel, layer), 0);
    vec3 eye = eyeRay(layers.view, vec2(pixel) + 0.5);
    crossing = firstCrossing(pixel, seenAt(pixel, texel, eye), eye);
#else
    crossing.object = walk.object;
    crossing.entered = walk.entered == ((layer & 1) == 0);
#endif
#ifndef NORMALS_STORED
    crossing.normal = normalFromDepths(pixel, layer, depth, crossing.entered);
#endif
    crossing.normal = turned(crossing.normal, direction, crossing.entered);
    return crossing;
}

// Takes the beam to what it meets next.
Crossing advance(inout Beam beam, inout Walk walk, int channel) {
    Crossing crossing;
    crossing.kind = kNothing;
    crossing.entered = true; // is it still inside, then it ran out of layers
    Ray ray = rayOf(layers.view, beam.origin, beam.direction);
    if (ray.along.z <= 0.0) return crossing;
    while (++walk.layer < layers.depthCount) {
        float low = 0.0, high = (deepestOf(walk.layer) - ray.from.z) / ray.along.z;
        if (high <= 0.0) continue;
        ivec2 pixel = ivec2(0);
        float depth = kNoDepth;
        for (int i = 0; i < kHalvings; ++i) {
            float middle = 0.5 * (low + high);
            pixel = ivec2(floor(pixelAt(layers.view, ray, middle)));
            depth = depthAt(pixel, walk.layer);
            if (ray.from.z + middle * ray.along.z < depth) low = middle;
            else high = middle;
        }
        if (depth == kNoDepth) continue;
        vec3 place = placeFrom(layers.view, vec2(pixel) + 0.5, depth);
        beam.weight *= leftAfter(beam, lengthOf(beam, distance(place, beam.origin), channel));
        beam.origin = place;
        crossing = crossingOf(pixel, walk.layer, depth, walk, beam.direction);
        float slice = (layers.depths.y - layers.depths.x) / 255.0;
        if (lastDepthOf(pixel, walk.layer, depth) - depth < slice) walk.layer = layers.depthCount;
        return crossing;
    }
    return crossing;
}
