#pragma once
/// Every key of a scene file, declared once: the loader checks against these lists, the schema is written
/// from them. Keys that are parameters come from their tables; the rest stands here.

#include "base/Param.h"
#include "scene/Scene.h"

#include <span>
#include <string_view>
#include <vector>

namespace lucent::scene {

/// What may stand under a key that is no parameter.
enum class KeyType {
    Constant, ///< one value only
    Text,
    Name,        ///< text without dots
    File,        ///< name of a file
    Toggle,      ///< true unless it says false
    Size,        ///< two integers in [1, kMaxPictureSide]
    Preset,      ///< name of a measured material
    Strokes,     ///< name of a file, or what stands in it
    Coefficient, ///< one number in [0, kFar], or three for red, green and blue
    Content,     ///< objects and lists with keys of their own
};

/// A key that is no parameter.
struct Key {
    std::string_view id;
    KeyType type;
    std::string_view doc;
    std::string_view constant = ""; ///< as JSON
};

/// Parameters and other keys that may stand in one kind of object of the file.
struct KeySet {
    std::vector<const ParamTable*> tables;
    std::span<const Key> keys;

    /// Names of all keys.
    std::vector<std::string_view> ids() const;
};

/// One kind of shape or light: what stands under "type", and its keys. The first table is that of the struct.
struct TypeKeys {
    std::string_view type;
    KeySet keys;
};

/// In the order of the variants Shape and Light.
std::span<const TypeKeys> shapeTypes();
std::span<const TypeKeys> lightTypes();
const TypeKeys& typeOf(const Shape& shape);
const TypeKeys& typeOf(const Light& light);

const KeySet& sceneKeys();
const KeySet& cameraKeys();
const KeySet& viewKeys();
const KeySet& environmentKeys();
const KeySet& objectKeys();
const KeySet& materialKeys(); ///< of all kinds together
const KeySet& layerKeys();
const KeySet& transformKeys();
const KeySet& waveKeys();
const KeySet& displacementKeys();
const KeySet& qualityKeys();
const KeySet& paintKeys();  ///< of an object's "paint"
const KeySet& strokeKeys(); ///< of one stroke

/// The kinds of a material, in the order of MaterialKinds. "kind" and what else chooses one may stand in all.
std::span<const TypeKeys> materialKinds();
/// Those of an object's material: of a translucent one with the colours where it is painted.
const KeySet& materialKeysOf(const Object& object);
/// The struct that a table of materialKeysOf() addresses; of attenuationParams() none.
void* structOf(Material& material, const ParamTable& table);
const void* structOf(const Material& material, const ParamTable& table);

enum class MaterialKind : int {
    Relief,
    Matt,
    Mirror,
    Clear,
    Translucent,
    Glossy,
    Phong,
    Blinn,
    CookTorrance,
    OrenNayar,
    Measured
};
/// What a material is by its keys. Each of the numbers makes it the kind that has it; 0 of other kinds.
struct KindChoice {
    MaterialKind kind = MaterialKind::Matt;
    vec3 reflectance{0};
    float transmission = 0;
    vec3 scattering{0};
};
const ParamTable& choiceParams();
KindChoice choiceOf(const Material& material);
/// Makes the material what one member says: of another kind with that kind's defaults. Zeros change nothing.
Status store(const KindChoice& wanted, std::string_view id, Material& material);
/// What a shape's material is where nothing is said.
MaterialKind ownKind(const Shape& shape);

/// Absorption as glTF spells it: what is left of white after a distance; 0: nothing is absorbed.
struct Attenuation {
    float distance = 0; ///< m
    vec3 color{1};
};
const ParamTable& attenuationParams();
/// @param absorption  1/m
/// @param distance    m; 0: where half of one colour is left
Attenuation attenuationOf(vec3 absorption, float distance);
vec3 absorptionOf(const Attenuation& attenuation); ///< 1/m
/// Makes a clear or translucent material absorb so.
Status store(const Attenuation& wanted, std::string_view id, Material& material);
/// Absorption [1/m] and the distance at which it is spoken of, of what is clear or translucent; else null.
struct Absorbing {
    vec3* absorption = nullptr;
    float* distance = nullptr;
};
Absorbing absorbing(Material& material);

/// A default-constructed struct of the variant's list.
template <class Variant, std::size_t first = 0>
Variant alternative(std::size_t index) {
    if constexpr (first + 1 < std::variant_size_v<Variant>)
        if (index != first) return alternative<Variant, first + 1>(index);
    return Variant(std::in_place_index<first>);
}

/// The struct that a shape or light holds, as the tables address it.
template <class Variant>
auto dataOf(Variant& variant) {
    using Void = std::conditional_t<std::is_const_v<Variant>, const void, void>;
    return std::visit([](auto& value) -> Void* { return &value; }, variant);
}

/// Why a key of the material is none of its kind, or "wave", "paint" or "displacement" none of the shape: "
/// is no key of ...; must stand ...". Empty where it may stand. Such keys are refused in files, not bound and
/// not written.
std::string whyIdle(const Object& object, std::string_view key);

inline constexpr int kMaxPictureSide = 8192; ///< pixels, of `size`
/// Places and directions in metres: far enough for a sun, near enough that squares stay finite in floats.
inline constexpr double kFar = 1e9;
inline constexpr double kLargest = 1e6; ///< m, of a shape

} // namespace lucent::scene
