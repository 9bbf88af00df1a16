#pragma once
/// Textures and index buffers as descriptors and handles. The device behind a handle is GL, or a fake one in
/// tests.

#include "base/Math.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace lucent::graph {

using glm::uvec4;

enum class Format : std::uint8_t {
    R8,
    RGBA8,
    SRGBA8, ///< colours as sRGB has them; read as linear light
    R16F,
    RG16F,
    RGBA16F,
    R32F,
    RG32F,
    RGBA32F,
    R32UI,
    RG32UI,
    RGBA32UI,
    Depth24,
    Depth32F,
    Depth32FStencil8, ///< counts fragments beside (Stencil)
};

/// What a texel holds: it decides how a format is cleared, blended and read back.
enum class Kind : std::uint8_t { Fraction, Half, Float, Integer, Depth };

const char* name(Format format);
int bytesPerTexel(Format format);
Kind kindOf(Format format);

/// What a texture is. Every texture clamps at its edges.
struct TextureDesc {
    ivec2 size{0};
    Format format = Format::RGBA8;
    int levels = 1;      ///< mip levels; level sizes are halved and rounded down
    int layers = 1;      ///< 1: sampler2D in shaders; more: sampler2DArray
    bool linear = false; ///< filtered between texels; float formats only after asking Caps
    bool operator==(const TextureDesc&) const = default;

    ivec2 sizeOf(int level) const { return glm::max(size >> level, ivec2(1)); }
    std::size_t bytes() const;
    std::string text() const; ///< "64x32x3 RGBA16F"; the layers only where there are several
};

enum class TextureHandle : std::uint32_t {
    None = 0,
    Screen = 0xffffffffu, ///< the default framebuffer
};

enum class IndicesHandle : std::uint32_t { None = 0 };

class Device;

/// Owns one texture of a device.
class Texture {
public:
    Texture() = default;
    Texture(Device& device, const TextureDesc& desc, std::string label);
    Texture(Texture&& other) noexcept { swap(other); }
    Texture& operator=(Texture&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Texture();

    TextureHandle handle() const { return handle_; }
    const TextureDesc& desc() const { return desc_; }
    const std::string& label() const { return label_; }
    explicit operator bool() const { return handle_ != TextureHandle::None; }

private:
    void swap(Texture& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        std::swap(desc_, other.desc_);
        std::swap(label_, other.label_);
    }
    Device* device_ = nullptr;
    TextureHandle handle_ = TextureHandle::None;
    TextureDesc desc_;
    std::string label_;
};

/// Owns one index buffer of a device: which vertices, in which order, make up the triangles of a mesh.
class Indices {
public:
    Indices() = default;
    Indices(Device& device, std::span<const std::uint32_t> indices, std::string_view label);
    Indices(Indices&& other) noexcept { swap(other); }
    Indices& operator=(Indices&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Indices();

    IndicesHandle handle() const { return handle_; }
    int count() const { return count_; }
    explicit operator bool() const { return handle_ != IndicesHandle::None; }

private:
    void swap(Indices& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        std::swap(count_, other.count_);
    }
    Device* device_ = nullptr;
    IndicesHandle handle_ = IndicesHandle::None;
    int count_ = 0;
};

} // namespace lucent::graph
