// subsurface/lamp.glsl: light of one point of a lamp at a place.
//
// in    light  block with
//       vec4 place;  world: point, 1; or unit direction to the light, 0
//       vec4 color;  a: exponent of the cone
//       vec4 axis;   unit: along which it shines most; w: 1: it fades
//       vec2 cone;   scale and offset of the cosine to it

// The light's direction, and its irradiance on what faces it.
vec3 lightAt(vec3 place, out vec3 toLight) {
    toLight = light.place.xyz;
    if (light.place.w == 0.0) return light.color.rgb;
    vec3 way = light.place.xyz - place;
    float square = dot(way, way);
    if (square == 0.0) return vec3(0.0);
    toLight = way * inversesqrt(square);
    float cone = pow(clamp(light.cone.y - light.cone.x * dot(toLight, light.axis.xyz), 0.0, 1.0), light.color.a);
    return light.color.rgb * cone / (light.axis.w > 0.5 ? square : 1.0);
}
