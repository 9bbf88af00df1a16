#pragma once
/// Images in memory and their files. Values are linear floats; row 0 is the top.

#include "base/File.h"
#include "base/Math.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace lucent {

/// A picture, a map of heights or of anything else: `channels` floats a pixel, row by row from the top.
struct Image {
    int width = 0;
    int height = 0;
    int channels = 0;
    std::vector<float> pixels;

    Image() = default;
    Image(int width, int height, int channels)
        : width(width), height(height), channels(channels), pixels(std::size_t(width) * height * channels) {}

    bool empty() const { return pixels.empty(); }
    ivec2 size() const { return {width, height}; }
    float* at(int x, int y) { return pixels.data() + (std::size_t(y) * width + x) * channels; }
    const float* at(int x, int y) const { return pixels.data() + (std::size_t(y) * width + x) * channels; }
};

/// How integer files (8 and 16 bit) are read: as they are (heights, alpha, normals), or decoded from the sRGB
/// curve (colours, environments). Float files (HDR, EXR, PFM) are always linear.
enum class Encoding { Linear, Srgb };

/// One code value of the sRGB curve to linear light and back, [0,1] each (IEC 61966-2-1).
float linearFromSrgb(float encoded);
float srgbFromLinear(float linear);

/// Decodes PNG (8/16 bit), JPEG, Radiance HDR or PFM, told apart by their first bytes, not by their name. EXR
/// becomes PFM before it comes here (scene/readers), so that a page without EXR files loads no EXR reader.
///
/// @param name      used in messages only
/// @param encoding  how integer samples are read
/// @return          1 to 4 channels; integers scaled to [0,1]. Alpha is never decoded by the sRGB curve.
///                  Error: "NAME: what was found; what was expected" (truncated, empty, unknown, 0-sized).
Result<Image> decodeImage(std::span<const std::byte> bytes, const std::string& name, Encoding encoding);

/// The same piece by piece, for who must not wait.
class ImageReading {
public:
    ImageReading(Bytes bytes, std::string name, Encoding encoding);
    ~ImageReading();
    /// One piece more; the picture once it is whole.
    std::optional<Result<Image>> advance();
    /// How much of the file the next piece decodes, which cannot be parted: bytes.
    std::size_t bytes() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Four bytes a pixel, red to alpha, row by row from the top.
struct ByteImage {
    ivec2 size{0};
    std::vector<std::uint8_t> values;
};

/// The same files as code values of 8 bits, as they are stored: finer samples are rounded, grey ones
/// repeated, and what has no alpha has 255.
Result<ByteImage> decodeBytes(std::span<const std::byte> bytes, const std::string& name);

/// Encodes by the ending of `path`: .png (8 bit; values are written as they are, clamped to [0,1]), .hdr,
/// .pfm (linear floats, without alpha). Error when the ending is none of these or a value cannot be held: NaN
/// and infinity outside PFM, negative values in HDR. scene/readers adds .exr.
Result<Bytes> encodeImage(const Image& image, const std::string& path);

/// First pixel that is NaN or infinite, as x, y; (-1, -1) when there is none.
ivec2 findNonFinite(const Image& image);

} // namespace lucent
