#pragma once
/// Triangles and how they move, and the heights that a height field can take from them.

#include "base/File.h"
#include "base/Image.h"
#include "base/Math.h"
#include "scene/Scene.h"
#include "scene/Textures.h"

#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lucent::scene {

/// Displacements of a morph target, one a vertex.
struct MorphTarget {
    std::vector<vec3> positions, normals; ///< normals may be empty
};

/// What moves a node of a file: values at times, between them linear, stepped or cubic (glTF 2.0, 3.11).
struct Channel {
    enum class Path { Translation, Rotation, Scale, Weights };
    enum class Interpolation { Linear, Step, CubicSpline };
    int node = 0;        ///< which it moves; of no meaning for weights
    int firstTarget = 0; ///< whose weight it sets, and those of the ones behind it; of weights only
    Path path = Path::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< s, ascending
    std::vector<float> values; ///< width() for each time; three times as many for a cubic spline: tangent in,
                               ///< value, tangent out

    /// Numbers of one value: 3, 4 (quaternion x, y, z, w), or how many weights it sets.
    std::size_t width() const;
};

/// A node of a file's tree: scaled, turned, then moved in its parent's space.
struct Node {
    int parent = -1; ///< always before the node in the list
    vec3 translate{0};
    glm::quat rotate{1, 0, 0, 0};
    vec3 scale{1};
};

/// How a mesh moves. Vertices of a mesh with joints are moved by the joints alone.
struct Rig {
    std::vector<Node> nodes;
    std::vector<int> joints;         ///< nodes; a vertex's joint indices count in this list
    std::vector<mat4> jointFromMesh; ///< inverse bind matrices, one a joint
    std::vector<MorphTarget> targets;
    std::vector<float> weights;    ///< of the targets, at rest
    std::vector<Channel> channels; ///< of the first animation; others are named on stderr
    float duration = 0;            ///< s; the animation begins again after it
};

/// A lamp of a file (KHR_lights_punctual).
struct FileLight {
    enum class Kind : std::uint8_t { Point, Spot, Distant };
    Kind kind = Kind::Point;
    vec3 position{0};                      ///< m
    vec3 direction{0, 0, -1};              ///< unit, the way its light travels; of no meaning for points
    vec3 color{1};                         ///< linear
    float intensity = 1;                   ///< cd, or lux of a distant one
    float innerAngle = 0, outerAngle = 45; ///< of spots, degrees from the axis
};

/// A camera of a file.
struct FileCamera {
    bool perspective = true;
    vec3 eye{0};                         ///< m
    vec3 forward{0, 0, -1}, up{0, 1, 0}; ///< unit, perpendicular
    float fov = 40;                      ///< perspective: vertical degrees
    float height = 1;                    ///< orthographic: m from top to bottom
    float aspect = 1;                    ///< width over height; 0: the file does not say
};

struct Mesh {
    std::vector<vec3> positions;        ///< m; with joints: as bound to them, else at rest
    std::vector<std::uint32_t> indices; ///< three a triangle, counter-clockwise seen from outside
    std::vector<vec3> normals{};        ///< unit, one a position; empty: areaWeightedNormals()
    std::vector<std::array<std::uint16_t, 4>> joints{}; ///< of each position, in Rig::joints; empty: none
    std::vector<vec4> jointWeights{};                   ///< >= 0, their sum 1
    std::vector<vec2> coordinates{}; ///< on textures: u to the right and v down, one a position; empty: none
    std::vector<vec2> secondCoordinates{}; ///< for textures that lie elsewhere; as many, or none
    std::vector<vec3> colors{}; ///< linear, >= 0, factors of the albedo, one a position; empty: none
    Rig rig{};

    /// Triangles by material, in the order of `indices`; empty for files without materials.
    struct Part {
        std::string material; ///< unique within the mesh
        std::uint32_t firstIndex = 0, indexCount = 0;
        Material values; ///< what the file says of it
        Textures textures{};
    };
    std::vector<Part> parts{};
    std::vector<std::shared_ptr<const TextureImage>> images{}; ///< of its textures; never null

    /// What a file shows its triangles with, at rest; a scene that is made of the file takes it.
    std::vector<FileLight> lights{};
    std::vector<FileCamera> cameras{}; ///< the first, or none

    bool moves() const { return rig.duration > 0; }
};

/// The rest of a vertex's motion at one time: p = sum of weight * joints[j] * (p0 + sum of weights *
/// targets).
struct Pose {
    std::vector<mat4> joints;   ///< in the mesh's space; empty: the mesh has none
    std::vector<float> weights; ///< of the morph targets
};
/// Where the rig stands at `time` [s], which wraps around at the duration.
Pose poseAt(const Rig& rig, float time);

/// The mesh as it stands in a pose, without its rig. Normals go by the inverse transpose.
Mesh posed(const Mesh& mesh, const Pose& pose);

/// Normals of the vertices: those of the triangles around, weighted by area. Vertices at the same place with
/// the same index only; of no triangle: +y. Triangles without area count nothing.
std::vector<vec3> areaWeightedNormals(std::span<const vec3> positions,
                                      std::span<const std::uint32_t> indices);

inline constexpr int kSphereSegments = 256, kTorusSegments = 384; ///< once around

