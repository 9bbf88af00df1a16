#pragma once
/// Textures as descriptors and handles. The device behind a handle is GL, or a fake one in tests.

#include "base/Math.h"

#include <cstddef>
#include <cstdint>
#include <string>

namespace lucent::graph {

enum class Format : std::uint8_t { R8, RGBA8, R32F, R32UI, RGBA16F, RGBA32F, Depth24 };
const char* name(Format format);
int bytesPerTexel(Format format);

/// What a texture is. Every texture clamps at its edges.
struct TextureDesc {
    ivec2 size{0};
    Format format = Format::RGBA8;
    int levels = 1;      ///< mip levels; level sizes are halved and rounded down
    bool linear = false; ///< filtered between texels; float formats only after asking Caps
    bool operator==(const TextureDesc&) const = default;

    std::size_t bytes() const;
};

enum class TextureHandle : std::uint32_t {
    None = 0,
    Screen = 0xffffffffu, ///< the default framebuffer
};

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

} // namespace lucent::graph
