// caustics/deposit_block.glsl: the caustic map, which lies in the light's views of the receivers: below, of those that it
// sees; above, of those behind them.
#include "views/view.glsl"
layout(std140) uniform DepositBlock {
    View faces[6];
    vec4 frame; // what is drawn of the map: corner and size, texels
    ivec2 grid; // rays a side
    int faceCount;
    int face;   // that is drawn
    float unit; // [W] that the map counts as 1
    float size; // of a splat, texels; of what bends light: width of a ray's cell [m], of a point's light a metre deep
    int first;  // ray that is drawn
    float spread; // of the directions that the light sample stands for: radians; of a point's light its size, m
    float within; // [m] of the way through what bends light, from whose middle they part
} light;
#include "caustics/map_view.glsl"
#include "caustics/behind.glsl"

#ifdef ONE_VIEW
int drawnFace() { return 0; }
#else
int drawnFace() { return light.face; }
#endif

// Where the face that is drawn begins on the map.
vec2 mapCorner(int layer) {
    int rows = (light.faceCount + 2) / 3;
    return vec2(drawnFace() % 3, drawnFace() / 3 + layer * rows) * light.faces[drawnFace()].size;
}

vec4 clipFromMap(vec2 pixel) { return vec4(2.0 * (pixel - light.frame.xy) / light.frame.zw - 1.0, 0.0, 1.0); }

// Whether a pixel of the map belongs to another face.
bool isBesideFace(vec2 pixel, int layer) {
    pixel -= mapCorner(layer);
    vec2 size = light.faces[drawnFace()].size;
#ifdef PARABOLOIDS
    if (distance(pixel, 0.5 * size) > 0.5 * size.x) return true;
#endif
    return any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, size));
}

const vec4 kAway = vec4(0.0, 0.0, 2.0, 1.0); // beyond everything: what is beside a picture costs llvmpipe ten times as much
