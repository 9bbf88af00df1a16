// subsurface/splat.vert: points of light that entered an object, each as a square over all that it may reach.
//
// in    subsurface/level.glsl
// out   vPlace, vNormal, vFlux  flat; of the point; vPlace.w: M_d
#include "subsurface/level.glsl"
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
    vec2 middle = 0.5 * splat.view.size;
    return vec4(acrossX.x / pixelX + middle.x, acrossY.x / pixelY + middle.y, acrossX.y / pixelX + middle.x,
                acrossY.y / pixelY + middle.y);
}

void main() {
    int corner = gl_VertexID % 6;
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
    Point point;
    bool used = findPoint(gl_VertexID / 6, point);
    vPlace = vec4(point.place, point.sharpness);
    vNormal = point.normal;
    vFlux = point.flux;
    if (!used) return;
    vec4 box = pixelsOf(point.place, splat.reach / point.sharpness);
    vec2 low = max(floor(box.xy), splat.bounds.xy);
    vec2 high = min(ceil(box.zw), splat.bounds.zw);
    if (any(greaterThanEqual(low, high))) return;
    bool right = corner == 1 || corner == 2 || corner == 4;
    bool upper = corner == 2 || corner == 4 || corner == 5;
    vec2 pixel = vec2(right ? high.x : low.x, upper ? high.y : low.y);
    gl_Position = vec4(2.0 * pixel / splat.view.size - 1.0, 0.0, 1.0);
}
