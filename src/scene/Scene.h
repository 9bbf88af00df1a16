#pragma once
/// What a scene is: objects, lights, an environment, a camera. Plain values; loading is in Load.h.

#include "base/Image.h"
#include "base/Kept.h"
#include "base/Math.h"
#include "base/Param.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace lucent::scene {

/// Where heights came from: a picture of heights, of normals, or the depth of a mesh.
struct HeightSource {
    enum class Kind { Heights, NormalMap, Mesh };
    Kind kind = Kind::Heights;
    std::string file;           ///< as the scene file names it
    ivec2 resolution{512, 512}; ///< texels, this and the rest for a mesh only (see depthOfMesh)
    vec3 meshRotate{0};         ///< degrees about the fixed x, y, z axes
    float margin = 0.04f;       ///< of the larger side
    float floorGap = 0.12f;     ///< height of the farthest visible point
    bool operator==(const HeightSource&) const = default;
};

/// Heights over a rectangle that lies in its object's xy plane, centred, facing +z, image row 0 at +y.
///
/// Samples stand at texel centres, bilinear between, constant in the outer half texel; the footprint's border
/// is a wall to outside and there is no floor. The field is `width` metres wide, its texels are square.
struct HeightField {
    float width = 1;          ///< m, > 0
    float heightScale = 0.1f; ///< m for a height of 1, >= 0

    /// A texel with alpha 0 still casts and holds light. When false the loader has dug a hole at each texel
    /// with alpha below 0.5: it lies the larger footprint side below the lowest height, at most 1e4 heights.
    bool alphaIsSolid = true;

    std::shared_ptr<const Image> heights; ///< 1 channel, finite; never null once loaded
    std::shared_ptr<const Image> alpha;   ///< 1 channel, [0,1]; null: opaque. Any size.
    HeightSource source;                  ///< of the heights
    std::string alphaFile;                ///< as the scene file names it

    ivec2 texels() const { return heights->size(); }
    /// Edge of a texel in metres.
    float texelSize() const { return width / float(heights->width); }
    /// Width and height of the footprint in metres.
    vec2 footprint() const { return vec2(heights->size()) * texelSize(); }
    bool operator==(const HeightField&) const = default;
};

struct Mesh;

/// Triangles of a file, or of one of its materials.
struct MeshShape {
    std::string source;               ///< as the scene file names it
    std::string part;                 ///< only triangles of this material of the file; "": all
    bool flatNormals = false;         ///< light meets the triangles themselves, not interpolated normals
    bool textured = true;             ///< with the textures of its file, where that has some
    std::shared_ptr<const Mesh> mesh; ///< never null once loaded
    bool operator==(const MeshShape&) const = default;
};

/// A rectangle in its object's xz plane, centred, facing +y.
struct Plane {
    vec2 size{1}; ///< m along x and z, > 0
    bool operator==(const Plane&) const = default;
};

/// A block, centred.
struct Box {
    vec3 size{1}; ///< m, > 0
    bool operator==(const Box&) const = default;
};

struct Sphere {
    float radius = 1; ///< m, > 0
    bool operator==(const Sphere&) const = default;
};

/// All points at distance `minor` from a circle of radius `major` around the y axis.
struct Torus {
    float major = 1, minor = 0.25f; ///< m, 0 < minor <= major
    bool operator==(const Torus&) const = default;
};

/// Around the y axis, centred.
struct Cylinder {
    float radius = 0.5f, height = 1; ///< m, > 0
    bool open = false;               ///< a band without lids: a ring
    bool operator==(const Cylinder&) const = default;
};

/// A surface of water: a rectangle in its object's xz plane, centred, facing +y, whose height obeys the wave
/// equation. It begins as a travelling sine; drops fall in from there on.
struct Water {
    vec2 size{1};             ///< m along x and z, > 0
    int cells = 128;          ///< along the longer side
    float speed = 0.5f;       ///< of waves, m/s
    float damping = 0.2f;     ///< 1/s, >= 0
    float amplitude = 0;      ///< of the sine, m, >= 0
    float wavelength = 0.25f; ///< m, > 0
    vec2 direction{1, 0};     ///< in which it travels, in x and z; any length > 0
    float dropInterval = 0;   ///< s between drops at random places; 0: none but the pointer's
    bool operator==(const Water&) const = default;
};

