// views/triangles.glsl: where a ray pierces a mesh, from a triangle nearby.
//
// Seen along the ray the mesh around is a flat map, and the ray a point on it. From triangle to triangle over the edge
// that parts it most from the point, it is found in about as many steps as triangles lie between. What leads to the
// first one may therefore be coarse: pixels smaller or larger than triangles, roundings of the rasteriser. What is
// met is the triangle itself.
#include "views/triangle_links.glsl"
uniform sampler2D uCorners;       // place in the world; w: packed normal of the triangle of that number
uniform sampler2D uCornerNormals; // world, unit
uniform usampler2D uLinks;

// That one walk goes through: over the rows of a side that the view sees edge-on, hundreds of them within a pixel.
const int kMostTriangles = 512;

struct Piercing {
    int triangle; // kNoTriangle: the ray passes by
    float t;      // m along the ray; below 0 behind its origin
    vec3 shares;  // of the corners, their sum 1
    ivec3 corners;
    vec3 outward; // the triangle's own normal, of any length
};
const Piercing kNowhere = Piercing(kNoTriangle, 0.0, vec3(0.0), ivec3(0), vec3(0.0));

float crossed(vec2 a, vec2 b) { return a.x * b.y - a.y * b.x; }

// Two directions across a ray, and its own: columns.
mat3 axesOf(vec3 direction) {
    vec3 right = normalize(abs(direction.x) < 0.6 ? cross(direction, vec3(1.0, 0.0, 0.0))
                                                  : cross(direction, vec3(0.0, 1.0, 0.0)));
    return mat3(right, cross(direction, right), direction);
}

// Only as far as the surface turns one side to the ray: where it folds, what lies beyond is not in the ray's way.
//
// origin  measured from the eye, as rays are
// axes    axesOf() the ray's direction
// side    1: where the ray leaves, -1: where it enters
Piercing pierce(vec3 eye, vec3 origin, mat3 axes, int start, float side) {
    int triangle = start, before = kNoTriangle;
    for (int i = 0; i < kMostTriangles && triangle != kNoTriangle; ++i) {
        Links links = linksFrom(texelFetch(uLinks, tableTexel(triangle), 0));
        ivec3 corners = ivec3(links.corners, triangle);
        // The same numbers for a corner whichever triangle asks: no ray slips through an edge.
        vec3 a = (texelFetch(uCorners, tableTexel(corners.x), 0).xyz - eye - origin) * axes;
        vec3 b = (texelFetch(uCorners, tableTexel(corners.y), 0).xyz - eye - origin) * axes;
        vec3 c = (texelFetch(uCorners, tableTexel(corners.z), 0).xyz - eye - origin) * axes;
        vec3 inward = side * vec3(crossed(b.xy, c.xy), crossed(c.xy, a.xy), crossed(a.xy, b.xy));
        float area = inward.x + inward.y + inward.z;
        if (area <= 0.0) break;
        // Edge from corner 0 to 1 lies opposite of corner 2, and so on.
        int next = links.across.x;
        float least = inward.z;
        if (inward.x < least) {
            least = inward.x;
            next = links.across.y;
        }
        if (inward.y < least) {
            least = inward.y;
            next = links.across.z;
        }
        // Two triangles that send the ray to each other share the edge that it meets.
        if (least >= 0.0 || next == before) {
            vec3 shares = clamp(inward / area, 0.0, 1.0);
            shares /= shares.x + shares.y + shares.z;
            return Piercing(triangle, dot(shares, vec3(a.z, b.z, c.z)), shares, corners,
                            axes * cross(b - a, c - a));
        }
        before = triangle;
        triangle = next;
    }
    return kNowhere;
}

// The normal that bends light there: interpolated between the corners where that faces the ray as the triangle does,
// else the triangle's own.
vec3 bendingNormal(Piercing p, vec3 direction, float side) {
    vec3 smooth_ = p.shares.x * texelFetch(uCornerNormals, tableTexel(p.corners.x), 0).xyz +
                   p.shares.y * texelFetch(uCornerNormals, tableTexel(p.corners.y), 0).xyz +
                   p.shares.z * texelFetch(uCornerNormals, tableTexel(p.corners.z), 0).xyz;
    return normalize(side * dot(smooth_, direction) > 0.0 ? smooth_ : p.outward);
}