/// Meshes of the shapes that are neither files nor fields, centred in their object's space, with normals.
/// Their vertices lie on the shape; `segments` (3 or more) go once around, the other way in proportion but
/// not more. Flat sides have `cells` squares along each edge: 1 unless the shape is to be bent; lids of
/// cylinders are fans around their centre. Neighbouring faces meet at the same positions to the bit. The
/// plane and the open cylinder, which faces away from its axis, are sheets of one layer whose two sides both
/// count.
Mesh meshOf(const Plane& plane, int cells = 1);
Mesh meshOf(const Box& box, int cells = 1);
Mesh meshOf(const Sphere& sphere, int segments = kSphereSegments);
Mesh meshOf(const Torus& torus, int segments = kTorusSegments);
Mesh meshOf(const Cylinder& cylinder, int segments = kSphereSegments);
/// The body of a height field, closed: its top cut into triangles between texel centres and the border, walls
/// around and a flat bottom, at height 0 or the lowest one below that. Where heights touch the bottom, or a
/// hole was dug, it has none.
Mesh meshOf(const HeightField& field);
/// Water without waves: its grid, row after row along x; a sheet like the plane.
///
/// @param most  squares along the longer side; 0: as many as its heights have
Mesh meshOf(const Water& water, int most = 0);
/// Squares of that grid along x and z: `cells` along the longer side, or `most`, about as large along the
/// other.
ivec2 waterCells(const Water& water, int most = 0);

/// The triangles of an object that is no relief (Object::isField()), as all draw it: those of its file, or
/// such as lie on its shape, made once for the same shape. With a wave flat sides are cut into small squares;
/// with flat normals no two triangles share a vertex. Water lies still. What is displaced is
/// displacedMesh().
std::shared_ptr<const Mesh> meshOf(const Object& object);
/// What stands in the light's way in place of meshOf(): coarser for round shapes that are not refractive,
/// whose outline it leaves by at most 0.03 % of the radius, to the inside. Else the same.
std::shared_ptr<const Mesh> shadowMeshOf(const Object& object);

/// Whether a material's textures are shown: it is matt or glossy.
bool showsTextures(const Material& material);

/// The textures on an object: those of its file's material, where it shows them and is matt or glossy; null:
/// none. Their images and coordinates are those of meshOf(), of a displaced object those of its file: a point
/// above a triangle has the coordinates of its foot.
const Textures* texturesOf(const Object& object);

/// For each vertex the first one at its place.
std::vector<std::uint32_t> weldedVertices(std::span<const vec3> positions);

/// Edges beside which a triangle is missing or lies the wrong way round; 0: the mesh is closed. Vertices at
/// the same place count as one, so that sharp edges are no gaps.
std::size_t openEdges(const Mesh& mesh);

/// The triangles of one material with the vertices they use, and all of the rig.
Mesh partOf(const Mesh& mesh, const Mesh::Part& part);

/// True for bytes that start as the plain form does.
bool isMesh(std::span<const std::byte> bytes);
/// The plain form in which meshes reach the loader: "LUCENTM7" and then everything above, little-endian; of a
/// material its colours and the numbers of its kind that such files know.
/// The readers write it from glTF and OBJ, natively and in the page alike. Of a picture whose texels lie
/// elsewhere it has their file's number.
Bytes encodeMesh(const Mesh& mesh);
/// Error "NAME: what; expected" for truncated files, indices out of range, lists whose lengths do not agree
/// and values that are not finite or outside their range.
Result<Mesh> decodeMesh(std::span<const std::byte> bytes, const std::string& name);
/// The same without the texels of its pictures, wherever they lie: for who wants its shape and materials.
Result<Mesh> decodeShape(std::span<const std::byte> bytes, const std::string& name);
/// As decodeMesh(), piece by piece, for who must not wait; a mesh without normals gets those of its
/// triangles.
class MeshMaking {
public:
    /// @param read  gives the file, and as NAME#NUMBER the texels of its pictures that lie elsewhere
    MeshMaking(std::string name, ReadFile read);
    ~MeshMaking();
    /// One piece more; the mesh once it is whole.
    std::optional<Result<std::shared_ptr<const Mesh>>> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The mesh's depth as heights (height-field thesis 2017, 3.1.2): seen along -z after `rotation`, the
/// bounding box fitted into `size` texels with square texels and a margin of `margin` of the larger side (of
/// a narrow picture at least one texel stays free). Depth is taken exactly at texel centres; both sides of a
/// triangle count. What moves stands as it does at time 0.
///
/// @param rotation  degrees about the fixed x, y, z axes
/// @return          1 channel; nearest visible point = 1, farthest = `floorGap`, background 0; all 1 of a
///                  plane seen from straight above
Image depthOfMesh(const Mesh& mesh, vec3 rotation, ivec2 size, float margin, float floorGap);
/// The same piece by piece, for who must not wait.
class DepthMaking {
public:
    DepthMaking(const Mesh& mesh, vec3 rotation, ivec2 size, float margin, float floorGap);
    /// One piece more; the depth once it is whole.
    std::optional<Image> advance();

private:
    ivec2 size_;
    float floorGap_;
    std::vector<dvec3> corners_; ///< texels, x to the right and y down from the upper left; z to the viewer
    std::vector<std::uint32_t> indices_;
    std::vector<double> depth_;
    std::size_t next_ = 0; ///< of the indices
};

/// Heights from a normal map by least-squares integration (thesis 3.1.3 sums along paths, which depends on
/// the path): the field whose slopes between texels are nearest to the map's.
///
/// @param normals  3 channels as stored, n = 2 c - 1, +y up in the picture (OpenGL convention), texels square
/// @return         1 channel in texel widths, smallest value 0. Error where n_z <= 0 or a
///                 value is not finite, naming the texel.
Result<Image> heightsFromNormals(const Image& normals, const std::string& name);
/// The same piece by piece, for who must not wait.
class NormalsIntegration {
public:
    NormalsIntegration(const Image& normals, const std::string& name);
    ~NormalsIntegration();
    /// One piece more; the heights once they are whole.
    std::optional<Result<Image>> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent::scene
