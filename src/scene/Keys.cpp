#include "scene/Keys.h"

#include "scene/Displacement.h"
#include "scene/Painting.h"
#include "scene/Translucency.h"

#include <algorithm>
#include <cassert>

namespace lucent::scene {
namespace {

constexpr Key kScene[] = {
    {"lucent", KeyType::Constant, "Version of this format.", "1"},
    {"title", KeyType::Text, "Name of the scene."},
    {"caption", KeyType::Text, "What one sees."},
    {"size", KeyType::Size, "Width and height of the picture in pixels."},
    {"camera", KeyType::Content, "Where the picture is taken from."},
    {"view", KeyType::Content, "How the light becomes a picture."},
    {"environment", KeyType::Content, "Light from all around."},
    {"lights", KeyType::Content, "Lamps."},
    {"objects", KeyType::Content, "What is lit."},
    {"technique", KeyType::Content, "Settings of the techniques, by their names."},
    {"quality", KeyType::Content, "How exact the picture must be."},
};
constexpr Key kEnvironment[] = {
    {"source", KeyType::File,
     "rainbow, sky, uniform, direction, or a picture file (latitude and longitude)."},
};
constexpr Key kPoint[] = {{"type", KeyType::Constant, "A lamp at one place.", R"("point")"}};
constexpr Key kDistant[] = {
    {"type", KeyType::Constant, "Light that travels in one direction.", R"("distant")"}};
constexpr Key kSpot[] = {
    {"type", KeyType::Constant, "A lamp that shines into a cone.", R"("spot")"},
    {"image", KeyType::File, "Picture that it projects, with fov and roll; beside the picture it is dark."},
};
constexpr Key kArea[] = {
    {"type", KeyType::Constant, "A parallelogram that shines from one side.", R"("area")"}};
constexpr Key kObject[] = {
    {"name", KeyType::Name, "Unique name without dots; its number when left out."},
    {"shape", KeyType::Content, "Its surface."},
    {"material", KeyType::Content, "What the surface does with light."},
    {"transform", KeyType::Content, "Where the object stands: scaled, turned, then moved."},
    {"wave", KeyType::Content, "A wave that runs through it; not through height fields and water."},
    {"displacement", KeyType::Content,
     "Heights that lift the surface along its normals; of planes, spheres, tori and meshes that stand still "
     "and have texture coordinates."},
    {"paint", KeyType::Content, "What is painted on it, where its material scatters."},
    {"bake", KeyType::File, "What lucent bake wrote for it, where its material is precomputed."},
    {"visible", KeyType::Toggle, "False hides it from the camera only."},
};
constexpr Key kHeightField[] = {
    {"type", KeyType::Constant, "A field of heights over a rectangle, facing +z.", R"("heightfield")"},
    {"heights", KeyType::File,
     "Picture of heights: the first channel of one or two, else the mean of red, green, blue."},
    {"normalMap", KeyType::File,
     "Picture of normals (+y up), integrated; heightScale then defaults to the true range."},
    {"mesh", KeyType::File, "Mesh whose depth along -z becomes the heights."},
    {"resolution", KeyType::Size, "Texels of a mesh's depth, 512 x 512 when left out."},
    {"alpha", KeyType::File,
     "Mask of the picture: the alpha channel of two or four channels, else the mean; any size."},
    {"alphaIsSolid", KeyType::Toggle,
     "False makes a hole where alpha is below 0.5, as deep as the field is wide."},
};
constexpr std::span<const Key> kHeightSource = std::span(kHeightField).subspan(1, 4);
constexpr Key kMesh[] = {
    {"type", KeyType::Constant, "Triangles of a file.", R"("mesh")"},
    {"source", KeyType::File,
     "glTF, GLB or OBJ file. Without a material of its own the object becomes one object for each material "
     "of "
     "the file, called NAME/MATERIAL, with - for the dots of that name."},
    {"part", KeyType::Text, "Only the triangles of this material of the file."},
};
constexpr Key kPlane[] = {
    {"type", KeyType::Constant, "A rectangle in the xz plane, centred, facing +y.", R"("plane")"}};
constexpr Key kBox[] = {{"type", KeyType::Constant, "A block, centred.", R"("box")"}};
constexpr Key kSphere[] = {{"type", KeyType::Constant, "A sphere, centred.", R"("sphere")"}};
constexpr Key kTorus[] = {{"type", KeyType::Constant, "A tube around the y axis.", R"("torus")"}};
constexpr Key kCylinder[] = {
    {"type", KeyType::Constant, "A cylinder around the y axis, centred.", R"("cylinder")"}};
constexpr Key kWater[] = {{"type", KeyType::Constant,
                           "Water that obeys the wave equation, in the xz plane, centred, facing +y.",
                           R"("water")"}};
constexpr Key kMaterial[] = {
    {"preset", KeyType::Preset,
     "A measured material, for scattering, absorption and ior; keys beside it replace its values."},
    {"layers", KeyType::Content,
     "Layers of other media on top of what scatters, the top first; the profile multipole knows them."},
    {"baseMap", KeyType::File, "Picture that multiplies the base colour of a height field's relief."},
    {"diffuseMap", KeyType::File, "Picture that multiplies its diffuse colour."},
    {"specularMap", KeyType::File, "Picture that multiplies its specular colour."},
    {"table", KeyType::File, "Measured BRDF: a file of the MERL database, or a picture of its values."},
};
constexpr std::span<const Key> kOfTranslucent = std::span(kMaterial).first(2),
                               kMaps = std::span(kMaterial).subspan(2, 3),
                               kOfMeasured = std::span(kMaterial).subspan(5);
constexpr Key kLayer[] = {
    {"preset", KeyType::Preset,
     "A measured material, for scattering, absorption and ior; keys beside it replace its values."},
};

constexpr Key kPaint[] = {
    {"entering", KeyType::File,
     "Picture on the object's atlas, taken where light enters: red, green, blue multiply it, alpha sharpens "
     "(its "
     "inverse blurs)."},
    {"leaving", KeyType::File,
     "Picture as large, taken where light leaves: red, green, blue multiply it, alpha is the translucency; "
     "the rest "
     "is matt with the colour diffuse."},
    {"strokes", KeyType::Strokes, "Strokes on top of them: a file, or a list."},
};
constexpr Key kStroke[] = {
    {"value", KeyType::Coefficient,
     "Aimed at: translucency [0, 1] and blur [1/16, 16] take a number, glow and outgoing three; left out "
     "with erase."},
    {"dabs", KeyType::Content,
     "Touches of the brush, [x, y, z, normal x, y, z, pressure] each, in the object's space at rest."},
    {"fill", KeyType::Content,
     "Instead of dabs: all between low and high, whose numbers may be null for no bound; with veins, in m "
     "from one to the next, along veins of marble."},
};

} // namespace

std::vector<std::string_view> KeySet::ids() const {
    std::vector<std::string_view> list;
    for (const ParamTable* table : tables)
        for (const Param& param : table->params)
            list.push_back(param.id);
    for (const Key& key : keys)
        list.push_back(key.id);
    return list;
}

const KeySet& sceneKeys() {
    static const KeySet keys{{}, kScene};
    return keys;
}

const KeySet& cameraKeys() {
    static const KeySet keys{{&cameraParams()}, {}};
    return keys;
}

const KeySet& viewKeys() {
    static const KeySet keys{{&viewParams()}, {}};
    return keys;
}

const KeySet& environmentKeys() {
    static const KeySet keys{{&environmentParams()}, kEnvironment};
    return keys;
}

std::span<const TypeKeys> lightTypes() {
    static const TypeKeys types[] = {
        {"point", {{&pointLightParams()}, kPoint}},
        {"distant", {{&distantLightParams()}, kDistant}},
        {"spot", {{&spotLightParams(), &projectorParams()}, kSpot}},
        {"area", {{&areaLightParams()}, kArea}},
    };
    static_assert(std::size(types) == std::variant_size_v<Light>);
    return types;
}

std::span<const TypeKeys> shapeTypes() {
    static const TypeKeys types[] = {
        {"heightfield", {{&heightFieldParams(), &heightSourceParams()}, kHeightField}},
        {"mesh", {{&meshParams()}, kMesh}},
        {"plane", {{&planeParams()}, kPlane}},
        {"box", {{&boxParams()}, kBox}},
        {"sphere", {{&sphereParams()}, kSphere}},
        {"torus", {{&torusParams()}, kTorus}},
        {"cylinder", {{&cylinderParams()}, kCylinder}},
        {"water", {{&waterParams()}, kWater}},
    };
    static_assert(std::size(types) == std::variant_size_v<Shape>);
    return types;
}

const TypeKeys& typeOf(const Shape& shape) { return shapeTypes()[shape.index()]; }
const TypeKeys& typeOf(const Light& light) { return lightTypes()[light.index()]; }

const KeySet& objectKeys() {
    static const KeySet keys{{}, kObject};
    return keys;
}

namespace {

// The last one is translucent and painted.
std::span<const TypeKeys> materialKindsAndPainted() {
    static const TypeKeys kinds[] = {
        {"relief", {{&colorParams(), &reliefParams()}, kMaps}},
        {"matt", {{&colorParams()}, {}}},
        {"mirror", {{&mirrorParams()}, {}}},
        {"clear", {{&clearParams(), &attenuationParams()}, {}}},
        {"translucent", {{&translucentParams(), &attenuationParams()}, kOfTranslucent}},
        {"glossy", {{&colorParams(), &glossyParams()}, {}}},
        {"phong", {{&colorParams(), &phongParams()}, {}}},
        {"blinn", {{&colorParams(), &blinnParams()}, {}}},
        {"cook-torrance", {{&colorParams(), &cookTorranceParams()}, {}}},
        {"oren-nayar", {{&colorParams(), &orenNayarParams()}, {}}},
        {"measured", {{&measuredParams()}, kOfMeasured}},
        {"painted translucent",
         {{&translucentParams(), &attenuationParams(), &colorParams()}, kOfTranslucent}},
    };
    static_assert(std::size(kinds) == std::variant_size_v<MaterialKinds> + 1);
    return kinds;
}

bool holds(const KeySet& keys, std::string_view key) {
    const std::vector<std::string_view> ids = keys.ids();
    return std::find(ids.begin(), ids.end(), key) != ids.end();
}

// Those that stand in no file but may be set as well.
bool holdsWords(const TypeKeys& kind, std::string_view key) {
    return kind.type.ends_with("translucent") && holds({{&translucencyParams()}, {}}, key);
}

} // namespace

std::span<const TypeKeys> materialKinds() {
    return materialKindsAndPainted().first(std::variant_size_v<MaterialKinds>);
}

const KeySet& materialKeys() {
    static const KeySet keys{{&choiceParams(), &colorParams(), &reliefParams(), &clearParams(),
                              &attenuationParams(), &translucentParams(), &glossyParams(), &phongParams(),
                              &blinnParams(), &cookTorranceParams(), &orenNayarParams(), &measuredParams()},
                             kMaterial};
    return keys;
}

const KeySet& materialKeysOf(const Object& object) {
    const bool painted = object.painting && object.material.isScattering();
    const auto kinds = materialKindsAndPainted();
    return (painted ? kinds.back() : kinds[object.material.kind.index()]).keys;
}

void* structOf(Material& material, const ParamTable& table) {
    assert(&table != &attenuationParams());
    return &table == &colorParams() ? static_cast<void*>(&material) : dataOf(material.kind);
}
const void* structOf(const Material& material, const ParamTable& table) {
    return structOf(const_cast<Material&>(material), table);
}

std::string whyIdle(const Object& object, std::string_view key) {
    const bool isHeightField = std::holds_alternative<HeightField>(object.shape);
    if (key == "wave" && (isHeightField || std::holds_alternative<Water>(object.shape)))
        return " does nothing on height fields and water; must stand on another shape";
    if (key == "paint" && isHeightField)
        return " does nothing on a height field; must stand on another shape";
    if ((key == "wave" || key == "paint") && object.displacement)
        return " does nothing on a displaced surface; must stand without displacement";
    const bool canBeDisplaced =
        std::holds_alternative<Plane>(object.shape) || std::holds_alternative<Sphere>(object.shape) ||
        std::holds_alternative<Torus>(object.shape) || std::holds_alternative<MeshShape>(object.shape);
    if (key == "displacement" && !canBeDisplaced)
        return " does nothing on a " + std::string(typeOf(object.shape).type) +
               "; must stand on a plane, sphere, torus or mesh";
    if (key == "displacement") return {};
    if (key.starts_with("layers.")) key = "layers";
    if (holds({{&choiceParams()}, {}}, key) || holds(materialKeysOf(object), key)) return {};
    std::vector<std::string_view> others;
    for (const TypeKeys& kind : materialKindsAndPainted())
        if (holds(kind.keys, key) || holdsWords(kind, key)) others.push_back(kind.type);
    if (others.empty()) return {}; // no key of any
    if (std::find(others.begin(), others.end(), "translucent") != others.end())
        std::erase(others, "painted translucent");
    std::string list;
    for (std::size_t i = 0; i < others.size(); ++i)
        (list += i == 0 ? "" : i + 1 == others.size() ? " or " : ", ") += others[i];
    return " is no key of a " + std::string(materialKinds()[object.material.kind.index()].type) +
           " material; must stand in a " + list + " one";
}

const KeySet& layerKeys() {
    static const KeySet keys{{&layerParams()}, kLayer};
    return keys;
}

const KeySet& waveKeys() {
    static const KeySet keys{{&waveParams()}, {}};
    return keys;
}

const KeySet& displacementKeys() {
    static const KeySet keys{{&displacementParams(), &heightSourceParams()}, kHeightSource};
    return keys;
}

const KeySet& paintKeys() {
    static const Param params[] = {declare(&PaintSource::side, {.id = "side",
                                                                .label = "Side",
                                                                .unit = "texels",
                                                                .min = kLeastPaintSide,
                                                                .max = kMostPaintSide,
                                                                .doc = "Of the maps that strokes paint."})};
    static const ParamTable table = tableOf<PaintSource>("paint", params);
    static const KeySet keys{{&table}, kPaint};
    return keys;
}

const KeySet& strokeKeys() {
    static const KeySet keys{{&brushParams()}, kStroke};
    return keys;
}

const KeySet& transformKeys() {
    static const KeySet keys{{&transformParams()}, {}};
    return keys;
}

const KeySet& qualityKeys() {
    static const KeySet keys{{&qualityParams()}, {}};
    return keys;
}

} // namespace lucent::scene
