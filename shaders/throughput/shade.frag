// throughput/shade.frag: what the surface of one baked object sends to the eye.
//
// in    uSurface  views/surface_pixel.glsl
//       uSeen     [W/m²] throughput/seen.frag
// out   oColor.rgb linear Rec. 709, or with SHOW_RADIOSITY the radiosity; a: 1
// model B F_t(cos) / (pi mean), with the mean F_t over the directions in which B leaves: what B counts leaves
#pragma variants - SHOW_RADIOSITY
#include "views/view.glsl"
layout(std140) uniform ThroughputShadeBlock {
    View view;
    float ior;
    float mean; // F_t
    int object;
} shade;
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "views/surface_pixel.glsl"
uniform sampler2D uSeen;
layout(location = 0) out vec4 oColor;

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != shade.object) discard;
    vec3 radiosity = texelFetch(uSeen, ivec2(gl_FragCoord.xy), 0).rgb;
#ifdef SHOW_RADIOSITY
    oColor = vec4(radiosity, 1.0);
#else
    const float kPi = 3.14159265;
    float cosine = max(dot(fromOctahedral(pixel.g), -eyeRay(shade.view, gl_FragCoord.xy)), 0.0);
    oColor = vec4(radiosity * (1.0 - fresnelReflectance(cosine, 1.0 / shade.ior)) / (kPi * shade.mean), 1.0);
#endif
}
