// brdf/shade.frag: what opaque surfaces and mirrors that are no height fields send to the eye.
//
// in    uIrradiance   USE_LAMPS: brdf/irradiance.frag
//       uFlux         USE_FLUX: [W/m²] irradiance that caustics add
//       uEnvironment  USE_SKY: see views/environment.glsl
// out   oColor.rgb    linear Rec. 709, or with SHOW_IRRADIANCE the irradiance, of mirrors 0; a: 1
// model matt: base + diffuse * E / pi; mirrors: reflectance times the environment in the mirrored direction
// not   in a mirror: objects. The environment's light on matt surfaces passes everything
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "views/surface_pixel.glsl"
struct Matter {
    vec4 base; // a: 1 for mirrors
    vec4 tint; // diffuse, or reflectance; a: 0 for what is not shaded here
};
layout(std140) uniform ShadeBlock {
    View view;
    mat4 mapFromWorld;
    vec4 sky[9]; // irradiance by 1, y, z, x, xy, yz, 3z²-1, xz, x²-y² of the normal
    Matter matter[256];
    int first;       // object of the scene that matter[0] is of
    float intensity; // of the environment
    int padding0, padding1;
} shade;
#ifdef USE_LAMPS
uniform sampler2D uIrradiance;
#endif
#ifdef USE_FLUX
uniform sampler2D uFlux;
#endif
#ifdef USE_SKY
#include "views/environment.glsl"
#endif
layout(location = 0) out vec4 oColor;

vec3 skyLight(vec3 n) {
    return shade.sky[0].rgb + n.y * shade.sky[1].rgb + n.z * shade.sky[2].rgb + n.x * shade.sky[3].rgb +
           n.x * n.y * shade.sky[4].rgb + n.y * n.z * shade.sky[5].rgb + (3.0 * n.z * n.z - 1.0) * shade.sky[6].rgb +
           n.x * n.z * shade.sky[7].rgb + (n.x * n.x - n.y * n.y) * shade.sky[8].rgb;
}

vec3 irradianceOn(vec3 normal) {
    vec3 sum = vec3(0.0);
#ifdef USE_LAMPS
    sum += texelFetch(uIrradiance, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_FLUX
    sum += texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
#endif
#ifdef USE_SKY
    sum += max(skyLight(normal), 0.0); // no light is negative; the series may be
#endif
    return sum;
}

vec3 mirrored(vec3 normal) {
#ifdef USE_SKY
    vec3 direction = reflect(eyeRay(shade.view, gl_FragCoord.xy), normal);
    return shade.intensity * mapRadiance(mat3(shade.mapFromWorld) * direction);
#else
    return vec3(0.0);
#endif
}

void main() {
    SurfacePixel pixel = readSurface();
    int place = pixel.object - shade.first;
    if (pixel.face != kMeshFace || place < 0 || place >= 256) discard;
    Matter matter = shade.matter[place];
    if (matter.tint.a == 0.0) discard;
    vec3 normal = fromOctahedral(pixel.g);
    bool isMirror = matter.base.a > 0.5;
#ifdef SHOW_IRRADIANCE
    oColor = vec4(isMirror ? vec3(0.0) : irradianceOn(normal), 1.0);
#else
    const float kPi = 3.14159265;
    oColor = vec4(isMirror ? matter.tint.rgb * mirrored(normal)
                           : matter.base.rgb + matter.tint.rgb * irradianceOn(normal) / kPi,
                  1.0);
#endif
}
