#include "scene/Keys.h"

#include "scene/Scene.h"

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
constexpr Key kObject[] = {
    {"name", KeyType::Name, "Unique name without dots; its number when left out."},
    {"shape", KeyType::Content, "Its surface."},
    {"material", KeyType::Content, "What the surface does with light."},
    {"transform", KeyType::Content, "Where the object stands: scaled, turned, then moved."},
    {"visible", KeyType::Toggle, "False hides it from the camera only."},
};
constexpr Key kShape[] = {
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
constexpr Key kMaterial[] = {
    {"baseMap", KeyType::File, "Picture that multiplies the base colour."},
    {"diffuseMap", KeyType::File, "Picture that multiplies the diffuse colour."},
    {"specularMap", KeyType::File, "Picture that multiplies the specular colour."},
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

const KeySet& pointLightKeys() {
    static const KeySet keys{{&pointLightParams()}, kPoint};
    return keys;
}

const KeySet& distantLightKeys() {
    static const KeySet keys{{&distantLightParams()}, kDistant};
    return keys;
}

const KeySet& objectKeys() {
    static const KeySet keys{{}, kObject};
    return keys;
}

const KeySet& shapeKeys() {
    static const KeySet keys{{&heightFieldParams(), &heightSourceParams()}, kShape};
    return keys;
}

const KeySet& materialKeys() {
    static const KeySet keys{{&materialParams()}, kMaterial};
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
