// caustics/line.vert: rays that have left the glass as lines in the camera's picture (thesis on multiple refractions
// 2008, after Krueger et al. 2006).
//
// in    gl_VertexID                two a ray
//       uPlace, uDirection, uFlux  caustics/photon.frag
// out   vOrigin, vDirection flat   the ray [m, unit, world]
//       vRange flat                the part of it that is drawn [m]
//       vEnds flat                 where that begins and ends in the picture [pixels]
//       vDepths flat               depths there [m]; of a parallel view 1
//       vFlux flat                 [light.unit]
// model lines are a pixel longer at both ends, so that no ray is too short to be drawn
#include "caustics/lines_block.glsl"
#include "caustics/box.glsl"
uniform sampler2D uPlace;
uniform sampler2D uDirection;
uniform sampler2D uFlux;
flat out vec3 vOrigin;
flat out vec3 vDirection;
flat out vec2 vRange;
flat out vec4 vEnds;
flat out vec2 vDepths;
flat out vec3 vFlux;

void main() {
    int number = gl_VertexID / 2;
    ivec2 ray = ivec2(number % light.grid.x, number / light.grid.x);
    vec4 place = texelFetch(uPlace, ray, 0);
    vec4 direction = texelFetch(uDirection, ray, 0);
    vOrigin = place.xyz;
    vDirection = direction.xyz;
    vFlux = texelFetch(uFlux, ray, 0).rgb / light.unit;
    vRange = vec2(0.0);
    vEnds = vec4(0.0);
    vDepths = vec2(1.0);
    gl_Position = vec4(2.0, 2.0, 0.0, 1.0); // outside
    if (place.w == 0.0) return;
    View view = light.view;
    bool perspective = view.eye.w > 0.5;
    vec3 from = inView(view, vOrigin - view.eye.xyz);
    vec3 along = inView(view, vDirection);
    if (direction.w > 0.0) { // it is there already
        float pixel = length(view.right.xyz) * (perspective ? from.z : 1.0);
        vRange = vec2(-pixel, pixel);
    } else {
        vRange = insideBox(vOrigin, vDirection, light.low.xyz, light.high.xyz);
    }
    if (perspective && along.z != 0.0) {
        float t = (view.right.w - from.z) / along.z; // where it meets the near plane
        if (along.z > 0.0) vRange.x = max(vRange.x, t);
        else vRange.y = min(vRange.y, t);
    }
    if (vRange.x >= vRange.y || (perspective && from.z + vRange.y * along.z <= 0.0)) return;
    vec3 first = from + vRange.x * along;
    vec3 last = from + vRange.y * along;
    if (perspective) vDepths = vec2(first.z, last.z);
    vEnds = vec4(pixelOf(view, first), pixelOf(view, last));
    vec2 way = vEnds.zw - vEnds.xy;
    vec2 unit = length(way) > 1e-3 ? normalize(way) : vec2(1.0, 0.0);
    vec2 pixel = (gl_VertexID & 1) == 0 ? vEnds.xy - unit : vEnds.zw + unit;
    gl_Position = vec4(2.0 * pixel / view.size - 1.0, 0.0, 1.0);
}
