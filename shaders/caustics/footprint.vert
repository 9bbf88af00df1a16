// caustics/footprint.vert: rays of what no beam carries, as the parallelograms that it becomes on the receivers.
//
// in    gl_VertexID    one a ray
//       uFlux [W]      caustics/photon.frag, PIXELS or RESTS
//       uGridLanding   OF_RESTS: where the rays through the middles of cells land
// out   vFlux flat     [light.unit] of a texel
//       vMiddle flat   [texels] of the whole map
//       vInverse flat  from texels beside the middle to the parallelogram's own coordinates, -1/2 to 1/2; zeros: a
//                      point (caustics/tent.glsl)
//       vLayer flat    of the map
// model half the way between the neighbouring rays that landed on the same surface (photon differentials after
//       Schjoth 2007), or the whole way to one of them
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
#include "caustics/tent.glsl"
uniform sampler2D uFlux;
flat out vec3 vFlux;
flat out vec2 vMiddle;
flat out vec4 vInverse;
flat out int vLayer;
#ifdef OF_RESTS
uniform sampler2D uGridLanding;
#endif

const float kSmall = 2.0; // texels, of what is a point

vec4 neighbour(ivec2 ray, vec4 landing, vec3 along) {
    if (any(lessThan(ray, ivec2(0))) || any(greaterThanEqual(ray, light.grid))) return vec4(0.0);
    vec4 other = texelFetch(uLanding, ray, 0);
#ifdef OF_RESTS
    if (other.w == 0.0) other = texelFetch(uGridLanding, ray, 0);
#endif
    return other.w == landing.w && isNear(landing.xyz, other.xyz, along) ? other : vec4(0.0);
}

// How the landing moves from ray to ray, in texels.
vec2 across(ivec2 ray, ivec2 step_, vec4 landing, vec3 along) {
    vec4 before = neighbour(ray - step_, landing, along);
    vec4 after = neighbour(ray + step_, landing, along);
    vec3 here = onMap(light.face, landing.xyz);
    vec3 low = before.w > 0.0 ? onMap(light.face, before.xyz) : here;
    vec3 high = after.w > 0.0 ? onMap(light.face, after.xyz) : here;
    bool perspective = light.faces[light.face].eye.w > 0.5;
    if (perspective && min(low.z, high.z) <= 0.0) return vec2(0.0);
    return (high.xy - low.xy) / (before.w > 0.0 && after.w > 0.0 ? 2.0 : 1.0);
}

const float kMostCounted = 8.0; // texels a side of the box around a parallelogram

// How many texels one covers.
float covered(vec2 place, vec4 inverse_, float side) {
    vec2 low = floor(place - 0.5 * side) + 0.5;
    float count = 0.0;
    for (float y = 0.0; y <= side; ++y)
        for (float x = 0.0; x <= side; ++x) {
            vec2 beside = low + vec2(x, y) - place;
            if (max(abs(dot(inverse_.xy, beside)), abs(dot(inverse_.zw, beside))) <= 0.5) ++count;
        }
    return count;
}

void main() {
    ivec2 ray = ivec2(gl_VertexID % light.grid.x, gl_VertexID / light.grid.x);
    vec4 landing = texelFetch(uLanding, ray, 0);
    gl_Position = kAway;
    gl_PointSize = kTentSize;
    vFlux = vec3(0.0);
    vMiddle = vec2(0.0);
    vInverse = vec4(0.0);
    vLayer = layerOf(landing.w);
    if (landing.w == 0.0 || faceOf(landing.xyz) != light.face) return;
    View face = light.faces[light.face];
    vec3 along = face.eye.w > 0.5 ? normalize(landing.xyz - face.eye.xyz) : face.forward.xyz;
    vec2 place = onMap(light.face, landing.xyz).xy;
    vec2 u = across(ray, ivec2(1, 0), landing, along);
    vec2 v = across(ray, ivec2(0, 1), landing, along);
#ifdef OF_RESTS
    float part = sqrt(texelFetch(uFlux, ray, 0).a); // of a cell, along each side
    u *= part;
    v *= part;
#endif
    vec2 reach = abs(u) + abs(v);
    float shrink = min(1.0, (light.size - 1.0) / max(max(reach.x, reach.y), 1e-6)); // points have a largest size
    u *= shrink;
    v *= shrink;
    float area = u.x * v.y - u.y * v.x;
    vFlux = texelFetch(uFlux, ray, 0).rgb / light.unit;
    vMiddle = mapCorner(vLayer) + place;
    gl_Position = clipFromMap(tentMiddle(vMiddle));
    if (abs(area) < kSmall) return;
    vec4 inverse_ = vec4(v.y, -v.x, -u.y, u.x) / area;
    float side = ceil(max(reach.x, reach.y));
    float count = side <= kMostCounted ? covered(place, inverse_, side) : abs(area); // of large ones their area
    if (count == 0.0) return;
    gl_Position = clipFromMap(vMiddle);
    vFlux /= count;
    vInverse = inverse_;
    gl_PointSize = ceil(shrink * max(reach.x, reach.y)) + 1.0;
}
