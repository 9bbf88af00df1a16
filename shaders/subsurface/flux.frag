// subsurface/flux.frag: light that enters an object through each pixel of a view.
//
// in    uSurface  the nearest surfaces that the light sees; OF_LAYER: one layer of the object along an axis, with
//                 outward normals
//       uEntered  OF_LAYER: what enters there [W/m²]
//       uWay      OF_LAYER, REFRACTED: the directions that it came from, summed
//       uPaint    PAINTED: what is painted on these pixels (views/paint.glsl, what enters)
// out   subsurface/points.glsl; REFRACTED: the way on which light goes on inside in place of the normal
// model F_t(cos) times the flux of the pixel: the cosine at which light arrives and the slope of the surface in the
//       pixel cancel. OF_LAYER: what enters times the area of the surface, shared out among the
//       views along three axes (subsurface/share.glsl)
#pragma variants - OF_LAYER
#pragma variants - PAINTED
#pragma variants - REFRACTED
#include "views/view.glsl"
#include "lib/octahedral.glsl"
#include "lib/fresnel.glsl"
#include "views/surface_pixel.glsl"
#include "light/picture.glsl"
layout(std140) uniform FluxBlock {
    View view;
    vec4 color; // irradiance that faces the light, or that at 1 m; a: exponent of the cone
    vec4 axis;  // unit: along which the light shines most; w: 1: it fades
    vec4 sharpness; // of painted objects. x: most that points tell apart; y: radius of half the profile's light [m]; z:
                    // that of its blur [m], 0: it has none; w: 1: as the paper has it
    PictureFrame picture;
    vec2 cone;
    int object;
    float ior;
} light;
#include "subsurface/points.glsl"

#ifdef OF_LAYER
uniform sampler2D uEntered;
#ifdef REFRACTED
uniform sampler2D uWay;
#endif

#include "subsurface/share.glsl"
#endif

#ifdef PAINTED
uniform sampler2D uPaint;

// M_d as the points can carry it. A profile that they had to blur is as wide as it and M_d make it together.
float sharpnessFrom(float painted) {
    float sharpness = min(painted, light.sharpness.x);
    if (light.sharpness.z > 0.0 && sharpness < 1.0)
        sharpness = length(light.sharpness.yz) / length(vec2(light.sharpness.y / sharpness, light.sharpness.z));
    return sharpness;
}
#endif

void main() {
    noPoint();
    SurfacePixel pixel = readSurface();
    if (pixel.face != kMeshFace || pixel.object != light.object) return;

    bool perspective = light.view.eye.w > 0.5;
    float depth = pixel.z;
    vec3 toPlace = placeFrom(light.view, gl_FragCoord.xy, depth);
    vec3 ray = eyeRay(light.view, gl_FragCoord.xy);
    vec3 normal = fromOctahedral(pixel.g);
    float cosine = -dot(normal, ray);
    float width = max(length(light.view.right.xyz), length(light.view.up.xyz)) * (perspective ? depth : 1.0);
    float area = length(light.view.right.xyz) * length(light.view.up.xyz);
    vec3 flux;
#ifdef OF_LAYER
    flux = shareOf(light.view, normal) * area / abs(cosine) * texelFetch(uEntered, ivec2(gl_FragCoord.xy), 0).rgb;
#else
    vec3 color = light.color.rgb;
    if (perspective) {
        float slant = dot(ray, light.view.forward.xyz);
        area *= slant * slant * slant; // a solid angle
        if (light.axis.w < 0.5) area *= dot(toPlace, toPlace);
        color *= pow(clamp(light.cone.y + light.cone.x * dot(ray, light.axis.xyz), 0.0, 1.0), light.color.a);
        color *= projectedAt(light.picture, light.axis.xyz, ray);
    }
    flux = area * color * (1.0 - fresnelReflectance(max(cosine, 0.0), 1.0 / light.ior));
#endif
    float slope = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1e-3);
    oPlace = vec4(light.view.eye.xyz + toPlace, depth - 0.5 * width * slope);
    oFlux = vec4(flux, depth + 0.5 * width * slope);
    oNormal = vec4(normal, length(vec2(width, width * slope)));
#ifdef REFRACTED
#ifdef OF_LAYER
    vec3 from = texelFetch(uWay, ivec2(gl_FragCoord.xy), 0).xyz;
    ray = dot(from, normal) > 0.0 ? -normalize(from) : -normal;
#endif
    oNormal.xyz = refract(ray, normal, 1.0 / light.ior);
    if (oNormal.xyz == vec3(0.0)) oNormal.xyz = -normal;
#endif
#ifdef PAINTED
    vec4 paint = texelFetch(uPaint, ivec2(gl_FragCoord.xy), 0);
    oFlux.rgb *= paint.rgb;
    if (light.sharpness.w > 0.5) oFlux.rgb /= paint.a * paint.a;
    oSharpness = sharpnessFrom(paint.a);
    oNormal.w *= oSharpness;
#endif
}
