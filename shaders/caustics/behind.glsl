// caustics/behind.glsl: which of the two receivers behind each other light has come to.
//
// The number of the way of light that passed behind the first one is greater by kBehind.
const float kBehind = 65536.0;
int layerOf(float way) { return way < kBehind ? 0 : 1; }
float wayOf(float way) { return way < kBehind ? way : way - kBehind; } // whichever of them it came to
