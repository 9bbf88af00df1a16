// views/prism.glsl: the space above one triangle of a displaced surface, a prism whose sides follow the normals of its
// corners.
//
// A place in it has weights w of corners 1 and 2 and a height z [m]: p0 + w.x (p1 - p0) + w.y (p2 - p0) + z d, with d
// mixed by the same weights of the corners' directions.
uniform sampler2D uPrisms; // 8 texels a triangle: 3 places with u, 3 directions with v, walls with 3 vertices

struct Prism {
    vec3 middle; // object space; places below are measured from it
    vec3 place[3];
    vec3 direction[3]; // unit
    vec2 coordinate[3]; // tiles of the map
    int walls; // bit i: no neighbour beside the edge from corner i on
};

const float kRoom = 2e-4; // of an edge: neighbours overlap so much, so that no ray slips through between them

vec4 prismTexel(int number, int part) {
    int perRow = textureSize(uPrisms, 0).x / 8;
    return texelFetch(uPrisms, ivec2(8 * (number % perRow) + part, number / perRow), 0);
}

Prism prismOf(int number) {
    Prism prism;
    for (int i = 0; i < 3; ++i) {
        vec4 place = prismTexel(number, i), direction = prismTexel(number, 3 + i);
        prism.place[i] = place.xyz;
        prism.direction[i] = direction.xyz;
        prism.coordinate[i] = vec2(place.w, direction.w);
    }
    prism.middle = (prism.place[0] + prism.place[1] + prism.place[2]) / 3.0;
    for (int i = 0; i < 3; ++i) prism.place[i] -= prism.middle;
    prism.walls = int(prismTexel(number, 6).x);
    return prism;
}

// Of the mesh below the corner.
int vertexOf(int number, int corner) { return int(prismTexel(number, 6)[1 + corner]); }

vec3 directionAt(Prism prism, vec2 w) {
    return prism.direction[0] + w.x * (prism.direction[1] - prism.direction[0]) +
           w.y * (prism.direction[2] - prism.direction[0]);
}

vec2 coordinateAt(Prism prism, vec2 w) {
    return prism.coordinate[0] + w.x * (prism.coordinate[1] - prism.coordinate[0]) +
           w.y * (prism.coordinate[2] - prism.coordinate[0]);
}

// (w, z) of a place near the prism, by Newton's steps from a start.
vec3 inPrism(Prism prism, vec3 place, vec3 start) {
    vec3 q = start;
    vec3 edge1 = prism.place[1] - prism.place[0], edge2 = prism.place[2] - prism.place[0];
    vec3 turn1 = prism.direction[1] - prism.direction[0], turn2 = prism.direction[2] - prism.direction[0];
    for (int i = 0; i < 4; ++i) {
        vec3 up = directionAt(prism, q.xy), along1 = edge1 + q.z * turn1, along2 = edge2 + q.z * turn2;
        vec3 off = prism.place[0] + q.x * edge1 + q.y * edge2 + q.z * up - place;
        vec3 across = cross(along1, along2);
        float volume = dot(across, up);
        if (volume == 0.0) break;
        q -= vec3(dot(off, cross(along2, up)), dot(off, cross(up, along1)), dot(off, across)) / volume;
        if (dot(off, off) <= 1e-12 * dot(edge1, edge1)) break; // what is left is rounding
    }
    return q;
}

// Where a ray runs in a prism, and by which face it comes in: 0, 1, 2 the sides from those corners on, 3 the floor, 4
// the ceiling. Empty where x >= y.
struct Stretch {
    float from, to;
    int face;
};

void meet(inout Stretch stretch, float at, int face) {
    if (at < stretch.from) {
        stretch.from = at;
        stretch.face = face;
    }
    stretch.to = max(stretch.to, at);
}

// span: lowest and highest z
Stretch stretchIn(Prism prism, vec3 origin, vec3 direction, vec2 span) {
    Stretch stretch = Stretch(1e30, -1e30, 4);
    for (int cap = 0; cap < 2; ++cap) {
        float z = cap == 0 ? span.x : span.y;
        vec3 a = prism.place[0] + z * prism.direction[0] - origin;
        vec3 b = prism.place[1] + z * prism.direction[1] - origin - a;
        vec3 c = prism.place[2] + z * prism.direction[2] - origin - a;
        vec3 normal = cross(b, c);
        float slope = dot(direction, normal);
        if (slope == 0.0) continue;
        float at = dot(a, normal) / slope;
        vec3 place = at * direction - a;
        float area = dot(normal, normal);
        float w1 = dot(cross(place, c), normal) / area, w2 = dot(cross(b, place), normal) / area;
        if (min(min(w1, w2), 1.0 - w1 - w2) >= -kRoom) meet(stretch, at, 3 + cap);
    }
    // A side is ruled: at each height a straight edge. Seen along the ray the edge that goes through it is the one
    // whose ends lie on a line with it, a quadratic in the height.
    vec3 aside = abs(direction.x) < 0.6 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 right = normalize(cross(direction, aside)), up = cross(direction, right);
    float room = kRoom * (span.y - span.x);
    for (int i = 0; i < 3; ++i) {
        int next = (i + 1) % 3;
        vec3 a = prism.place[i] - origin, edge = prism.place[next] - prism.place[i];
        vec3 rise = prism.direction[i], turn = prism.direction[next] - prism.direction[i];
        vec2 a2 = vec2(dot(a, right), dot(a, up)), edge2 = vec2(dot(edge, right), dot(edge, up));
        vec2 rise2 = vec2(dot(rise, right), dot(rise, up)), turn2 = vec2(dot(turn, right), dot(turn, up));
        vec2 heights = quadraticRoots(rise2.x * turn2.y - rise2.y * turn2.x,
                                      a2.x * turn2.y - a2.y * turn2.x + rise2.x * edge2.y - rise2.y * edge2.x,
                                      a2.x * edge2.y - a2.y * edge2.x);
        for (int k = 0; k < 2; ++k) {
            float z = k == 0 ? heights.x : heights.y;
            if (z < span.x - room || z > span.y + room) continue;
            vec2 from = a2 + z * rise2, along = edge2 + z * turn2;
            float length2 = dot(along, along);
            vec3 along3 = edge + z * turn;
            if (length2 <= 1e-10 * dot(along3, along3)) continue; // the ray runs along it
            float w = -dot(from, along) / length2;
            if (w < -kRoom || w > 1.0 + kRoom) continue;
            meet(stretch, dot(a + z * rise + w * along3, direction), i);
        }
    }
    return stretch;
}
