// views/displaced.frag: the first point of a displaced surface that an eye ray meets above one of its triangles. Of all
// prisms that a pixel shows the depth buffer keeps the nearest such point.
//
// in    uFirst    AS_SHADOW, BEHIND: as in views/shadow.frag; SECOND: views/second.glsl
//       uSurface  SHOW_ITERATIONS: the visible points
// out   oSurface  see surface_pixel.glsl; SECOND: of what the first object hides
//       oDepth    AS_SHADOW: [m] along the view, as in views/shadow.frag
//       oSteps    SHOW_ITERATIONS: places or cells that were looked at above this triangle
// model image-space dissertation 2007, ch. 3, in a prism above each triangle in place of the triangle's plane, so that
//       silhouettes and the depth of other surfaces are right. In the prism a ray is bent: it is cut into stretches
//       that are straight enough.
#pragma variants - AS_SHADOW SECOND SHOW_ITERATIONS
#pragma variants - BEHIND if AS_SHADOW
#pragma variants - SEARCHED
#include "views/displaced_block.glsl"
#include "views/prism.glsl"
#include "views/prism_ray.glsl"
#include "views/height_search.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
flat in int vPrism;
#ifdef AS_SHADOW
layout(location = 0) out float oDepth;
#elif defined(SHOW_ITERATIONS)
layout(location = 0) out vec4 oSteps;
#else
layout(location = 0) out vec4 oSurface;
#endif
#ifdef BEHIND
uniform sampler2D uFirst;
#endif
#ifdef SECOND
#include "views/second.glsl"
#endif
const float kSame = 1e-5; // of a depth: what rounding may part
const float kStraight = 1.0 / 16384.0; // of the heights: a stretch that bends no more is straight
const float kStraightTexels = 1.0 / 4096.0;
const int kMostStretches = 64;

vec3 onMap(Prism prism, vec3 q) {
    return vec3(coordinateAt(prism, q.xy) * (displaced.field.texels - 2.0), q.z);
}

// Of the surface where the map says z and slope [m a texel], outward. The base leans as its normals between corners do:
// its triangles would show.
vec3 displacedNormal(Prism prism, vec3 q, vec2 slope) {
    vec2 texels = displaced.field.texels - 2.0;
    vec3 up = directionAt(prism, q.xy);
    vec3 along1 = prism.place[1] - prism.place[0] + q.z * (prism.direction[1] - prism.direction[0]);
    vec3 along2 = prism.place[2] - prism.place[0] + q.z * (prism.direction[2] - prism.direction[0]);
    along1 -= dot(along1, up) / dot(up, up) * up;
    along2 -= dot(along2, up) / dot(up, up) * up;
    along1 += dot(slope, (prism.coordinate[1] - prism.coordinate[0]) * texels) * up;
    along2 += dot(slope, (prism.coordinate[2] - prism.coordinate[0]) * texels) * up;
    return normalize(cross(along1, along2));
}

// Of a face of the prism where the solid ends.
vec3 faceNormal(Prism prism, int face, vec3 q) {
    vec3 edge1 = prism.place[1] - prism.place[0], edge2 = prism.place[2] - prism.place[0];
    if (face == 3) return -normalize(cross(edge1, edge2));
    vec3 edge = face == 0 ? edge1 : face == 1 ? edge2 - edge1 : -edge2;
    return normalize(cross(edge, directionAt(prism, q.xy)));
}

void main() {
#ifdef SECOND
    if (isFirst(displaced.object)) discard;
#endif
    Prism prism = prismOf(vPrism);
    PrismRay ray = eyeRayIn(prism);
    vec3 origin = ray.origin, direction = ray.direction;
    Stretch inside = stretchIn(prism, origin, direction, displaced.span);
    float from = inside.from;
    if (displaced.eye.w != 0.0) from = max(from, dot(displaced.eye.xyz - prism.middle - origin, direction));
    float slope = dot(displaced.cut.xyz, direction), over = dot(displaced.cut, vec4(prism.middle + origin, 1.0));
    if (slope > 0.0) from = max(from, -over / slope);
    else if (slope < 0.0 || over < 0.0) inside.to = min(inside.to, slope < 0.0 ? -over / slope : -1e30);
    if (!(from < inside.to)) discard;

    vec3 q = inPrism(prism, origin + from * direction, vec3(0.33, 0.33, 0.0));
    vec3 place = onMap(prism, q);
    float sunk = place.z - metresAt(place.xy);
    float height = displaced.span.y - displaced.span.x;
    bool isWall = false;
    int steps = 1;
    float at = from;
    // What begins below the heights comes through a face: where another triangle lies beside, or the eye stands
    // inside, that is none of the surface.
    if (sunk < -1e-4 * height) {
        isWall = from == inside.from &&
                 (inside.face == 3 ? displaced.isClosed == 0
                                   : inside.face < 3 && (prism.walls & (1 << inside.face)) != 0);
        if (!isWall) discard;
    } else {
        vec3 end = inPrism(prism, origin + inside.to * direction, q);
        vec3 middle = inPrism(prism, origin + mix(from, inside.to, 0.5) * direction, mix(q, end, 0.5));
        vec3 bend = abs(onMap(prism, middle) - 0.5 * (place + onMap(prism, end)));
        float bent = max(bend.z / (kStraight * height), max(bend.x, bend.y) / kStraightTexels);
        int count = clamp(int(ceil(sqrt(bent))), 1, kMostStretches);
        Found found = Found(1e30, 0);
        vec3 next = q;
        int i = 0;
        for (; i < count && found.at > 1.0; ++i) {
            next = inPrism(prism, origin + mix(from, inside.to, float(i + 1) / float(count)) * direction, next);
            vec3 nextPlace = onMap(prism, next);
            found = findBelow(place, nextPlace - place);
            steps += found.steps;
            place = nextPlace;
        }
        if (found.at > 1.0) discard;
        at = mix(from, inside.to, (float(i - 1) + found.at) / float(count));
        q = inPrism(prism, origin + at * direction, next);
        // Of what overlaps with neighbours each shows its own.
        if (min(min(q.x, q.y), 1.0 - q.x - q.y) < -2.0 * kRoom) discard;
        place = onMap(prism, q);
    }
    vec4 seen = vec4(prism.middle + origin + at * direction, 1.0);
    float depth = dot(displaced.depthFromObject, seen);
    vec4 clip = displaced.clipFromObject * seen;
#ifdef AS_SHADOW
    oDepth = depth;
#ifdef BEHIND
    if (oDepth <= (1.0 + kSame) * texelFetch(uFirst, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    gl_FragDepth = clamp((oDepth - displaced.depths.x) / (displaced.depths.y - displaced.depths.x), 0.0, 1.0);
#else
    gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
#ifdef SHOW_ITERATIONS
    SurfacePixel pixel = readSurface();
    if (pixel.object != displaced.object || abs(depth - pixel.z) > kSame * abs(pixel.z)) discard;
    oSteps = vec4(vec3(0.0), float(steps));
#else
    vec3 normal = isWall ? faceNormal(prism, inside.face, q) : displacedNormal(prism, q, slopeAt(place.xy));
    oSurface = vec4(octahedralFrom(normalize(mat3(displaced.normalFromObject) * normal)), depth,
                    packSurface(displaced.object, kMeshFace, 1.0));
#endif
#endif
}
