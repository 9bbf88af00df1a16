// throughput/vector.glsl: numbers by vertex as an image.
const int kVectorWidth = 256; // texels a row
