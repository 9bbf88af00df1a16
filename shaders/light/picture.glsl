// light/picture.glsl: the picture that a lamp projects, where a pass draws for one lamp alone; see light/sample.glsl.
//
// in    uPicture  factors of the lamp's colour; of a lamp without a picture any texture
uniform sampler2D uPicture;

struct PictureFrame {
    vec4 right; // scene::PictureFrame; w: 1 where the lamp has a picture
    vec4 up;
};

// What is projected in a direction; dark beside the picture.
vec3 projectedAt(PictureFrame frame, vec3 axis, vec3 direction) {
    if (frame.right.w == 0.0) return vec3(1.0);
    float along = dot(direction, axis);
    if (along <= 0.0) return vec3(0.0);
    vec2 at = 0.5 + 0.5 * vec2(dot(direction, frame.right.xyz), -dot(direction, frame.up.xyz)) / along;
    if (any(lessThan(at, vec2(0.0))) || any(greaterThan(at, vec2(1.0)))) return vec3(0.0);
    return texture(uPicture, at).rgb;
}
