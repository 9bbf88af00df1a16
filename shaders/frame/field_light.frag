// frame/field_light.frag: light of caustics on what each pixel shows of one height field; COPY: the result, back to where
// it came from.
//
// in    uShown       light on the height fields so far
//       uFlux        [W/m²] irradiance that caustics add
//       uDiffuseMap  USE_MAP: colours of the field
// out   oLight       linear Rec. 709; in the unit of relief/light.frag, in which a lamp of 1 W/m² sends the diffuse colour
//                    itself to the eye (no pi)
#include "views/surface_pixel.glsl"
uniform sampler2D uShown;
layout(location = 0) out vec4 oLight;
#ifdef COPY
void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object < 0 || pixel.face == kMeshFace) discard;
    oLight = texelFetch(uShown, ivec2(gl_FragCoord.xy), 0);
}
#else
layout(std140) uniform FieldLightBlock {
    vec4 diffuse;
    vec2 texels; // of the field
    int object;
    int padding;
} field;
uniform sampler2D uFlux;
#ifdef USE_MAP
uniform sampler2D uDiffuseMap;
#endif

void main() {
    SurfacePixel pixel = readSurface();
    if (pixel.object != field.object) discard;
    vec3 diffuse = field.diffuse.rgb;
#ifdef USE_MAP
    diffuse *= textureLod(uDiffuseMap, (pixel.g - 0.5) / field.texels, 0.0).rgb;
#endif
    oLight = texelFetch(uShown, ivec2(gl_FragCoord.xy), 0);
    oLight.rgb += diffuse * texelFetch(uFlux, ivec2(gl_FragCoord.xy), 0).rgb;
}
#endif
