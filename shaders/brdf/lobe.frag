// brdf/lobe.frag: what one glossy surface mirrors of what is around: the environment, and objects before it.
//
// in    uSurface      the visible points (views/surface_pixel.glsl)
//       uEnvironment  USE_SKY: views/environment.glsl
//       USE_AROUND    views/surroundings.glsl
//       TEXTURED      brdf/textured.glsl
// out   oColor        [W/(m² sr)], linear Rec. 709; a: 1
// model the mean, over directions as GGX facets of about the lobe's spread send them, of what lies there times the BRDF
//       over the directions' density
#pragma variants - USE_SKY
#pragma variants - USE_AROUND
#pragma variants - TEXTURED
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "lib/ggx.glsl"
#include "lib/surface_frame.glsl"
#include "views/surface_pixel.glsl"
#include "views/surroundings_block.glsl"
#include "brdf/models.glsl"
#ifdef USE_SKY
#include "views/environment.glsl"
#endif
layout(std140) uniform LobeBlock {
    View view;
    Around around;
    mat4 mapFromWorld;
    vec4 diffuse; // Reflector's
    vec4 specular;
    vec4 lobe;    // its alpha, exponent, asPrinted, model
    vec2 turn;    // of the directions, so that samples of a pixel take others
    float alpha;  // of the facets
    float intensity; // of the environment
    int directions;
    int object;
    int isTextured;
    int cube;     // of the object; -1: none
} lobe;
layout(location = 0) out vec4 oColor;
#ifdef TEXTURED
#include "brdf/textured.glsl"
#endif
float alpha; // of the pixel's facets

vec4 environmentAt(vec3 direction) {
#ifdef USE_SKY
    return vec4(lobe.intensity * mapRadiance(mat3(lobe.mapFromWorld) * direction), 1.0);
#else
    return vec4(0.0);
#endif
}

#ifdef USE_AROUND
#define AROUND lobe.around
// A direction stands for a part of the lobe: looks need be no finer than a quarter of its width.
#define TEXELS_A_LOOK max(lobe.around.texelsALook, 0.25 * alpha * sizeOfFace())
#include "views/surroundings.glsl"
#endif

vec3 lightAlong(vec3 place, vec3 direction) {
#ifdef USE_AROUND
    float way;
    if (lobe.cube >= 0) return lightAround(lobe.cube, lobe.view.eye.xyz + place, direction, way).rgb;
#endif
    return environmentAt(direction).rgb;
}

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != lobe.object) discard;
    vec3 place = placeFrom(lobe.view, gl_FragCoord.xy, pixel.z), normal = fromOctahedral(pixel.g);
    vec3 toEye = -eyeRay(lobe.view, gl_FragCoord.xy);
    float metallic = lobe.lobe.y;
    vec3 diffuse = lobe.diffuse.rgb;
    alpha = lobe.alpha;
#ifdef TEXTURED
    if (lobe.isTextured != 0 && takeTextures(normal, diffuse, alpha, metallic)) {
        if (alpha > kMostNarrow) discard;
        alpha = max(alpha, kLeastFacets);
    }
#endif
    // Smooth surfaces mirror one direction: facets that hardly differ.
    Reflector reflector =
        Reflector(vec4(diffuse, 1.0), lobe.specular, alpha, metallic, lobe.lobe.z, int(lobe.lobe.w));
    mat3 worldFromSurface = surfaceFrame(normal);
    vec3 eye = toEye * worldFromSurface;
    eye = normalize(vec3(eye.xy, max(eye.z, 1e-4)));
    oColor = vec4(0.0, 0.0, 0.0, 1.0);
    for (int i = 0; i < lobe.directions; ++i) {
        vec2 u = fract(latticePoint(i, lobe.directions) + lobe.turn);
        vec3 toLight = reflect(-eye, seenFacet(eye, alpha, u));
        if (toLight.z <= 0.0) continue;
        Angles angles = anglesOf(vec3(0.0, 0.0, 1.0), toLight, eye);
        float density = seenDensity(angles.middle, angles.aside, eye.z, alpha);
        vec3 share = mirroredShare(reflector, angles) / max(density, 1e-30);
        oColor.rgb += share * lightAlong(place, worldFromSurface * toLight);
    }
    oColor.rgb /= float(lobe.directions);
}
