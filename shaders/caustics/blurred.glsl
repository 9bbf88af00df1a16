// caustics/blurred.glsl: how far the light of a ray spreads because its light sample stands for many directions.
//
// model where a ray meets what bends light all of them meet it, and part by their angle from the middle of its way through
//       on: of a lens from its centre, off a mirror from where it is met
uniform sampler2D uPlace; // caustics/photon.frag: where the ray leaves what bends it

// Light, and how strongly it is spread on the map: times the standard deviation [texels].
vec4 blurred(vec3 flux, ivec2 ray, vec3 landing) {
    if (light.spread == 0.0) return vec4(flux, 0.0);
    View face = light.faces[drawnFace()];
    vec3 place = texelFetch(uPlace, ray, 0).xyz;
    float angle = light.spread / (face.eye.w > 0.5 ? max(distance(place, face.eye.xyz), 1e-6) : 1.0);
    float reach = distance(place, landing) + light.within;
    float texels = angle * reach / texelWidth(face, onMap(drawnFace(), landing).xy, landing - face.eye.xyz);
    return vec4(flux, texels * dot(abs(flux), vec3(1.0 / 3.0)));
}
