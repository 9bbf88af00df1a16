// subsurface/share.glsl: surfaces shared out among views along three axes.

const int kOtherFace = 7;        // of views/surface_pixel.glsl: the other views show this place better
const float kLeastShare = 1e-3;

// Share of the view itself, by a high power of the cosines: each place counts once, and mostly where a view faces it.
//
// view    right and up are the other two axes
// normal  unit, world
float shareOf(View view, vec3 normal) {
    vec3 power = vec3(dot(normal, view.forward.xyz), dot(normal, normalize(view.right.xyz)),
                      dot(normal, normalize(view.up.xyz)));
    power *= power;
    power *= power;
    power *= power;
    return power.x / (power.x + power.y + power.z);
}
