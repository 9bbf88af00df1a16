// caustics/footprint.vert: what the light of rays is spread over that no beam carries.
//
// in    gl_VertexID       one a ray, a square point; AS_QUADS: six, a rectangle that fits long thin ones of all directions
//       light.first       the first ray
//       uSides, uShare    caustics/spread.frag
// out   vFlux flat     [light.unit] of a texel (caustics/blurred.glsl)
//       vMiddle flat   [texels] of the whole map
//       vInverse flat  caustics/spread.glsl; zeros: a point (caustics/tent.glsl)
//       vLayer flat    of the map
#include "caustics/deposit_block.glsl"
#include "caustics/spread.glsl"
#include "caustics/blurred.glsl"
#include "caustics/square.glsl"
#include "caustics/tent.glsl"
uniform sampler2D uLanding;
uniform sampler2D uSides;
uniform sampler2D uShare;
flat out vec4 vFlux;
flat out vec2 vMiddle;
flat out vec4 vInverse;
flat out int vLayer;

const float kBeside = 0.0625; // texels around, in which rasterisers round

// Half the sides of the rectangle around a parallelogram, along its longer side and across it.
mat2 boxAround(vec4 sides) {
    vec2 longer = dot(sides.xy, sides.xy) >= dot(sides.zw, sides.zw) ? sides.xy : sides.zw;
    vec2 along = normalize(longer);
    vec2 across = vec2(-along.y, along.x);
    float length_ = 0.5 * (abs(dot(sides.xy, along)) + abs(dot(sides.zw, along))) + kBeside;
    float width = 0.5 * (abs(dot(sides.xy, across)) + abs(dot(sides.zw, across))) + kBeside;
    return mat2(length_ * along, width * across);
}

void main() {
#ifdef AS_QUADS
    int ray = gl_VertexID / 6 + light.first;
#else
    int ray = gl_VertexID + light.first;
#endif
    ivec2 texel = ivec2(ray % light.grid.x, ray / light.grid.x);
    vec4 landing = texelFetch(uLanding, texel, 0);
    vec4 sides = texelFetch(uSides, texel, 0);
    vec4 share = texelFetch(uShare, texel, 0);
    gl_Position = kAway;
    gl_PointSize = 1.0;
    vFlux = vec4(0.0);
    vMiddle = vec2(0.0);
    vInverse = vec4(0.0);
    vLayer = layerOf(landing.w);
    if (share.a == 0.0 || faceOf(landing.xyz) != drawnFace()) return;
    vFlux = blurred(share.rgb, texel, landing.xyz);
    vMiddle = mapCorner(vLayer) + onMap(drawnFace(), landing.xyz).xy;
    vec2 middle = vMiddle;
    if (share.a == kPoint) middle = tentMiddle(vMiddle);
    else vInverse = inverseOf(sides);
#ifdef AS_QUADS
    mat2 box = share.a == kPoint ? mat2(0.5 * kTentSize) : boxAround(sides);
    middle += box * (2.0 * cornerOfSquare(gl_VertexID % 6) - 1.0);
#else
    vec2 reach = abs(sides.xy) + abs(sides.zw);
    gl_PointSize = share.a == kPoint ? kTentSize : ceil(max(reach.x, reach.y)) + 1.0;
#endif
    gl_Position = clipFromMap(middle);
}
