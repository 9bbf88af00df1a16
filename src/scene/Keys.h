#pragma once
/// Every key of a scene file, declared once: the loader checks against these lists, the schema is written
/// from them. Keys that are parameters come from their tables; the rest stands here.

#include "base/Param.h"

#include <span>
#include <string_view>
#include <vector>

namespace lucent::scene {

/// What may stand under a key that is no parameter.
enum class KeyType {
    Constant, ///< one value only
    Text,
    Name,    ///< text without dots
    File,    ///< name of a file
    Toggle,  ///< true unless it says false
    Size,    ///< two integers in [1, kMaxPictureSide]
    Content, ///< objects and lists with keys of their own
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

const KeySet& sceneKeys();
const KeySet& cameraKeys();
const KeySet& viewKeys();
const KeySet& environmentKeys();
const KeySet& pointLightKeys();
const KeySet& distantLightKeys();
const KeySet& objectKeys();
const KeySet& shapeKeys();
const KeySet& materialKeys();
const KeySet& transformKeys();
const KeySet& qualityKeys();

inline constexpr int kMaxPictureSide = 8192; ///< pixels, of `size`

} // namespace lucent::scene
