// caustics/tent.glsl: light of one ray on the four texels around a place, by how near their middles are, so that rays
// evenly spread over the map light it evenly.
//
// ON_ONE_TEXEL  all of it on the texel of the place: where sums are 16-bit floats each addition cuts something off
#ifdef ON_ONE_TEXEL
const float kTentSize = 1.0; // texels a side

vec2 tentMiddle(vec2 place) { return floor(place) + 0.5; }

float tentWeight(vec2 beside) { return 1.0; }
#else
const float kTentSize = 2.0;

// The place on the map around which the four lie.
vec2 tentMiddle(vec2 place) { return floor(place + 0.5); }

float tentWeight(vec2 beside) {
    vec2 weight = max(1.0 - abs(beside), 0.0);
    return weight.x * weight.y;
}
#endif
