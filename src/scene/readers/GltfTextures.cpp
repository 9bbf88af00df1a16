#include "scene/readers/GltfTextures.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lucent::scene {
namespace {

constexpr const char* kTransform = "KHR_texture_transform";

// One of a material's textures, of whichever of tinygltf's kinds.
struct Texture {
    int index = -1;
    TextureMapping mapping;
};

double numberIn(const tinygltf::Value& object, const char* key, int place, double otherwise) {
    if (!object.Has(key)) return otherwise;
    const tinygltf::Value& value = object.Get(key);
    if (value.IsNumber()) return value.GetNumberAsDouble();
    return place < int(value.ArrayLen()) ? value.Get(place).GetNumberAsDouble() : otherwise;
}

// KHR_texture_transform: translation * rotation * scale, of counter-clockwise angles where v points down.
Texture textureOf(const auto& info) {
    Texture texture{info.index, {info.texCoord, glm::dmat3(1)}};
    const auto found = info.extensions.find(kTransform);
    if (found == info.extensions.end()) return texture;
    const tinygltf::Value& transform = found->second;
    const auto at = [&](const char* key, int place, double otherwise) {
        return numberIn(transform, key, place, otherwise);
    };
    const double angle = at("rotation", 0, 0), c = std::cos(angle), s = std::sin(angle);
    const dvec2 scale(at("scale", 0, 1), at("scale", 1, 1));
    texture.mapping.set = int(at("texCoord", 0, texture.mapping.set));
    texture.mapping.textureFromVertex = glm::dmat3(c * scale.x, -s * scale.x, 0, s * scale.y, c * scale.y, 0,
                                                   at("offset", 0, 0), at("offset", 1, 0), 1);
    return texture;
}

Wrap wrapOf(int mode) {
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::Clamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::Mirror
                                                           : Wrap::Repeat;
}

int hexDigit(char c) {
    const std::string_view digits = "0123456789abcdef";
    const std::size_t place = digits.find(char(c | 0x20));
    return place == digits.npos ? -1 : int(place);
}

} // namespace

float cutoffOf(const tinygltf::Material& material) {
    if (material.alphaMode == "OPAQUE") return 0;
    const auto& factor = material.pbrMetallicRoughness.baseColorFactor;
    const double alpha = factor.size() == 4 ? factor[3] : 1;
    if (material.alphaMode == "MASK")
        return float(std::min(material.alphaCutoff / std::max(alpha, 1e-3), 2.0)); // no alpha reaches 2
    const bool isWhole = alpha >= 1 && material.pbrMetallicRoughness.baseColorTexture.index < 0;
    return isWhole ? 0.0f : -float(std::clamp(alpha, 1e-3, 1.0));
}

std::string decodedUri(const std::string& uri) {
    std::string name;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool coded =
            uri[i] == '%' && i + 2 < uri.size() && hexDigit(uri[i + 1]) >= 0 && hexDigit(uri[i + 2]) >= 0;
        name += coded ? char(hexDigit(uri[i + 1]) * 16 + hexDigit(uri[i + 2])) : uri[i];
        i += coded ? 2 : 0;
    }
    return name;
}

std::vector<TextureMapping> GltfTextures::mappingsOf(const tinygltf::Material& material) const {
    const auto& pbr = material.pbrMetallicRoughness;
    std::vector<TextureMapping> mappings;
    for (const Texture& one : {textureOf(pbr.baseColorTexture), textureOf(pbr.metallicRoughnessTexture),
                               textureOf(material.normalTexture), textureOf(material.emissiveTexture)})
        if (one.index >= 0 && std::find(mappings.begin(), mappings.end(), one.mapping) == mappings.end() &&
            mappings.size() < kMostMappings)
            mappings.push_back(one.mapping);
    return mappings;
}

Textures GltfTextures::texturesOf(const tinygltf::Material& material) {
    const auto& pbr = material.pbrMetallicRoughness;
    const std::vector<TextureMapping> mappings = mappingsOf(material);
    const auto use = [&](const char* name, const auto& info, Encoding encoding) {
        const Texture texture = textureOf(info);
        if (texture.index < 0) return TextureUse{};
        const auto found = std::find(mappings.begin(), mappings.end(), texture.mapping);
        if (found == mappings.end()) {
            unread_.insert(std::string(name) + ", which has a third set of coordinates");
            return TextureUse{};
        }
        TextureUse taken = useOf(texture.index, encoding);
        taken.second = found != mappings.begin();
        return taken;
    };
    return {.color = use("baseColorTexture", pbr.baseColorTexture, Encoding::Srgb),
            .emission = use("emissiveTexture", material.emissiveTexture, Encoding::Srgb),
            .roughness = use("metallicRoughnessTexture", pbr.metallicRoughnessTexture, Encoding::Linear),
            .normal = use("normalTexture", material.normalTexture, Encoding::Linear),
            .normalScale = float(material.normalTexture.scale),
            .cutoff = cutoffOf(material)};
}

TextureUse GltfTextures::useOf(int index, Encoding encoding) {
    const tinygltf::Texture* texture = element(model_.textures, index);
    if (!texture) return {};
    const tinygltf::Sampler* sampler = element(model_.samplers, texture->sampler);
    return {.image = imageOf(texture->source, encoding),
            .u = sampler ? wrapOf(sampler->wrapS) : Wrap::Repeat,
            .v = sampler ? wrapOf(sampler->wrapT) : Wrap::Repeat};
}

int GltfTextures::imageOf(int source, Encoding encoding) {
    const auto [known, isNew] = known_.emplace(std::pair(source, encoding), -1);
    if (!isNew) return known->second;
    const std::string name = name_ + ": picture " + std::to_string(source);
    const Result<Bytes> bytes = bytesOf(source);
    Result<TextureImage> image =
        bytes ? decodeTexture(*bytes, name, encoding) : Result<TextureImage>(bytes.error());
    if (!image) {
        unread_.insert("a texture (" + image.error().message + ")");
        return -1;
    }
    images_.push_back(std::make_shared<const TextureImage>(std::move(*image)));
    return known->second = int(images_.size()) - 1;
}

Result<Bytes> GltfTextures::bytesOf(int source) const {
    const tinygltf::Image* image = element(model_.images, source);
    if (!image) return Error{"picture " + std::to_string(source) + " does not exist"};
    if (!image->image.empty()) {
        const auto content = std::as_bytes(std::span(image->image));
        return Bytes(content.begin(), content.end());
    }
    return read_(resolvePath(name_, decodedUri(image->uri)));
}

} // namespace lucent::scene
