#include "graph/Texture.h"

#include "graph/Device.h"

namespace lucent::graph {

namespace {
struct FormatInfo {
    const char* name;
    int bytes;
    Kind kind;
};
constexpr FormatInfo kFormats[] = {
    {"R8", 1, Kind::Fraction},   {"RGBA8", 4, Kind::Fraction}, {"SRGBA8", 4, Kind::Fraction},
    {"R16F", 2, Kind::Half},     {"RG16F", 4, Kind::Half},     {"RGBA16F", 8, Kind::Half},
    {"R32F", 4, Kind::Float},    {"RG32F", 8, Kind::Float},    {"RGBA32F", 16, Kind::Float},
    {"R32UI", 4, Kind::Integer}, {"RG32UI", 8, Kind::Integer}, {"RGBA32UI", 16, Kind::Integer},
    {"Depth24", 4, Kind::Depth}, {"Depth32F", 4, Kind::Depth}, {"Depth32FStencil8", 8, Kind::Depth},
};
static_assert(std::size(kFormats) == std::size_t(Format::Depth32FStencil8) + 1);
} // namespace

const char* name(Format format) { return kFormats[int(format)].name; }
int bytesPerTexel(Format format) { return kFormats[int(format)].bytes; }
Kind kindOf(Format format) { return kFormats[int(format)].kind; }

std::size_t TextureDesc::bytes() const {
    std::size_t texels = 0;
    for (int level = 0; level < levels; ++level)
        texels += std::size_t(sizeOf(level).x) * sizeOf(level).y;
    return texels * layers * bytesPerTexel(format);
}

std::string TextureDesc::text() const {
    return std::to_string(size.x) + "x" + std::to_string(size.y) +
           (layers > 1 ? "x" + std::to_string(layers) : "") + " " + name(format);
}

Texture::Texture(Device& device, const TextureDesc& desc, std::string label)
    : device_(&device), handle_(device.createTexture(desc, label)), desc_(desc), label_(std::move(label)) {}

Texture::~Texture() {
    if (handle_ != TextureHandle::None) device_->destroyTexture(handle_);
}

Indices::Indices(Device& device, std::span<const std::uint32_t> indices, std::string_view label)
    : device_(&device), handle_(device.createIndices(indices, label)), count_(int(indices.size())) {}

Indices::~Indices() {
    if (handle_ != IndicesHandle::None) device_->destroyIndices(handle_);
}

} // namespace lucent::graph
