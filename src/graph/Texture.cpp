#include "graph/Texture.h"

#include "graph/Device.h"

#include <algorithm>

namespace lucent::graph {

namespace {
struct FormatInfo {
    const char* name;
    int bytes;
};
constexpr FormatInfo kFormats[] = {
    {"R8", 1}, {"RGBA8", 4}, {"R32F", 4}, {"R32UI", 4}, {"RGBA16F", 8}, {"RGBA32F", 16}, {"Depth24", 4},
};
} // namespace

const char* name(Format format) { return kFormats[int(format)].name; }
int bytesPerTexel(Format format) { return kFormats[int(format)].bytes; }

std::size_t TextureDesc::bytes() const {
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level)
        texels += std::size_t(std::max(size.x >> level, 1)) * std::max(size.y >> level, 1);
    return texels * bytesPerTexel(format);
}

Texture::Texture(Device& device, const TextureDesc& desc, std::string label)
    : device_(&device), handle_(device.createTexture(desc, label)), desc_(desc), label_(std::move(label)) {}

Texture::~Texture() {
    if (handle_ != TextureHandle::None) device_->destroyTexture(handle_);
}

} // namespace lucent::graph
