// views/prism_ray.glsl: the eye ray of a pixel in the prism above one triangle of a displaced surface. Needs
// views/displaced_block.glsl and views/prism.glsl.

// Measured from the triangle's middle, and begun where the ray is nearest to it: there floats are dense.
struct PrismRay {
    vec3 origin;
    vec3 direction;
};

PrismRay eyeRayIn(Prism prism) {
    vec4 onFarPlane =
        displaced.objectFromPixel * vec4(gl_FragCoord.xy - displaced.corner - 0.5 * displaced.size, 1.0, 1.0);
    vec3 far = onFarPlane.xyz / onFarPlane.w;
    vec3 direction = displaced.eye.w == 0.0 ? displaced.eye.xyz : normalize(far - displaced.eye.xyz);
    vec3 aside = far - prism.middle;
    return PrismRay(aside - dot(aside, direction) * direction, direction);
}
