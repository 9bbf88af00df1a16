// caustics/map_view.glsl: how the caustic map's texels lie around the light.
//
// The file that includes this declares `light.faces`, the map's.
// PARABOLOIDS  each of the one or two faces holds half of all directions as the disc of a paraboloid (Heidrich, Seidel
//              1998): the direction v, z along `forward`, lies at v.xy / (1 + v.z), of which `right` and `up` are one
//              texel. Depths are then distances. Else the faces are plane views
#include "views/shadow.glsl"

#ifdef PARABOLOIDS
// Radians in a unit of the disc.
float anglesIn(View face, vec2 pixel) {
    vec2 at = (pixel - 0.5 * face.size) * vec2(length(face.right.xyz), length(face.up.xyz));
    return 2.0 / (1.0 + dot(at, at));
}

// Unit direction through a texel.
vec3 wayThrough(View face, vec2 pixel) {
    vec2 p = pixel - 0.5 * face.size;
    float angles = anglesIn(face, pixel);
    return angles * (p.x * face.right.xyz + p.y * face.up.xyz) + (angles - 1.0) * face.forward.xyz;
}

const float kMostBehind = 0.5; // cosine to the back of a face: what a beam that crosses its rim may reach; chosen by eye
#endif

// Pixel coordinates in a face; z: depth, not above 0 where a place lies behind the face.
vec3 onMap(int number, vec3 place) {
    View face = light.faces[number];
    vec3 v = place - face.eye.xyz;
    vec3 seen = inView(face, v);
#ifdef PARABOLOIDS
    float reach = length(v);
    return vec3(seen.xy / max(reach + seen.z, 1e-20) + 0.5 * face.size, seen.z > -kMostBehind * reach ? reach : -1.0);
#else
    return vec3(pixelOf(face, seen), seen.z);
#endif
}

// Depth at which the light's line through a texel meets the plane through v, which is measured from the light.
float depthOnPlane(View face, vec2 pixel, vec3 v, vec3 normal) {
#ifdef PARABOLOIDS
    float facing = dot(normal, wayThrough(face, pixel));
    return facing < 0.0 ? dot(normal, v) / facing : length(v);
#else
    return planeDepth(face, pixel, v, normal);
#endif
}

// Width of a texel at v [m].
float texelWidth(View face, vec2 pixel, vec3 v) {
    float width = max(length(face.right.xyz), length(face.up.xyz));
#ifdef PARABOLOIDS
    return width * length(v) * anglesIn(face, pixel);
#else
    return width * (face.eye.w > 0.5 ? dot(v, face.forward.xyz) : 1.0);
#endif
}

// Area of a texel at v across the light [m²].
float texelArea(View face, vec2 pixel, vec3 v) {
    float area = length(face.right.xyz) * length(face.up.xyz);
#ifdef PARABOLOIDS
    float angles = anglesIn(face, pixel);
    return area * angles * angles * dot(v, v);
#else
    if (face.eye.w < 0.5) return area;
    float depth = dot(v, face.forward.xyz);
    return area * depth * depth * depth / length(v);
#endif
}
