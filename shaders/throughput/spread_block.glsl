layout(std140) uniform SpreadBlock {
    int radius; // texels
    float cut;  // [m]
    float local, global; // 1: are shown
} spread;
