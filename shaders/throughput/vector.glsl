// throughput/vector.glsl: numbers by vertex, and longer lists, as images. Rows are powers of 2: dividing by what a
// compiler does not know took more than half of a product's time in software.
const int kVectorBits = 8, kListBits = 11;

ivec2 inVector(int i) { return ivec2(i & ((1 << kVectorBits) - 1), i >> kVectorBits); }
ivec2 inList(int i) { return ivec2(i & ((1 << kListBits) - 1), i >> kListBits); }
