// caustics/mirrors.glsl: how many mirrors the light of a lamp may meet.
const int kMostMirrors = 32;
