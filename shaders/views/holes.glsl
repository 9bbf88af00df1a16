// views/holes.glsl: where the alpha of a mesh's colour lets light and sight pass.
//
// in    uColor, vCoordinate  views/texture_at.glsl
#include "views/texture_at.glsl"
uniform sampler2D uColor;
in vec4 vCoordinate;

// Two rounds of multiplication, whose factors are from a search for those that mix best (Wellons 2018).
uint mixed(uint bits) {
    bits = (bits ^ (bits >> 16u)) * 0x7feb352du;
    bits = (bits ^ (bits >> 15u)) * 0x846ca68bu;
    return bits ^ (bits >> 16u);
}

// Without factors below 11, so that multiples of so few thresholds visit all of them; neighbours differ modulo 8, the
// thresholds of a shadow, and modulo 5, those of a pixel by default.
const int kStrides[8] = int[8](1, 13, 11, 17, 31, 19, 23, 29);

// Even in [0,1) over pixels, layers and thresholds. Layers behind each other must know nothing of each other, while
// samples of a pixel, which meet neighbouring triangles, must not differ. A layer is one side of an object within a 32nd
// of an octave of depth; what is nearer together than that counts as one. Layers go through the thresholds in orders of
// their own (a lattice): else the same ones would let light pass through both.
float chanceOf(ivec2 pixel, int object, float depth) {
    int layer = 2 * int(floor(32.0 * log2(max(depth, 1e-6)))) + int(gl_FrontFacing);
    float chance = float(mixed(uint(pixel.x) + mixed(uint(pixel.y) + mixed(uint(layer) + mixed(uint(object))))) >> 8u);
    return fract(chance / 16777216.0 + float(kStrides[(layer + 3 * object) & 7]) * mesh.threshold);
}

// Share of the light that stops here: all or none of what is not blended.
float opacityHere() {
    float alpha = textureAt(uColor, vCoordinate, mesh.wraps.x).a;
    return mesh.cutoff < 0.0 ? -mesh.cutoff * alpha : float(alpha >= mesh.cutoff);
}

// Of what is blended each view shows the share of its pixels that alpha says (stochastic transparency: Enderton,
// Sintorn, Shirley, Luebke 2010), so that nothing need be sorted and whatever meets it counts it rightly in the mean.
// Views of the same pixel differ by the threshold, evenly.
//
// @param depth  [m]  along the view's forward
bool isHole(float depth) {
    return opacityHere() <= chanceOf(ivec2(gl_FragCoord.xy), mesh.object, depth);
}
