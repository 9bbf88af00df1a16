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
    int padding0, padding1;
} light;
#include "caustics/map_view.glsl"
#include "caustics/behind.glsl"

// Where the face that is drawn begins on the map.
vec2 mapCorner(int layer) {
    int rows = (light.faceCount + 2) / 3;
    return vec2(light.face % 3, light.face / 3 + layer * rows) * light.faces[light.face].size;
}

vec4 clipFromMap(vec2 pixel) { return vec4(2.0 * (pixel - light.frame.xy) / light.frame.zw - 1.0, 0.0, 1.0); }

// Whether a pixel of the map belongs to another face.
bool isBesideFace(vec2 pixel, int layer) {
    pixel -= mapCorner(layer);
    vec2 size = light.faces[light.face].size;
#ifdef PARABOLOIDS
    if (distance(pixel, 0.5 * size) > 0.5 * size.x) return true;
#endif
    return any(lessThan(pixel, vec2(0.0))) || any(greaterThan(pixel, size));
}

const vec4 kAway = vec4(2.0, 2.0, 0.0, 1.0); // outside of every face
