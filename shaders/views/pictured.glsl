// views/pictured.glsl: the light of a place as a picture shows it, between its pixels.
//
// in    uShown  linear; a: 0 where nothing is drawn yet
//       uSolid  views/geometry.frag
// The file that includes this declares them, and has included views/view.glsl and lib/octahedral.glsl.

const float kAlike = 0.7; // cosine between normals of one surface; another that stands on it has less

// @param v       the place from the eye
// @param normal  of the surface there
// @param beside  what it is where the picture shows something else there
vec3 picturedAt(View view, vec3 v, vec3 normal, vec3 beside) {
    vec3 there = inView(view, v);
    vec2 at = pixelOf(view, there) - 0.5;
    if (there.z <= 0.0 || any(lessThan(at, vec2(-0.5))) || any(greaterThan(at, view.size - 0.5))) return beside;
    vec2 low = floor(at), f = at - low;
    float width = length(view.right.xyz) * (view.eye.w > 0.5 ? there.z : 1.0);
    vec3 radiance = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), pixel = clamp(ivec2(low) + corner, ivec2(0), ivec2(view.size) - 1);
        vec4 solid = texelFetch(uSolid, pixel, 0), light = texelFetch(uShown, pixel, 0);
        bool isShown = solid.a > 0.0 && light.a > 0.0 && dot(fromOctahedral(solid.yz), normal) > kAlike;
        if (!isShown || abs(dot(placeFrom(view, vec2(pixel) + 0.5, solid.x) - v, normal)) > width) continue;
        vec2 share = mix(1.0 - f, f, vec2(corner));
        float weight = share.x * share.y + 1e-6;
        radiance += weight * light.rgb;
        sum += weight;
    }
    return sum == 0.0 ? beside : radiance / sum;
}
