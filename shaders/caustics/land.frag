// caustics/land.frag: where light that has left the glass meets a receiver.
//
// in    uPlace, uDirection  caustics/photon.frag
//       uShadow             depths of the receivers, seen from the light
// out   oLanding  world place; w: the way the light took, 0: it meets no receiver that the light's view shows
//       oEffort   r: looks at the receivers' image; g: how far before the surface the place lies, in texels
// model FIXED_POINT: d <- |receiver(P) - v| from d = 1 m (dissertation 2007, 5.3.3); NEWTON, SECANT: roots of the
//       depth between P and the receiver, which has a sign where the text's distance has none, so that its slope
//       does not jump at the root; else a bracket in which secants are taken and, where they do not halve it, its
//       middle, which no oscillation between two points survives
#include "views/view.glsl"
layout(std140) uniform LandBlock {
    View faces[6];
    vec4 low, high; // of a box around the receivers
    int faceCount;
    int steps;      // looks at most
    int padding0, padding1;
} light;
#include "caustics/receivers.glsl"
uniform sampler2D uPlace;
uniform sampler2D uDirection;
layout(location = 0) out vec4 oLanding;
layout(location = 1) out vec2 oEffort;

const float kNowhere = -1.0;
int looks = 0;

float gapAt(vec3 v, vec3 r, float d) {
    ++looks;
    return lookFrom(v + d * r).gap;
}

#if defined(FIXED_POINT)
float distanceAlong(vec3 v, vec3 r) {
    float d = 1.0;
    while (looks < light.steps) {
        ++looks;
        Glance glance = lookFrom(v + d * r);
        if (glance.gap > kFar) return kNowhere;
        d = distance(glance.surface, v);
    }
    return d;
}
#elif defined(NEWTON)
float distanceAlong(vec3 v, vec3 r) {
    float d = 1.0;
    while (looks + 1 < light.steps) {
        float gap = gapAt(v, r, d);
        float aside = 2.0 * texelAt(v + d * r);
        float next = gapAt(v, r, d + aside);
        if (max(gap, next) > kFar) return kNowhere;
        if (next == gap) break;
        d -= gap * aside / (next - gap);
    }
    return d;
}
#elif defined(SECANT)
float distanceAlong(vec3 v, vec3 r) {
    float before = 0.0;
    float d = 1.0;
    float gapBefore = gapAt(v, r, before);
    while (looks < light.steps) {
        float gap = gapAt(v, r, d);
        if (max(gap, gapBefore) > kFar) return kNowhere;
        if (gap == gapBefore) break;
        float next = d - gap * (d - before) / (gap - gapBefore);
        before = d;
        gapBefore = gap;
        d = next;
    }
    return d;
}
#else
#include "caustics/box.glsl"

const int kStretches = 8;      // of the ray, in each of which one crossing is looked for
const float kSteepest = 200.0; // metres of gap a metre of ray: beyond it the light's view jumps from one surface to another

// A crossing of [a, b], before the surface at a and behind it at b; kNowhere where the ray passes behind an edge:
// what it meets there is turned away from the light.
float crossingIn(vec3 v, vec3 r, float a, float gapA, float b, float gapB) {
    float enough = 1e-3 * texelAt(v + b * r);
    bool middle = gapA > kFar;
    float d = b;
    while (looks < light.steps) {
        d = middle ? 0.5 * (a + b) : a + (b - a) * gapA / (gapA - gapB);
        float gap = gapAt(v, r, d);
        if (abs(gap) < enough) return d;
        float width = b - a;
        if (gap > 0.0) {
            a = d;
            gapA = gap;
        } else {
            b = d;
            gapB = gap;
        }
        middle = gapA > kFar || (!middle && b - a > 0.5 * width);
    }
    return gapA - gapB < kSteepest * (b - a) + enough ? d : kNowhere;
}

float distanceAlong(vec3 v, vec3 r) {
    vec2 part = insideBox(v, r, light.low.xyz, light.high.xyz);
    if (part.x >= part.y) return kNowhere;
    float a = part.x;
    float gapA = gapAt(v, r, a);
    if (gapA <= 0.0) { // as where glass stands on a receiver
        float step_ = texelAt(v + a * r);
        return gapA > -0.5 * step_ && gapAt(v, r, a + step_) < gapA ? a : kNowhere;
    }
    for (int i = 1; i <= kStretches && looks < light.steps; ++i) {
        float b = mix(part.x, part.y, float(i) / float(kStretches));
        float gapB = gapAt(v, r, b);
        if (gapB <= 0.0) return crossingIn(v, r, a, gapA, b, gapB);
        a = b;
        gapA = gapB;
    }
    return kNowhere;
}
#endif

void main() {
    ivec2 ray = ivec2(gl_FragCoord.xy);
    vec4 place = texelFetch(uPlace, ray, 0);
    vec4 direction = texelFetch(uDirection, ray, 0);
    oLanding = vec4(0.0);
    oEffort = vec2(0.0);
    if (place.w == 0.0) return;
    if (direction.w > 0.0) {
        oLanding = place;
        return;
    }
    float d = distanceAlong(place.xyz, direction.xyz);
    oEffort = vec2(looks, 0.0);
    if (d < 0.0) return;
    vec3 landing = place.xyz + d * direction.xyz;
    Glance glance = lookFrom(landing);
    if (glance.gap > kFar) return;
    oLanding = vec4(landing, place.w);
    oEffort.y = glance.gap / texelAt(landing);
}
