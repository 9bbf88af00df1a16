// views/maxima.frag: the greatest red of each block of 16 x 16 pixels.
uniform sampler2D uValues;
layout(location = 0) out vec4 oMost;

void main() {
    ivec2 corner = 16 * ivec2(gl_FragCoord.xy), end = min(corner + 16, textureSize(uValues, 0));
    float most = 0.0;
    for (int y = corner.y; y < end.y; ++y)
        for (int x = corner.x; x < end.x; ++x) most = max(most, texelFetch(uValues, ivec2(x, y), 0).r);
    oMost = vec4(most);
}