using Shape = std::variant<HeightField, MeshShape, Plane, Box, Sphere, Torus, Cylinder, Water>;

/// A wave through an object's points: p moves by amplitude sin(2 pi (d . p / wavelength - t / period)), with
/// d the direction. Normals follow exactly, by the inverse transpose of the derivative.
struct Wave {
    vec3 amplitude{0};       ///< m in the object's space; 0: none
    vec3 direction{1, 0, 0}; ///< any length > 0
    float wavelength = 0.5f; ///< m, > 0
    float period = 1;        ///< s, > 0
    bool operator==(const Wave&) const = default;
};

/// Of what scatters: beyond, the fit of what its boundary reflects inside (Egan and Hilgeman's) is no share.
inline constexpr float kLeastScatteringIor = 0.3f, kMostScatteringIor = 3;

/// A layer of another medium on top of what a scattering material is made of.
struct MediumLayer {
    float thickness = 0.001f; ///< m, >= 0; 0: not there
    vec3 scattering{1000};    ///< sigma_s, 1/m
    vec3 absorption{0};       ///< sigma_a, 1/m
    float anisotropy = 0;     ///< g, as Material's
    float ior = 1.5f;         ///< over that of vacuum
    int order = 1;            ///< layers lie from the top by rising order, those of one as they are listed
};
inline constexpr std::size_t kMostMediumLayers = 4;

/// Light as the relief model has it (height-field thesis 2017, 3.5), over the material's own colours. On
/// shapes other than height fields it is the model's matt limit, depth 0.
struct Relief {
    vec3 specular{1};           ///< cS
    float specularity = 0;      ///< ks, [0,1]
    float forwardScatter = 0;   ///< kf, [0,1]
    float depth = 0.05f;        ///< t: how far below the surface the light is looked at, m, > 0
    vec2 specularFalloff{0, 1}; ///< s_min, s_max
    vec2 scatterFalloff{0, 1};  ///< f_min, f_max
};

/// Light that goes out evenly in all directions: the material's own colours and nothing else.
struct Matt {};

struct Mirror {
    vec3 reflectance{1}; ///< share of mirrored light at any angle, [0,1]
};

/// What refracts, and lets light through. As glTF defines the words.
struct Clear {
    float transmission = 1; ///< share of the light that the inside lets pass, [0,1]
    float ior = 1.5f;       ///< index of refraction of the inside over that of vacuum, > 0
    vec3 absorption{0};     ///< sigma, 1/m: light falls by exp(-sigma l) on a way of l metres
    float dispersion = 0;   ///< 20 / Abbe number
    bool fresnel = true;    ///< false: all light is transmitted where Snell's law lets it
    /// At which absorption is spoken of as a colour (Attenuation), m; 0: at none yet. Does nothing to light.
    float attenuationDistance = 0;

    bool operator==(const Clear&) const = default;
};

/// What has subsurface scattering.
struct Translucent {
    vec3 scattering{1000};  ///< sigma_s, 1/m, not 0
    vec3 absorption{0};     ///< sigma_a, 1/m
    float ior = 1.5f;       ///< index of refraction of the inside over that of vacuum
    float anisotropy = 0;   ///< g, mean cosine of a scattered ray, [-0.999,0.999]
    float thickness = 0;    ///< m, of a slab that the surface is the upper side of; 0: as thick as the object
    float roughness = 0.3f; ///< of the surface, [0,1]: its highlight
    /// What leaves of light is worked out once for the body (isPrecomputed()), not for each picture.
    bool precomputed = false;
    std::vector<MediumLayer> layers{}; ///< on top of it, kMostMediumLayers at most, in no order
    float attenuationDistance = 0;     ///< as Clear's

    /// The layers that are there, the top first.
    std::vector<MediumLayer> stackedLayers() const;
    /// Index of refraction inside the surface: that of the top layer, or ior.
    float surfaceIor() const;
};

