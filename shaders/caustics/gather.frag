// caustics/gather.frag: irradiance by the rays that hit what the pixels around show (image-space gathering, Wyman and
// Davis 2006).
//
// in    uFlux [light.unit]  caustics/line.frag
//       uBefore             USE_BEFORE: the sum so far
// out   oSum.rgb [W/m²]
// model Gaussian of 7 x 7 pixels, of those that show the same surface; their flux over the area that they show
#pragma variants - USE_BEFORE
#include "views/view.glsl"
layout(std140) uniform GatherBlock {
    View view; // of the camera
    float unit; // [W] that the picture of lines counts as 1
} light;
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uFlux;
#ifdef USE_BEFORE
uniform sampler2D uBefore;
#endif
layout(location = 0) out vec4 oSum;

const int kReach = 3;          // pixels
const float kDeviation = 1.5;  // pixels: two of them reach as far as the window
const float kSame = 2.0;       // pixels from the tangent plane of what is the same surface; chosen by eye

void main() {
#ifdef USE_BEFORE
    oSum = texelFetch(uBefore, ivec2(gl_FragCoord.xy), 0);
#else
    oSum = vec4(0.0);
#endif
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace) return;
    View view = light.view;
    bool perspective = view.eye.w > 0.5;
    vec3 normal = fromOctahedral(pixel.g);
    vec3 place = placeFrom(view, gl_FragCoord.xy, pixel.z);
    float width = length(view.right.xyz) * (perspective ? pixel.z : 1.0);
    vec3 flux = vec3(0.0);
    float area = 0.0;
    for (int y = -kReach; y <= kReach; ++y)
        for (int x = -kReach; x <= kReach; ++x) {
            ivec2 at = ivec2(gl_FragCoord.xy) + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(vec2(at), view.size))) continue;
            vec4 texel = texelFetch(uSurface, at, 0);
            if ((int(floor(texel.w)) & 7) != kMeshFace) continue;
            vec3 other = placeFrom(view, vec2(at) + 0.5, texel.z);
            vec3 otherNormal = fromOctahedral(texel.xy);
            if (abs(dot(other - place, normal)) > kSame * width) continue;
            vec3 ray = eyeRay(view, vec2(at) + 0.5);
            float facing = abs(dot(ray, otherNormal));
            if (facing == 0.0) continue;
            float weight = exp(-0.5 * float(x * x + y * y) / (kDeviation * kDeviation));
            float shown = length(view.right.xyz) * length(view.up.xyz) * (perspective ? texel.z * texel.z : 1.0) *
                          dot(ray, view.forward.xyz) / facing;
            flux += weight * texelFetch(uFlux, at, 0).rgb;
            area += weight * shown;
        }
    if (area > 0.0) oSum.rgb += flux / area * light.unit;
}
