#pragma once
/// The textures of a glTF file: which pictures its materials put on meshes, and where.

#include "base/File.h"
#include "scene/Textures.h"
#include "scene/readers/TinyGltf.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace lucent::scene {

/// Coordinates that the textures of one material lie by.
struct TextureMapping {
    int set = 0; ///< of TEXCOORD_n
    glm::dmat3 textureFromVertex{1};
    bool operator==(const TextureMapping&) const = default;
};

/// A mesh has so many sets of coordinates.
inline constexpr std::size_t kMostMappings = 2;

/// Textures::cutoff by a material's own alpha.
float cutoffOf(const tinygltf::Material& material);

/// Takes the textures of one material after the other, and decodes each picture that they use once.
class GltfTextures {
public:
    /// @param read    gives pictures beside `name`
    /// @param unread  takes the names of what was found and not read
    GltfTextures(const tinygltf::Model& model, const std::string& name, const ReadFile& read,
                 std::set<std::string>& unread)
        : model_(model), name_(name), read_(read), unread_(unread) {}

    /// The coordinates of a material: those of the first of its textures (base colour, metallic-roughness,
    /// normal, emission) and of the first that lies elsewhere; at most kMostMappings.
    std::vector<TextureMapping> mappingsOf(const tinygltf::Material& material) const;
    /// Of a material; what lies by further coordinates and pictures that cannot be read are left out, and
    /// named.
    Textures texturesOf(const tinygltf::Material& material);
    /// What all textures taken so far refer to.
    std::vector<std::shared_ptr<const TextureImage>> takeImages() { return std::move(images_); }

private:
    TextureUse useOf(int texture, Encoding encoding);
    int imageOf(int source, Encoding encoding);
    Result<Bytes> bytesOf(int source) const;

    const tinygltf::Model& model_;
    const std::string& name_;
    const ReadFile& read_;
    std::set<std::string>& unread_;
    std::map<std::pair<int, Encoding>, int> known_; // places in images_; -1: cannot be read
    std::vector<std::shared_ptr<const TextureImage>> images_;
};

/// A URI names a file as a URL does: %20 is a blank.
std::string decodedUri(const std::string& uri);

} // namespace lucent::scene