/// Metallic-roughness as glTF 2.0 has it (appendix B): mirror facets spread by GGX, over what is matt of what
/// is no metal. `diffuse` is the base colour. Of what is no metal and white it gives back up to a quarter
/// more light than it gets where the view grazes.
struct Glossy {
    float metallic = 0;     ///< [0,1]
    float roughness = 0.5f; ///< [0,1], the root of GGX's alpha
    float ior = 1.5f; ///< of what is no metal, >= 1: mirrors ((ior - 1) / (ior + 1))² of light from above
    vec3 specular{1}; ///< factor of that, [0,1]
};

/// diffuse / pi + specular cos^exponent of the angle between view and mirrored light (image-space
/// dissertation 2007, eq. 2.27).
struct Phong {
    vec3 specular{0.3f};
    float exponent = 32; ///< >= 0
    /// Without the factor (exponent + 2) / (2 pi), and the diffuse part not over pi: gives more light than it
    /// gets.
    bool asPrinted = false;
};

/// The same of the angle between the normal and the direction halfway between light and view (eq. 2.28). Its
/// factor is (n + 2) (n + 4) / (8 pi (2^(-n/2) + n)).
struct Blinn {
    vec3 specular{0.3f};
    float exponent = 128;
    bool asPrinted = false;
};

/// diffuse / pi + specular F D G / (4 cos cos), with Beckmann's D and grooves like a V (eq. 2.31).
struct CookTorrance {
    vec3 specular{1};
    float roughness = 0.5f; ///< [0,1], the root of the facets' slope m
    float ior = 1.5f;       ///< >= 1
    bool asPrinted = false; ///< four times as much, D without 1 / pi
};

/// Matt facets, in grooves like a V (Oren, Nayar 1994, qualitative model).
struct OrenNayar {
    float roughness = 0.5f; ///< [0,1], standard deviation of the facets' slopes, radians
};

/// How a table of a BRDF is laid out: ReflectanceTable.h.
enum class TableForm : int { Merl, Projected, EqualArea };

/// Measured in many directions, and looked up in a table. Colours do nothing to it.
struct MeasuredBrdf {
    TableForm form = TableForm::Merl;
    int blocks = 0;          ///< a side, of a form that has them; 0: the root of the table's side
    std::string tableFile{}; ///< as the scene file names it
    std::shared_ptr<const Image> table{}; ///< 3 channels, 1/sr; never null once loaded
};

using MaterialKinds = std::variant<Relief, Matt, Mirror, Clear, Translucent, Glossy, Phong, Blinn,
                                   CookTorrance, OrenNayar, MeasuredBrdf>;

/// Of facets, as Glossy has it: up to this a surface shows the objects around in what it mirrors; in rougher
/// ones they only stand in the light's way.
inline constexpr float kMostMirroringRoughness = 0.5f;
inline constexpr std::size_t kFirstGlossy = 5;
static_assert(std::is_same_v<std::variant_alternative_t<kFirstGlossy, MaterialKinds>, Glossy>);

/// What the surface does with light: one of a few kinds, and the colours that those of them share which send
/// it back themselves (Relief, Matt, glossy ones, and what is painted on Translucent).
struct Material {
    vec3 base{0};       ///< cB, shown without light; W/(m² sr)
    vec3 diffuse{0.8f}; ///< cD, albedo
    MaterialKinds kind{};

    std::shared_ptr<const Image> baseMap{}, diffuseMap{},
        specularMap{}; ///< 3 channels, linear; multiply the colours of a height field's relief
    std::string baseMapFile{}, diffuseMapFile{}, specularMapFile{}; ///< as the scene file names them

    bool isRelief() const { return std::holds_alternative<Relief>(kind); }
    /// All pictures that it refers to; null where there is none.
    std::vector<std::shared_ptr<const Image>> maps() const {
        const auto* measured = std::get_if<MeasuredBrdf>(&kind);
        return {baseMap, diffuseMap, specularMap, measured ? measured->table : nullptr};
    }
    bool isMirror() const { return std::holds_alternative<Mirror>(kind); }
    bool isRefractive() const { return std::holds_alternative<Clear>(kind); }
    bool isScattering() const { return std::holds_alternative<Translucent>(kind); }
    /// Whether it sends light back itself, and not as the same in all directions.
    bool isGlossy() const { return kind.index() >= kFirstGlossy; }

