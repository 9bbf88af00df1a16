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
const KeySet& materialKeys();
const KeySet& layerKeys();
const KeySet& transformKeys();
const KeySet& waveKeys();
const KeySet& qualityKeys();
const KeySet& paintKeys();  ///< of an object's "paint"
const KeySet& strokeKeys(); ///< of one stroke

/// The struct that a shape or light holds, as the tables address it.
template <class Variant>
auto dataOf(Variant& variant) {
    using Void = std::conditional_t<std::is_const_v<Variant>, const void, void>;
    return std::visit([](auto& value) -> Void* { return &value; }, variant);
}

/// Why a key of the material, or "wave", changes nothing about this object: " does nothing on ...; must stand
/// on ...". Empty where it acts. Such keys are refused in files, not bound and not written.
std::string whyIdle(const Object& object, std::string_view key);
/// The material's tables that act on this object, in the order of materialKeys().
std::vector<const ParamTable*> materialTables(const Object& object);

inline constexpr int kMaxPictureSide = 8192; ///< pixels, of `size`
/// Places and directions in metres: far enough for a sun, near enough that squares stay finite in floats.
inline constexpr double kFar = 1e9;
inline constexpr double kLargest = 1e6; ///< m, of a shape

} // namespace lucent::scene
