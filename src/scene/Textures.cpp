#include "scene/Textures.h"

#include "base/Log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace lucent::scene {
namespace {

float lightOf(std::uint8_t value, Encoding encoding) {
    static const std::array<float, 256> kFromSrgb = [] {
        std::array<float, 256> table{};
        for (std::size_t i = 0; i < table.size(); ++i)
            table[i] = linearFromSrgb(float(i) / 255);
        return table;
    }();
    return encoding == Encoding::Srgb ? kFromSrgb[value] : float(value) / 255;
}

std::uint8_t valueOf(float light, Encoding encoding) {
    const float code = encoding == Encoding::Srgb ? srgbFromLinear(light) : light;
    return std::uint8_t(std::lround(255 * std::clamp(code, 0.0f, 1.0f)));
}

// The mean of each 2 x 2 texels, in linear light; an odd one at the end is its own neighbour.
TextureImage halved(const TextureImage& fine) {
    TextureImage half;
    half.size = (fine.size + 1) / 2;
    half.encoding = fine.encoding;
    half.texels.reserve(std::size_t(4) * std::size_t(half.size.x) * std::size_t(half.size.y));
    for (int y = 0; y < half.size.y; ++y)
        for (int x = 0; x < half.size.x; ++x) {
            vec4 sum(0);
            for (const ivec2 beside : {ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1)})
                sum += fine.texel(glm::min(2 * ivec2(x, y) + beside, fine.size - 1));
            for (int c = 0; c < 4; ++c)
                half.texels.push_back(valueOf(sum[c] / 4, c < 3 ? fine.encoding : Encoding::Linear));
        }
    return half;
}

constexpr std::string_view kStandIn = "LUCENTT1"; // two sides and a number follow
constexpr std::size_t kSideBytes = sizeof(std::int32_t);

constexpr std::size_t kStandInBytes = kStandIn.size() + 2 * kSideBytes + 1;

bool isStandIn(std::span<const std::byte> bytes) {
    return bytes.size() >= kStandInBytes && std::memcmp(bytes.data(), kStandIn.data(), kStandIn.size()) == 0;
}

TextureImage pictureElsewhere(std::span<const std::byte> standIn, Encoding encoding) {
    std::int32_t sides[2];
    std::memcpy(sides, &standIn[kStandIn.size()], sizeof sides);
    return {{sides[0], sides[1]}, encoding, {std::uint8_t(standIn[kStandInBytes - 1])}};
}

std::string sizeText(ivec2 size) { return std::to_string(size.x) + " x " + std::to_string(size.y); }

} // namespace

vec4 TextureImage::texel(ivec2 at) const {
    const std::uint8_t* from = &texels[4 * (std::size_t(at.y) * std::size_t(size.x) + std::size_t(at.x))];
    return {lightOf(from[0], encoding), lightOf(from[1], encoding), lightOf(from[2], encoding),
            lightOf(from[3], Encoding::Linear)};
}

void TextureImage::findLeast() {
    constexpr std::uint32_t kGreen = 0xff00; // of a texel as one number: quicker than byte by byte
    std::uint32_t least = kGreen;
    for (std::size_t i = 0; i < texels.size(); i += 4) {
        std::uint32_t texel;
        std::memcpy(&texel, &texels[i], sizeof texel);
        least = std::min(least, texel & kGreen);
    }
    leastGreen = lightOf(std::uint8_t(least >> 8), encoding);
}

Bytes standInFor(ivec2 size, std::uint8_t number) {
    Bytes bytes(kStandInBytes);
    std::memcpy(bytes.data(), kStandIn.data(), kStandIn.size());
    const std::int32_t sides[] = {size.x, size.y};
    std::memcpy(&bytes[kStandIn.size()], sides, sizeof sides);
    bytes.back() = std::byte(number);
    return bytes;
}

Result<TextureImage> decodeTexture(std::span<const std::byte> bytes, const std::string& name,
                                   Encoding encoding) {
    if (isStandIn(bytes)) return pictureElsewhere(bytes, encoding);
    Result<ByteImage> decoded = decodeBytes(bytes, name);
    if (!decoded) return decoded.error();
    TextureImage image;
    image.size = decoded->size;
    image.encoding = encoding;
    image.texels = std::move(decoded->values);
    while (std::max(image.size.x, image.size.y) > kMostTextureSide)
        image = halved(image);
    if (image.size != decoded->size)
        warnOnce(name + ": has " + sizeText(decoded->size) + " texels; is shown with " +
                 sizeText(image.size) + ", as textures have at most " + std::to_string(kMostTextureSide) +
                 " on a side");
    image.findLeast();
    return image;
}

} // namespace lucent::scene