    /// The kind, which it must be of.
    Relief& relief() { return *std::get_if<Relief>(&kind); }
    Mirror& mirror() { return *std::get_if<Mirror>(&kind); }
    Clear& clear() { return *std::get_if<Clear>(&kind); }
    Translucent& translucent() { return *std::get_if<Translucent>(&kind); }
    const Relief& relief() const { return *std::get_if<Relief>(&kind); }
    const Mirror& mirror() const { return *std::get_if<Mirror>(&kind); }
    const Clear& clear() const { return *std::get_if<Clear>(&kind); }
    const Translucent& translucent() const { return *std::get_if<Translucent>(&kind); }
};

/// Placement of an object: scaled, then rotated about the fixed x, y, z axes, then moved.
struct Transform {
    vec3 translate{0}; ///< m
    vec3 rotate{0};    ///< degrees
    float scale = 1;   ///< > 0
    mat4 worldFromObject() const;
};

/// How an eye ray finds the first place where it meets displaced heights.
enum class DisplacementMethod : int { Parallax, Linear, Relief, Interval, Quadtree };

/// Heights that lift a surface along its normals (Displacement.h).
struct Displacement {
    float scale = 0.05f; ///< m for a height of 1, >= 0
    vec2 repeat{1};      ///< tiles along u and v, > 0
    DisplacementMethod method = DisplacementMethod::Quadtree;
    int searchSteps = 32;                 ///< of linear, relief and interval, from the highest height down
    int refineSteps = 8;                  ///< most of relief and interval
    std::shared_ptr<const Image> heights; ///< 1 channel, [0,1]; never null once loaded
    HeightSource source{};                ///< of the heights
    bool operator==(const Displacement&) const = default;
};

struct Painting;

struct Object {
    std::string name;
    Shape shape;
    Material material;
    Transform transform;
    Wave wave;                                  ///< not for height fields, water and what is displaced
    std::optional<Displacement> displacement{}; ///< of planes, spheres, tori and meshes that stand still
    bool visible = true;                        ///< false: hidden from the camera only
    /// What an artist painted on it; null: nothing. Acts where the material scatters.
    std::shared_ptr<const Painting> painting;
    /// What was worked out of it beforehand, as the technique that wrote it reads it; null: nothing.
    std::shared_ptr<const std::vector<std::byte>> bake;
    std::string bakeFile{}; ///< as the scene file names it
    /// Of a mesh that is made of its shape, along the longest side or once around, at most; 0: as many as it
    /// needs. No part of a file: previews have few (CoarseMesh.h).
    int mostCells = 0;
    Kept kept{}; ///< what was worked out from it: its mesh, its bounds

    /// A height field that is a relief, whose heights rays walk along. Of other materials it is a mesh, the
    /// body of its heights (Mesh.h).
    bool isField() const { return std::holds_alternative<HeightField>(shape) && material.isRelief(); }
    /// Displaced and opaque: rays are cast through the space above its triangles. Of what light passes
    /// through, displaced triangles are drawn instead (Displacement.h).
    bool isDisplaced() const { return displacement && !material.isRefractive() && !material.isScattering(); }
    /// The shape, which must be a height field.
    HeightField& field() { return std::get<HeightField>(shape); }
    const HeightField& field() const { return std::get<HeightField>(shape); }
};

/// How the light of a point source fades: not at all (the thesis) or with the square of the distance
/// (physics).
enum class LightFalloff : int { None, InverseSquare };

struct PointLight {
    vec3 position{0.3f, 0.4f, 0.6f}; ///< m
    vec3 color{1};
    float intensity = 1; ///< W/m² on what faces it; W/sr with inverse-square falloff
    LightFalloff falloff = LightFalloff::None;
    float radius = 0; ///< m, >= 0: a disc that faces what it lights; 0: a point
};

struct DistantLight {
    vec3 direction{0, 0, -1}; ///< the way the light travels; any length > 0
    vec3 color{1};
    float irradiance = 1; ///< on a facing surface, W/m²
    float angle =
        0; ///< degrees across, [0,90]: an even disc of directions; the sun has 0.53; 0: one direction
};

