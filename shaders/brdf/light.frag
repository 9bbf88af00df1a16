// brdf/light.frag: light that some of the light samples bring to what each pixel shows of matt and glossy surfaces, added
// to what earlier samples brought.
//
// in    uSurface    the visible points (views/surface_pixel.glsl)
//       uSum        light summed so far; not looked at in the first slice
//       uOcclusion  USE_OCCLUSION: light/occlusion.glsl
//       uFlux       USE_FLUX: [W/m²] irradiance that caustics add
//       uMirrored   USE_MIRRORED: brdf/lobe.frag
//       uTable      MEASURED: brdf/table.glsl
//       TEXTURED    brdf/textured.glsl
// out   oSum.rgb    [W/(m² sr)], linear Rec. 709; SHOW_IRRADIANCE: [W/m²], whatever the colour; a: 1
// model base + diffuse E / pi (Lambert), GLOSSY: or brdf/models.glsl, MEASURED: a table, on the side that is seen. Of
//       caustics, whose directions are not known, the matt share of light from straight above. A sample of a lamp that has
//       a size is seen as large as its part of the lamp, so that highlights have less grain
#pragma variants - USE_OCCLUSION
#pragma variants - USE_WATER
#pragma variants - USE_FLUX
#pragma variants - SHOW_IRRADIANCE GLOSSY MEASURED
#pragma variants - USE_MIRRORED if GLOSSY
#pragma variants - TEXTURED unless MEASURED
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
#include "light/sample.glsl"
#include "light/occlusion.glsl"
const int kMostMatter = 128; // objects of a draw

struct Matter {
    vec4 base;     // a: 1 where brdf/lobe.frag shows what narrow lobes mirror of the environment
    vec4 diffuse;  // a: 0 for what is not shaded here, 2 for what has textures
    vec4 specular; // Reflector's; this and the rest of glossy surfaces
    vec4 lobe;     // its alpha, exponent, asPrinted, model
};
layout(std140) uniform MattBlock {
    View view;
    Matter matter[kMostMatter];
    int first;      // object of the scene that matter[0] is of
    int firstLight;
    int endLight;
    int placed;     // samples of lamps: those of the environment come after them
    int columns;    // of light/occlusion.glsl
    int form;       // of the table: this and the rest of measured surfaces
    int blocks;     // along its side
} matt;
uniform sampler2D uSum;
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
#ifdef USE_MIRRORED
uniform sampler2D uMirrored;
#endif
layout(location = 0) out vec4 oSum;

#ifdef TEXTURED
#include "brdf/textured.glsl"
#endif

#ifdef GLOSSY
#include "brdf/models.glsl"

Reflector reflectorOf(Matter m) {
    return Reflector(m.diffuse, m.specular, m.lobe.x, m.lobe.y, m.lobe.z, int(m.lobe.w));
}
#endif

#ifdef MEASURED
#include "lib/surface_frame.glsl"
#include "brdf/table.glsl"
#endif

void main() {
    SurfacePixel pixel = readSurface();
    int number = pixel.object - matt.first;
    if (pixel.face != kMeshFace || number < 0 || number >= kMostMatter) discard;
    Matter matter = matt.matter[number];
    if (matter.diffuse.a == 0.0) discard;
    vec3 place = matt.view.eye.xyz + placeFrom(matt.view, gl_FragCoord.xy, pixel.z);
    vec3 normal = fromOctahedral(pixel.g);
#ifdef TEXTURED
    if (matter.diffuse.a > 1.5 && takeTextures(normal, matter.diffuse.rgb, matter.lobe.x, matter.lobe.y)) {
        matter.base.rgb *= texelFetch(uEmission, ivec2(gl_FragCoord.xy), 0).rgb;
        if (matter.lobe.x > kMostNarrow) matter.base.a = 0.0;
    }
#endif
#ifdef SHOW_IRRADIANCE
    vec3 base = vec3(0.0), factor = vec3(1.0);
#else
    vec3 base = matter.base.rgb, factor = matter.diffuse.rgb / 3.14159265;
#endif
#ifdef GLOSSY
    Reflector reflector = reflectorOf(matter);
    vec3 toEye = -eyeRay(matt.view, gl_FragCoord.xy);
    bool isGlossy = reflector.model != kMatt;
    if (isGlossy) factor = mattShare(reflector, anglesOf(normal, normal, normal));
#endif
#ifdef MEASURED
    vec3 toEye = -eyeRay(matt.view, gl_FragCoord.xy);
    mat3 worldFromSurface = surfaceFrame(normal);
    vec3 eye = toEye * worldFromSurface;
    factor = tableAt(vec3(0.0, 0.0, 1.0), vec3(0.0, 0.0, 1.0), matt.form, matt.blocks);
#endif
    // Light by light, so that slices of any length give the same to the last bit.
    oSum = vec4(matt.firstLight == 0 ? base : texelFetch(uSum, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
#ifdef USE_FLUX
    oSum.rgb += factor * texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_MIRRORED
    if (isGlossy) oSum.rgb += texelFetch(uMirrored, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
    for (int i = matt.firstLight; i < matt.endLight; ++i) {
        LightSample light = lightSampleAt(i, place);
        float cosine = cosineOf(dot(normal, light.toLight), light.extent);
        if (cosine <= 0.0 || light.weight == 0.0) continue;
        float seen = visibilityOf(i - matt.firstLight, ivec2(matt.view.size), matt.columns);
#ifdef GLOSSY
        if (isGlossy) {
            Angles angles = anglesOf(normal, light.toLight, toEye);
            vec3 share = mattShare(reflector, angles) * (cosine / max(angles.light, 1e-4));
            // What narrow lobes show of the environment is brdf/lobe.frag's.
            if (i < matt.placed || matter.base.a == 0.0) {
                Reflector seenAs = reflector; // WebGL knows no ?: of structs
                if (light.part > 0.0) seenAs = widened(reflector, 0.35 * light.part);
                share += mirroredShare(seenAs, angles);
            }
            oSum.rgb += seen * share * light.irradiance;
            continue;
        }
#endif
#ifdef MEASURED
        factor = tableAt(light.toLight * worldFromSurface, eye, matt.form, matt.blocks);
#endif
        oSum.rgb += seen * cosine * factor * light.irradiance;
    }
}
