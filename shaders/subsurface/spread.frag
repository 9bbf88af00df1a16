// subsurface/spread.frag: light on few places, carried to twice as many along both sides of the picture and added there.
//
// in    uCoarse        subsurface/receivers.frag of the few places
//       uFine          of the many
//       uRadiosity     [W/m²] of the few
// out   oRadiosity     of the many
// model what is linear through space fits those of the nine places around that belong to the same object best, the
//       nearer in the picture the more: places on both sides of the rim of a body, or all on one, are as good as others
layout(std140) uniform SpreadBlock {
    int side;      // of a square of the many, pixels
    float width;   // of a pixel [m], of a perspective view a metre deep
    int perspective;
    vec4 eye;      // world
    vec4 forward;
} spread;
uniform sampler2D uCoarse;
uniform sampler2D uFine;
uniform sampler2D uRadiosity;
layout(location = 0) out vec4 oRadiosity;

const float kNear = 8.0; // widths of a square of the few: a surface 7 degrees from edge-on. Chosen by eye
const float kRidge = 1e-3; // chosen by eye

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 mine = texelFetch(uFine, texel, 0);
    if (mine.w == 0.0) discard;
    float depth = spread.perspective != 0 ? dot(mine.xyz - spread.eye.xyz, spread.forward.xyz) : 1.0;
    int side = spread.side;
    float width = 2.0 * float(side) * spread.width * depth; // of a square of the few
    vec2 pixel = vec2(texel * side + side / 2);
    vec2 at = (pixel - float(side)) / float(2 * side);
    ivec2 nearest = ivec2(floor(at + 0.5));
    ivec2 last = textureSize(uCoarse, 0) - 1;
    mat4 moments = mat4(0.0);
    mat4x3 lights = mat4x3(0.0); // a column for each of 1 and the three axes
    for (int i = 0; i < 9; ++i) {
        ivec2 from = nearest - 1 + ivec2(i % 3, i / 3);
        if (any(lessThan(from, ivec2(0))) || any(greaterThan(from, last))) continue;
        vec4 other = texelFetch(uCoarse, from, 0);
        vec3 away = (other.xyz - mine.xyz) / width;
        if (other.w != mine.w || dot(away, away) > kNear * kNear) continue;
        vec2 share = max(1.0 - abs(vec2(from) - at) / 1.5, 1e-3);
        float weight = share.x * share.y;
        vec4 terms = vec4(1.0, away);
        moments += weight * outerProduct(terms, terms);
        lights += weight * outerProduct(texelFetch(uRadiosity, from, 0).rgb, terms);
    }
    float sum = moments[0][0];
    if (sum == 0.0) discard;
    // Places on a surface say nothing about light beside it, few of them little: there it does not change.
    float unknown = kRidge * (sum + moments[1][1] + moments[2][2] + moments[3][3]);
    for (int axis = 1; axis < 4; ++axis)
        moments[axis][axis] += unknown;
    // The fit at away = 0: only the first of its terms.
    vec4 first = inverse(moments)[0];
    oRadiosity = vec4(max(lights * first, 0.0), 1.0);
}