/// Longest side of a picture that a lamp projects, texels: larger ones are made smaller as they are read.
inline constexpr int kMostPictureSide = 1024;

/// A point that shines into a cone. Its light fades with the square of the distance.
struct SpotLight {
    vec3 position{0, 1, 0};
    vec3 direction{0, -1, 0}; ///< any length > 0
    vec3 color{1};
    float intensity = 1; ///< W/sr inside the inner cone
    float innerAngle = 20,
          outerAngle = 25; ///< degrees from the axis; between them light fades as glTF has it
    // A projector: a picture in the cone, its middle on the axis. What falls beside it is dark.
    float fov = 40;                       ///< degrees across the picture's width
    float roll = 0;                       ///< degrees, counter-clockwise seen from the lamp; at 0 its upper
                                          ///< edge is towards +y, of one that looks straight up or down -z
    std::string imageFile{};              ///< as the scene file names it
    std::shared_ptr<const Image> image{}; ///< 3 channels, linear, factors of the color; null: none
};

/// The directions along the width and the height of what a projector shows, right and up seen from it, so
/// long that d . right / d . axis is 1 for a direction d to the picture's right edge; and up likewise.
struct PictureFrame {
    vec3 right, up;
};
PictureFrame pictureFrame(const SpotLight& projector);

/// A parallelogram that shines from one side: that from which edgeU turns to edgeV counter-clockwise.
struct AreaLight {
    vec3 corner{-0.25f, 1, -0.25f};
    vec3 edgeU{0.5f, 0, 0}, edgeV{0, 0, 0.5f}; ///< m, not parallel
    vec3 color{1};
    float radiance = 1; ///< factor of the color, W/(m² sr)
};

using Light = std::variant<PointLight, DistantLight, SpotLight, AreaLight>;

/// Light from all around, on a lat-long map: row 0 = +y, centre column = -z, to the right = +x.
struct Environment {
    std::string source = "uniform"; ///< "rainbow", "sky", "uniform", "direction" or a file
    vec3 rotation{0};               ///< degrees about the fixed x, y, z axes, x first
    float intensity = 1;
    bool enabled = true;              ///< off: only the lights shine
    std::shared_ptr<const Image> map; ///< 3 channels, linear; always there once loaded
    Kept kept{};                      ///< what was worked out from it: its lights
};

struct Camera {
    enum class Type : int { Orthographic, Perspective };
    Type type = Type::Orthographic;
    vec3 eye{0, 0, 2};
    vec3 target{0};
    vec3 up{0, 1, 0};
    float height = 1; ///< m shown from top to bottom, orthographic
    float fov = 40;   ///< vertical degrees, perspective
};

/// What is shown instead of the picture: one of the quantities behind it.
enum class Aov : int {
    Color,
    Illumination,
    Visibility,
    Normal,
    Depth,
    Position,
    Iterations,
    Irradiance,  ///< what arrives at an opaque surface, before its albedo
    Direction,   ///< unit, in which light seen through refractive objects came in, or the eye ray's
    Layers,      ///< interfaces that the eye ray crosses
    Lost,        ///< 1 where light seen through refractive objects was given up or ran out of layers
    LayerDepth,  ///< of one layer of refractive surfaces (View::layer): m along the view
    LayerNormal, ///< outward
    LayerObject, ///< a colour for each object, darker where its inside faces the eye
    CausticMap,  ///< light that refractive objects and mirrors throw, as one point of a lamp sees it; 1: what
                 ///< it leaves there undisturbed
    Radiosity,   ///< W/m² that leave where light was scattered inside
    Misses,      ///< 1 where the ray cast of a displaced surface finds another place than the exact one
    Atlas        ///< W/m², the charts of a precomputed object beside each other, over the whole picture
};

/// Whether it is one of several images, which View::layer chooses.
inline bool isNumbered(Aov aov) { return aov >= Aov::LayerDepth && aov <= Aov::CausticMap; }

/// A painted map shown on its object in place of light.
enum class PaintLayer : int { None, Translucency, Blur, Glow, Outgoing };

