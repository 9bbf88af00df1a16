// caustics/tent.glsl: light of one ray on the four texels around a place, by how near their middles are, so that rays
// evenly spread over the map light it evenly.
const float kTentSize = 2.0; // texels a side

// The place on the map around which the four lie.
vec2 tentMiddle(vec2 place) { return floor(place + 0.5); }

float tentWeight(vec2 beside) {
    vec2 weight = max(1.0 - abs(beside), 0.0);
    return weight.x * weight.y;
}
