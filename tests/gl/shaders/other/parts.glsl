const int kParts = 3;

struct Part {
    vec3 place;
    float size;
    vec2 corner;
};
