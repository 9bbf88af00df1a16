// caustics/land.frag: where light that has left the glass meets a receiver.
//
// in    uPlace, uDirection  caustics/photon.frag
//       uShadow             depths of the receivers, seen from the light
//       uBehind, uBack      USE_BEHIND: of those behind them, and of what is turned away from the light behind the first
// out   oLanding  world place; w: the way the light took (caustics/behind.glsl), 0: it meets no receiver that the light's
//                 view shows
//       oEffort   r: looks at the receivers' image; g: how far before the surface the place lies, in texels
// model FIXED_POINT: d <- |receiver(P) - v| from d = 1 m (dissertation 2007, 5.3.3); NEWTON, SECANT: roots of the
//       depth between P and the receiver, which has a sign where the text's distance has none, so that its slope
//       does not jump at the root; else a bracket in which secants are taken and, where they do not halve it, its
//       middle, which no oscillation between two points survives
#pragma variants - FIXED_POINT NEWTON SECANT
#pragma variants - USE_BEHIND
#pragma variants - PACKED
#pragma variants - ONE_VIEW
#include "views/view.glsl"
layout(std140) uniform LandBlock {
    View faces[6];
    vec4 low, high; // of a box around the receivers
    int faceCount;
    int steps;      // looks at most
} light;
#include "caustics/receivers.glsl"
#include "caustics/behind.glsl"
uniform sampler2D uPlace;
uniform sampler2D uDirection;
layout(location = 0) out vec4 oLanding;
layout(location = 1) out vec2 oEffort;

const float kNowhere = -1.0;
int looks = 0;
int layer = 0; // of the receivers, in which the ray meets one

float gapAt(vec3 v, vec3 r, float d) {
    ++looks;
    return lookFrom(v + d * r, layer).gap;
}

#if defined(FIXED_POINT)
float distanceAlong(vec3 v, vec3 r) {
    float d = 1.0;
    while (looks < light.steps) {
        ++looks;
        Glance glance = lookFrom(v + d * r, 0);
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

int mostLooks = 0; // at one of the layers

const int kStretches = 8;      // of the ray, in each of which one crossing is looked for
const float kSteepest = 200.0; // metres of gap a metre of ray: beyond it the light's view jumps from one surface to another

// A stretch of the ray, before the surface at a and behind it at b.
struct Bracket {
    float a, gapA, b, gapB;
};

// The crossing in it; kNowhere where the ray passes behind an edge: what it meets there is turned away from the light.
// The bracket is then what lies around the edge.
float crossingIn(inout Bracket at, vec3 v, vec3 r) {
    float enough = 1e-3 * texelAt(v + at.b * r);
    bool middle = at.gapA > kFar;
    float d = at.b;
    while (looks < mostLooks) {
        d = middle ? 0.5 * (at.a + at.b) : at.a + (at.b - at.a) * at.gapA / (at.gapA - at.gapB);
        float gap = gapAt(v, r, d);
        if (abs(gap) < enough) return d;
        float width = at.b - at.a;
        if (gap > 0.0) {
            at.a = d;
            at.gapA = gap;
        } else {
            at.b = d;
            at.gapB = gap;
        }
        middle = at.gapA > kFar || (!middle && at.b - at.a > 0.5 * width);
    }
    return at.gapA - at.gapB < kSteepest * (at.b - at.a) + enough ? d : kNowhere;
}

// From before the first surface to behind an edge of it: there the second ones lie before it, if any do. A ray that
// enters what is solid instead has met a side that is turned away from the light.
//
// @return  the way on from behind the edge to b; its gapA is not above 0 where there is none
Bracket passBehind(float edge, float b, vec3 v, vec3 r) {
    layer = 2;
    float within = gapAt(v, r, edge);
    layer = 1;
    mostLooks = looks + light.steps;
    float gap = gapAt(v, r, edge);
    bool isSide = within > 0.0 && within < gap + 0.01 * texelAt(v + edge * r); // of what may stand on what lies behind
    return Bracket(edge, isSide ? -1.0 : gap, b, gapAt(v, r, b));
}

float distanceAlong(vec3 v, vec3 r) {
    vec2 part = insideBox(v, r, light.low.xyz, light.high.xyz);
    if (part.x >= part.y) return kNowhere;
    mostLooks = light.steps;
    float a = part.x;
    float gapA = gapAt(v, r, a);
    if (gapA <= 0.0) { // as where glass stands on a receiver
        float step_ = texelAt(v + a * r);
        if (gapA > -0.5 * step_ && gapAt(v, r, a + step_) < gapA) return a;
#ifdef USE_BEHIND
        layer = 1;
        gapA = gapAt(v, r, a);
#endif
        if (gapA <= 0.0) return kNowhere;
    }
    for (int i = 1; i <= kStretches && looks < mostLooks; ++i) {
        float b = mix(part.x, part.y, float(i) / float(kStretches));
        float gapB = gapAt(v, r, b);
#ifdef USE_BEHIND
        if (layer == 1) { // out from behind the first?
            layer = 0;
            float gap = gapAt(v, r, b);
            if (gap > 0.0) gapB = gap;
            else layer = 1;
        }
#endif
        if (gapB <= 0.0) {
            Bracket at = Bracket(a, gapA, b, gapB);
            float d = crossingIn(at, v, r);
#ifdef USE_BEHIND
            if (d == kNowhere && layer == 0) {
                at = passBehind(at.b, b, v, r);
                if (at.gapA <= 0.0) return kNowhere;
                if (at.gapB <= 0.0) return crossingIn(at, v, r);
                gapB = at.gapB;
            } else
#endif
                return d;
        }
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
    Glance glance = lookFrom(landing, layer);
    if (glance.gap > kFar) return;
    oLanding = vec4(landing, place.w);
#ifdef USE_BEHIND
    if (layer == 1 && isBehind(landing)) oLanding.w += kBehind;
#endif
    oEffort.y = glance.gap / texelAt(landing);
}
