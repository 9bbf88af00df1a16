// caustics/beam.vert: the triangles of the grid, carried to the receivers.
//
// in    gl_VertexID  three a triangle; AS_POINTS: one
//       uFlux [W]    caustics/photon.frag
//       uBeams       caustics/beams.frag
// out   vFlux flat   [light.unit] of a texel; AS_POINTS: of the whole point
#include "caustics/deposit_block.glsl"
#include "caustics/grid.glsl"
uniform sampler2D uFlux;
uniform sampler2D uBeams;
flat out vec3 vFlux;

void main() {
#ifdef AS_POINTS
    int number = gl_VertexID;
    gl_PointSize = 1.0;
#else
    int number = gl_VertexID / 3;
#endif
    int columns = light.grid.x - 1;
    ivec2 square = ivec2((number >> 1) % columns, (number >> 1) / columns);
    int triangle = number & 1;
    vFlux = vec3(0.0);
    gl_Position = kAway;
    vec4 both = texelFetch(uBeams, square, 0);
    vec2 spread = triangle == 0 ? both.xy : both.zw;
#ifdef AS_POINTS
    if (spread.y == 0.0) return;
#else
    if (spread.x == 0.0 || spread.y == 1.0) return;
#endif
    vec3 sum = vec3(0.0);
    vec3 flux = vec3(0.0);
    bool before = true; // the face's eye; a triangle that reaches behind it is wider than the face
    for (int corner = 0; corner < 3; ++corner) {
        ivec2 ray = cornerOf(square, triangle, corner);
        vec3 landing = texelFetch(uLanding, ray, 0).xyz;
        sum += landing / 3.0;
        before = before && (light.faces[light.face].eye.w < 0.5 || onMap(light.face, landing).z > 0.0);
        flux += texelFetch(uFlux, ray, 0).rgb / 6.0; // six triangles lie around a ray
    }
#ifdef AS_POINTS
    if (faceOf(sum) != light.face) return;
    vFlux = spread.y * flux / light.unit;
    gl_Position = clipFromTexel(onMap(light.face, sum).xy);
#else
    vec3 place = texelFetch(uLanding, cornerOf(square, triangle, gl_VertexID % 3), 0).xyz;
    if (!before) return;
    vFlux = (1.0 - spread.y) * flux / (light.unit * spread.x);
    gl_Position = clipFromMap(onMap(light.face, place).xy);
#endif
}
