// brdf/light.frag: light that some of the light samples bring to what each pixel shows of matt surfaces, added to what
// earlier samples brought.
//
// in    uSurface    the visible points (views/surface_pixel.glsl)
//       uSum        light summed so far; not looked at in the first slice
//       uOcclusion  USE_OCCLUSION: light/occlusion.glsl
//       uFlux       USE_FLUX: [W/m²] irradiance that caustics add
// out   oSum.rgb    [W/(m² sr)], linear Rec. 709; SHOW_IRRADIANCE: [W/m²], whatever the colour; a: 1
// model base + diffuse E / pi (Lambert), on the side that is seen
#pragma variants - USE_OCCLUSION
#pragma variants - USE_FLUX
#pragma variants - SHOW_IRRADIANCE
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "light/sample.glsl"
#include "light/occlusion.glsl"
const int kMostMatter = 256; // objects of a draw

struct Matter {
    vec4 base;
    vec4 diffuse; // a: 0 for what is not shaded here
};
layout(std140) uniform MattBlock {
    View view;
    Matter matter[kMostMatter];
    int first;      // object of the scene that matter[0] is of
    int firstLight;
    int endLight;
    int columns;    // of light/occlusion.glsl
} matt;
uniform sampler2D uSum;
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
layout(location = 0) out vec4 oSum;

void main() {
    SurfacePixel pixel = readSurface();
    int number = pixel.object - matt.first;
    if (pixel.face != kMeshFace || number < 0 || number >= 256) discard;
    Matter matter = matt.matter[number];
    if (matter.diffuse.a == 0.0) discard;
    vec3 place = matt.view.eye.xyz + placeFrom(matt.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
#ifdef SHOW_IRRADIANCE
    vec3 base = vec3(0.0), factor = vec3(1.0);
#else
    vec3 base = matter.base.rgb, factor = matter.diffuse.rgb / 3.14159265;
#endif
    // Light by light, so that slices of any length give the same to the last bit.
    oSum = vec4(matt.firstLight == 0 ? base : texelFetch(uSum, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
#ifdef USE_FLUX
    oSum.rgb += factor * texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
    for (int i = matt.firstLight; i < matt.endLight; ++i) {
        LightSample light = lightSampleAt(i, place);
        float cosine = cosineOf(dot(normal, light.toLight), light.extent);
        if (cosine <= 0.0) continue;
        float seen = visibilityOf(i - matt.firstLight, ivec2(matt.view.size), matt.columns);
        oSum.rgb += seen * cosine * factor * light.irradiance;
    }
}
