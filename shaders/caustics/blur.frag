// caustics/blur.frag: the caustic map of a light sample that stands for many directions, spread along rows, then columns.
//
// in    uMap   light on each texel; a: caustics/blurred.glsl
// out   oFlux  the same
// model a tent whose standard deviation each texel's light brings along. Nothing leaves a face: what would, stays
layout(std140) uniform BlurBlock {
    ivec2 face;  // texels of the map
    ivec2 along; // (1, 0) or (0, 1)
} blur;
uniform sampler2D uMap;
layout(location = 0) out vec4 oFlux;

const int kFarthest = 32;             // texels
const float kHalfWidth = 2.449489743; // of a tent: standard deviations

// Share of a tent below a place.
float below(float at, float halfWidth) {
    float u = clamp(at / halfWidth, -1.0, 1.0);
    return 0.5 + u - 0.5 * u * abs(u);
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int here = blur.along.x == 1 ? texel.x : texel.y;
    int size = blur.along.x == 1 ? blur.face.x : blur.face.y;
    int first = here - here % size; // of the face
    int low = max(here - kFarthest, first);
    int high = min(here + kFarthest, first + size - 1);
    oFlux = vec4(0.0);
    for (int at = low; at <= high; ++at) {
        vec4 light = texelFetch(uMap, texel + (at - here) * blur.along, 0);
        float flux = dot(abs(light.rgb), vec3(1.0 / 3.0));
        float halfWidth = clamp(kHalfWidth * light.a / max(flux, 1e-20), 0.5, float(kFarthest));
        float beside = float(here - at);
        if (abs(beside) - 0.5 >= halfWidth || flux == 0.0) continue;
        float all = below(float(first + size - at) - 0.5, halfWidth) - below(float(first - at) - 0.5, halfWidth);
        oFlux += (below(beside + 0.5, halfWidth) - below(beside - 0.5, halfWidth)) / all * light;
    }
}
