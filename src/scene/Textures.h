#pragma once
/// Pictures on the surfaces of meshes, as their files bring them.

#include "base/Image.h"

#include <cstdint>
#include <string>
#include <vector>

namespace lucent::scene {

/// Longest side of such a picture, texels: larger ones are made smaller as they are read.
inline constexpr int kMostTextureSide = 2048;

/// A picture as files hold it, 8 bits a channel: a quarter of what floats would take.
struct TextureImage {
    ivec2 size{0};
    Encoding encoding = Encoding::Linear; ///< of red, green and blue
    /// RGBA, row by row, row 0 at v = 0; of a picture whose texels lie elsewhere a single byte, the number of
    /// their file.
    std::vector<std::uint8_t> texels;
    float leastGreen = 1; ///< as texel() gives it; findLeast() sets it

    void findLeast();
    bool isElsewhere() const { return texels.size() == 1; }
    /// In linear light, alpha as it is.
    vec4 texel(ivec2 at) const;
};

/// How a picture goes on outside of [0,1].
enum class Wrap : std::uint8_t { Repeat, Clamp, Mirror };

/// Where a picture is put: by one of the mesh's sets of coordinates, bilinear between its texels.
struct TextureUse {
    std::int32_t image = -1; ///< in Mesh::images; -1: none
    Wrap u = Wrap::Repeat, v = Wrap::Repeat;
    bool second = false; ///< by Mesh::secondCoordinates, else by Mesh::coordinates
    bool operator==(const TextureUse&) const = default;
};

/// Pictures that belong to a material, as glTF 2.0 has them (3.9).
struct Textures {
    TextureUse color;      ///< multiplies Material::diffuse
    TextureUse emission;   ///< multiplies Material::base
    TextureUse roughness;  ///< of Glossy: green multiplies its roughness, blue its share of metal
    TextureUse normal;     ///< 2 c - 1: x along u, y against v, z outwards; then unit
    float normalScale = 1; ///< of x and y
    /// Where the colour's alpha is below, nothing is there; 0: all is. Below 0 alpha, times minus this, is
    /// the share that is there.
    float cutoff = 0;
    bool vertexColors = false; ///< Mesh::colors multiply Material::diffuse as well

    bool isBlended() const { return cutoff < 0; } ///< whether alpha is an opacity: glTF's BLEND
    bool hasHoles() const { return isBlended() || (cutoff > 0 && color.image >= 0); }
    /// The share of a place that is there, [0,1], by its alpha.
    double opacity(double alpha) const {
        return isBlended() ? alpha * -double(cutoff) : alpha >= double(cutoff) ? 1 : 0;
    }
    bool hasImages() const {
        return color.image >= 0 || emission.image >= 0 || roughness.image >= 0 || normal.image >= 0;
    }
    bool any() const { return hasImages() || vertexColors || hasHoles(); }
    bool operator==(const Textures&) const = default;
};

/// What decodeTexture() takes in place of a picture that was decoded by another: its size, and the number of
/// the file in which its texels lie. Anything may follow it, as where it was written over that picture.
Bytes standInFor(ivec2 size, std::uint8_t number);

/// Decodes PNG or JPEG, and averages what is larger than kMostTextureSide, which it says.
///
/// @param name  used in messages only
/// @return      Error "NAME: what was found; what was expected"
Result<TextureImage> decodeTexture(std::span<const std::byte> bytes, const std::string& name,
                                   Encoding encoding);

} // namespace lucent::scene
