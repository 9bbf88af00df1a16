// subsurface/splat.vert: points of light that entered an object, each as a square over all that it reaches.
//
// in    subsurface/level.glsl
//       uBalls  subsurface/balls.frag
// out   vPlace, vNormal, vFlux  flat; of the point; vPlace.w: M_d
#include "subsurface/level.glsl"
uniform sampler2D uBalls;
flat out vec4 vPlace;
flat out vec3 vNormal;
flat out vec3 vFlux;

const float kUnbounded = 1e9;

// Between which tangents (of the angle to the view's middle) a ball is seen that lies `depth` deep and `aside`.
vec2 tangentsOf(float aside, float depth, float radius) {
    float square = aside * aside + depth * depth - radius * radius;
    if (square <= 0.0) return vec2(-kUnbounded, kUnbounded); // the eye is in it
    float t = sqrt(square);
    vec2 across = vec2(aside * t - depth * radius, aside * t + depth * radius);
    vec2 along = vec2(depth * t + aside * radius, depth * t - aside * radius);
    return vec2(along.x > 0.0 ? across.x / along.x : -kUnbounded, along.y > 0.0 ? across.y / along.y : kUnbounded);
}

// Lowest and highest pixel of a ball: x, y, then z, w.
vec4 pixelsOf(vec3 place, float radius) {
    vec3 v = place - splat.view.eye.xyz;
    float pixelX = length(splat.view.right.xyz);
    float pixelY = length(splat.view.up.xyz);
    float x = dot(v, splat.view.right.xyz) / pixelX;
    float y = dot(v, splat.view.up.xyz) / pixelY;
    vec2 acrossX = vec2(x - radius, x + radius);
    vec2 acrossY = vec2(y - radius, y + radius);
    if (splat.view.eye.w > 0.5) {
        float depth = dot(v, splat.view.forward.xyz);
        acrossX = tangentsOf(x, depth, radius);
        acrossY = tangentsOf(y, depth, radius);
    }
    vec2 middle = splat.view.middle;
    return vec4(acrossX.x / pixelX + middle.x, acrossY.x / pixelY + middle.y, acrossX.y / pixelX + middle.x,
                acrossY.y / pixelY + middle.y);
}

// What is left of a box of pixels without the squares at its rims whose places the ball does not reach.
vec4 trimmed(vec4 box, vec3 place, float radius) {
    vec4 rest = vec4(kUnbounded, kUnbounded, -kUnbounded, -kUnbounded);
    float side = float(splat.side);
    ivec2 first = ivec2(box.xy / side);
    ivec2 last = ivec2((box.zw - 1.0) / side);
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) {
            vec4 ball = texelFetch(uBalls, ivec2(x, y), 0);
            vec3 away = ball.xyz - place;
            float reach = radius + ball.w;
            bool meets = reach > 0.0 && dot(away, away) < reach * reach;
            if (meets) rest = vec4(min(rest.xy, side * vec2(x, y)), max(rest.zw, side * vec2(x + 1, y + 1)));
        }
    return vec4(max(rest.xy, box.xy), min(rest.zw, box.zw));
}

void main() {
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
    gl_PointSize = 1.0;
    Point point;
    bool used = findPoint(gl_VertexID / splat.corners, point);
    vPlace = vec4(point.place, point.sharpness);
    vNormal = point.normal;
    vFlux = point.flux;
    if (!used) return;
    float radius = splat.reach / point.sharpness;
    vec4 box = pixelsOf(point.place, radius);
    box = vec4(max(floor(box.xy), splat.bounds.xy), min(ceil(box.zw), splat.bounds.zw));
    if (any(greaterThanEqual(box.xy, box.zw))) return;
    box = trimmed(box, point.place, radius);
    vec2 size = box.zw - box.xy;
    if (any(lessThanEqual(size, vec2(0.0)))) return;
    vec2 pixel = box.xy + 0.5 * size;
    gl_PointSize = max(size.x, size.y);
    if (splat.corners > 1) {
        int corner = gl_VertexID % splat.corners;
        bool right = corner == 1 || corner == 2 || corner == 4;
        bool upper = corner == 2 || corner == 4 || corner == 5;
        pixel = vec2(right ? box.z : box.x, upper ? box.w : box.y);
    }
    gl_Position = vec4(2.0 * pixel / splat.view.size - 1.0, 0.0, 1.0);
}