/// How linear light becomes a picture: exposure, clamp, sRGB curve; nothing else.
struct View {
    float exposure = 0; ///< ev: the image is multiplied by 2^ev
    Aov show = Aov::Color;
    int layer = 1;        ///< which layer, or which point of the lamps, from 1 on
    bool lightDot = true; ///< the viewer marks the light's place
    float time = 0;       ///< s, of waves, water and animations
    // What who views asks for, not a scene: no parameters.
    PaintLayer paintLayer = PaintLayer::None;
    bool matt = false; ///< what scatters light is drawn as if light left where it entered
};

/// How exact the picture must be.
struct Quality {
    /// RMSE over the objects' pixels in linear colour over the truth's mean there; 0: as exact as the
    /// settings of the techniques make it. Above 0 the techniques choose their cheapest settings that keep
    /// it.
    float maxError = 0;
};

struct Scene {
    std::string title, caption;
    ivec2 size{512, 512};
    Camera camera;
    View view;
    std::optional<Environment> environment;
    std::vector<Light> lights;
    std::vector<Object> objects;
    std::map<std::string, Settings> technique; ///< one for each registered technique, by its table's name
    Quality quality;
};

/// Pictures of its light: the map of its environment, and what lamps project.
std::vector<std::shared_ptr<const Image>> lightPictures(const Scene& scene);

/// Whether an object lets all light through as it came: it has the index of the vacuum, absorbs nothing, and
/// stands in no other medium.
bool changesNoLight(const Scene& scene, const Object& object);

const ParamTable& heightFieldParams();
const ParamTable& heightSourceParams(); ///< read when loaded; not bound by bindParams()
const ParamTable& meshParams();
const ParamTable& planeParams();
const ParamTable& boxParams();
const ParamTable& sphereParams();
const ParamTable& torusParams();
const ParamTable& cylinderParams();
const ParamTable& waterParams();
const ParamTable& waveParams();
// Of the material and its kinds; see Keys.h.
const ParamTable& colorParams();
const ParamTable& reliefParams();
const ParamTable& mirrorParams();
const ParamTable& clearParams();
const ParamTable& translucentParams();
const ParamTable& glossyParams();
const ParamTable& phongParams();
const ParamTable& blinnParams();
const ParamTable& cookTorranceParams();
const ParamTable& orenNayarParams();
const ParamTable& measuredParams();
const ParamTable& layerParams(); ///< a layer of what is translucent
const ParamTable& transformParams();
const ParamTable& pointLightParams();
const ParamTable& distantLightParams();
const ParamTable& spotLightParams();
const ParamTable& projectorParams(); ///< the rest of a spot light with a picture
const ParamTable& areaLightParams();
const ParamTable& environmentParams();
const ParamTable& cameraParams();
const ParamTable& viewParams();
const ParamTable& qualityParams();

/// Spelling of an AOV on the command line and in files: "color", "d", "visibility", ...
std::span<const std::string_view> aovNames();

/// Every parameter of a scene bound to its value, in the order of the panel.
///
/// Also what is computed from the material of objects that scatter (Translucency.h): it is as the material
/// was when it was bound, and no part of a scene file.
///
/// The pointers stay valid while the scene's vectors keep their size. Of a camera's height and field of view
/// only the one in use is bound, and of a material what its kind has and what chooses the kind. A wave
/// without amplitude and the time of a scene in which nothing moves are bound but not shown. Attributes
/// address the first light and the first object; others are set by path.
std::vector<BoundParam> bindParams(Scene& scene);

/// True where the picture depends on View::time: water, a wave, an animation.
bool moves(const Object& object);

/// Whether what its body does with light is worked out once, as its material asks for: a body that keeps its
/// shape, with no paint but on what leaves.
bool isPrecomputed(const Object& object);

/// What no single range can say: the camera looks somewhere, a direction has a length, a torus has a hole or
/// a dent. Error "KEY is X; must...".
Status check(const Camera& camera);
Status check(const Light& light);
Status check(const Shape& shape);
Status check(const Material& material);
Status check(const Wave& wave);

/// Sets one parameter by its path ("objects.coin.material.specularity"; objects by name or number, lights by
/// number). On error the scene is unchanged and the message names the path, what was found and expected, and
/// for an unknown path the nearest one that exists.
Status setParam(Scene& scene, std::string_view path, std::string_view value);

} // namespace lucent::scene
