// brdf/table.glsl: a measured BRDF, 1/sr, between the texels of its table (scene/ReflectanceTable.h says how it lies).
//
// in    uTable  its texels
// Directions are unit, z is the normal, both above the surface.
uniform sampler2D uTable;

const int kMerl = 0, kProjected = 1, kEqualArea = 2;
const float kTablePi = 3.14159265;

// Texels that hold something, weighted; a: sum of the weights.
vec4 merlTexel(ivec3 at, float weight) {
    int index = at.z + 180 * (at.y + 90 * at.x);
    vec3 value = texelFetch(uTable, ivec2(index % 1800, index / 1800), 0).rgb;
    return min(value.r, min(value.g, value.b)) < 0.0 ? vec4(0.0) : weight * vec4(value, 1.0);
}

vec3 merlAt(vec3 toLight, vec3 toEye) {
    vec3 halfway = normalize(toLight + toEye);
    // light around the halfway direction, which is turned to the normal
    float aside = length(halfway.xy);
    vec2 along = aside > 0.0 ? halfway.xy / aside : vec2(1.0, 0.0);
    vec3 flat_ = vec3(dot(toLight.xy, along), along.x * toLight.y - along.y * toLight.x, toLight.z);
    vec3 apart = vec3(halfway.z * flat_.x - aside * flat_.z, flat_.y, aside * flat_.x + halfway.z * flat_.z);
    float around = atan(apart.y, apart.x);
    if (around < 0.0) around += kTablePi;
    vec3 at = vec3(90.0 * sqrt(atan(aside, halfway.z) / (0.5 * kTablePi)),
                   90.0 * atan(length(apart.xy), apart.z) / (0.5 * kTablePi), 180.0 * around / kTablePi) - 0.5;
    ivec3 base = ivec3(floor(at));
    vec3 f = at - vec3(base);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 8; ++i) {
        ivec3 step_ = ivec3(i & 1, (i >> 1) & 1, i >> 2);
        ivec3 texel = base + step_;
        vec3 share = mix(1.0 - f, f, vec3(step_));
        texel.xy = clamp(texel.xy, ivec2(0), ivec2(89));
        texel.z = (texel.z + 180) % 180;
        sum += merlTexel(texel, share.x * share.y * share.z + 1e-8);
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
}

// Shirley and Chiu's square of the equal-area disc.
vec2 evenSquare(vec3 direction) {
    float aside = length(direction.xy);
    float r = sqrt(max(1.0 - direction.z, 0.0));
    if (aside == 0.0) return vec2(0.5);
    vec2 p = direction.xy * (r / aside);
    float angle = atan(p.y, p.x);
    if (angle < -0.25 * kTablePi) angle += 2.0 * kTablePi;
    float quarter = floor(angle / (0.5 * kTablePi) + 0.5);
    float along = 4.0 / kTablePi * (angle - quarter * 0.5 * kTablePi) * r;
    vec2 q = quarter < 0.5 ? vec2(r, along) : quarter < 1.5 ? vec2(-along, r) : quarter < 2.5 ? vec2(-r, -along)
                                                                                             : vec2(along, -r);
    return 0.5 + 0.5 * q;
}

vec2 tableSquare(vec3 direction, int form) {
    return form == kProjected ? 0.5 + 0.5 * direction.xy : evenSquare(direction);
}

// Between four blocks, and in each between four texels.
vec3 blocksAt(vec3 toLight, vec3 toEye, int form, int blocks) {
    int texels = textureSize(uTable, 0).x / blocks;
    vec2 block = tableSquare(toLight, form) * float(blocks) - 0.5;
    vec2 texel = tableSquare(toEye, form) * float(texels) - 0.5;
    vec2 fb = fract(block), ft = fract(texel);
    ivec2 b = ivec2(floor(block)), t = ivec2(floor(texel));
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 16; ++i) {
        ivec2 sb = ivec2(i & 1, (i >> 1) & 1), st = ivec2((i >> 2) & 1, i >> 3);
        vec2 wb = mix(1.0 - fb, fb, vec2(sb)), wt = mix(1.0 - ft, ft, vec2(st));
        ivec2 at = clamp(b + sb, ivec2(0), ivec2(blocks - 1)) * texels + clamp(t + st, ivec2(0), ivec2(texels - 1));
        sum += wb.x * wb.y * wt.x * wt.y * texelFetch(uTable, at, 0).rgb;
    }
    return sum;
}

vec3 tableAt(vec3 toLight, vec3 toEye, int form, int blocks) {
    if (toLight.z <= 0.0 || toEye.z <= 0.0) return vec3(0.0);
    return form == kMerl ? merlAt(toLight, toEye) : blocksAt(toLight, toEye, form, blocks);
}
