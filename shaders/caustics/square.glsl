// caustics/square.glsl: a square as two triangles.
//
// number  of a vertex, 0 to 5
// @return which corner it is, 0 or 1 along both sides
vec2 cornerOfSquare(int number) {
    return vec2(number == 1 || number == 3 || number == 4 ? 1.0 : 0.0, number == 2 || number == 3 || number == 5 ? 1.0 : 0.0);
}
