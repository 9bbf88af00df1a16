// lib/depth_normal.glsl: normals from the depths of neighbouring pixels (multiple-refractions thesis 2008, 3.5).
// Compiles as GLSL and, with GLM, as C++ (hence the f of the constants).
//
// Places are in metres along the view's right, up and forward; a neighbour that is not there is given as the middle.
// Normals are unit and face the eye: their z is below 0.

float gradient(float rise, float run) { return run == 0.0f ? 0.0f : rise / run; }

// Central differences scaled by the way between the places (eq. 3.2). It leaves out that in a perspective view two
// places of one row differ in height when they differ in depth.
vec3 normalFromDifferences(vec3 left, vec3 right, vec3 low, vec3 high) {
    return normalize(vec3(gradient(right.z - left.z, right.x - left.x), gradient(high.z - low.z, high.y - low.y), -1.0f));
}

// Of the eight triangles between a place and the places around it, counter-clockwise, weighted by their areas.
vec3 normalFromFan(vec3 middle, vec3 ring[8]) {
    vec3 sum = vec3(0.0f);
    for (int i = 0; i < 8; ++i) sum += cross(ring[i] - middle, ring[(i + 1) & 7] - middle);
    return sum.z == 0.0f ? vec3(0.0f, 0.0f, -1.0f) : normalize(-sum);
}
