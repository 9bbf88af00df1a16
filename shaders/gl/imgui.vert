// gl/imgui.vert: Dear ImGui's triangles.
//
// in    aPosition  CSS pixels from the top left corner
//       aTexel     [0,1] place in the font atlas
//       aColor     encoded colour (sRGB), straight alpha
// out   vTexel, vColor  the same
uniform vec2 uSize; // of the canvas in CSS pixels
layout(location = 0) in vec2 aPosition;
layout(location = 1) in vec2 aTexel;
layout(location = 2) in vec4 aColor;
out vec2 vTexel;
out vec4 vColor;

void main() {
    vTexel = aTexel;
    vColor = aColor;
    vec2 place = aPosition / uSize * 2.0 - 1.0;
    gl_Position = vec4(place.x, -place.y, 0.0, 1.0);
}
