#include "scene/readers/Exr.h"

#include "base/ImageSize.h"
#include "scene/readers/Readers.h"

#define TINYEXR_IMPLEMENTATION
#include <tinyexr.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace lucent::scene {
namespace {

struct Free {
    void operator()(void* memory) const { std::free(memory); }
};

// tinyexr's message, freed.
std::string takeMessage(const char* message) {
    std::string text = message ? message : "cannot be decoded";
    FreeEXRErrorMessage(message);
    while (!text.empty() && (text.back() == '\n' || text.back() == '.'))
        text.pop_back();
    return text;
}

Error damaged(const std::string& name, const char* message) {
    return {name + ": " + takeMessage(message) + "; must be a whole EXR file"};
}

// A header that frees what it holds.
struct Header : EXRHeader {
    Header() { InitEXRHeader(this); }
    ~Header() { FreeEXRHeader(this); }
    Header(const Header&) = delete;
    Header& operator=(const Header&) = delete;
};

// Channels of an EXR file stand in alphabetical order.
std::span<const char* const> channelNames(int channels) {
    static constexpr const char* kGrey[] = {"Y"};
    static constexpr const char* kColor[] = {"B", "G", "R"};
    static constexpr const char* kColorAlpha[] = {"A", "B", "G", "R"};
    if (channels == 1) return kGrey;
    if (channels == 3) return kColor;
    return kColorAlpha;
}

// One plane a channel in the file's order, which is ours turned round: R G B A becomes A B G R.
std::vector<std::vector<float>> splitPlanes(const Image& image) {
    std::vector<std::vector<float>> planes(std::size_t(image.channels));
    for (std::size_t c = 0; c < planes.size(); ++c)
        for (std::size_t i = planes.size() - 1 - c; i < image.pixels.size(); i += planes.size())
            planes[c].push_back(image.pixels[i]);
    return planes;
}

// Indices of the planes to take: red, green, blue and what there is of alpha, or the only one.
using Channels = std::vector<std::size_t>;

Result<Channels> findChannels(const EXRHeader& header, const std::string& name) {
    const std::span<const EXRChannelInfo> all(header.channels, std::size_t(header.num_channels));
    std::string names;
    for (const EXRChannelInfo& channel : all) {
        (names += names.empty() ? "" : ", ") += channel.name;
        if (channel.pixel_type == TINYEXR_PIXELTYPE_UINT || channel.x_sampling != 1 ||
            channel.y_sampling != 1)
            return Error{name + ": channel " + channel.name +
                         " holds integers or only some pixels; must be floats"};
    }
    if (all.size() == 1) return Channels{0};
    Channels found;
    for (const std::string_view wanted : {"R", "G", "B", "A"})
        for (std::size_t c = 0; c < all.size(); ++c)
            if (all[c].name == wanted) found.push_back(c);
    const bool hasAlpha = !found.empty() && std::string_view(all[found.back()].name) == "A";
    if (found.size() != (hasAlpha ? 4u : 3u))
        return Error{name + ": has the channels " + names + "; must have R, G, B or only one"};
    return found;
}

// Copies a block of planes to its place; what hangs over the picture's border is left out.
void place(Image& image, const unsigned char* const* planes, const Channels& channels, ivec2 at,
           ivec2 block) {
    for (int y = 0; y < std::min(block.y, image.height - at.y); ++y)
        for (int x = 0; x < std::min(block.x, image.width - at.x); ++x)
            for (std::size_t c = 0; c < channels.size(); ++c)
                image.at(at.x + x, at.y + y)[c] = reinterpret_cast<const float*>(
                    planes[channels[c]])[std::size_t(y) * std::size_t(block.x) + std::size_t(x)];
}

Image gather(const EXRImage& decoded, const EXRHeader& header, const Channels& channels) {
    Image image(decoded.width, decoded.height, int(channels.size()));
    if (!decoded.tiles) place(image, decoded.images, channels, {0, 0}, image.size());
    const ivec2 block(header.tile_size_x, header.tile_size_y);
    for (int i = 0; decoded.tiles && i < decoded.num_tiles; ++i) {
        const EXRTile& tile = decoded.tiles[i];
        place(image, tile.images, channels, ivec2(tile.offset_x, tile.offset_y) * block, block);
    }
    return image;
}

} // namespace

bool isExr(std::span<const std::byte> bytes) {
    constexpr std::string_view kMagic = "\x76\x2f\x31\x01";
    return bytes.size() >= kMagic.size() && std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) == 0;
}

Result<Image> decodeExr(std::span<const std::byte> bytes, const std::string& name) {
    const auto* data = reinterpret_cast<const unsigned char*>(bytes.data());
    EXRVersion version{};
    if (ParseEXRVersionFromMemory(&version, data, bytes.size()) != TINYEXR_SUCCESS)
        return damaged(name, nullptr);
    if (version.multipart || version.non_image)
        return Error{name + ": is an EXR file of several parts or deep pixels; must hold one flat picture"};
    Header header;
    const char* message = nullptr;
    if (ParseEXRHeaderFromMemory(&header, &version, data, bytes.size(), &message) != TINYEXR_SUCCESS)
        return damaged(name, message);
    const EXRBox2i& window = header.data_window;
    const Status size =
        checkImageSize(double(window.max_x) - window.min_x + 1, double(window.max_y) - window.min_y + 1,
                       std::min(header.num_channels, 4), name);
    if (!size) return size.error();

    const Result<Channels> channels = findChannels(header, name);
    if (!channels) return channels.error();
    std::fill_n(header.requested_pixel_types, header.num_channels, TINYEXR_PIXELTYPE_FLOAT);

    EXRImage decoded;
    InitEXRImage(&decoded);
    decoded.num_channels =
        header.num_channels; // else tinyexr loses its planes when it fails, which it frees itself
    if (LoadEXRImageFromMemory(&decoded, &header, data, bytes.size(), &message) != TINYEXR_SUCCESS)
        return damaged(name, message);
    const Image image = gather(decoded, header, *channels);
    FreeEXRImage(&decoded);
    return image;
}

Result<Bytes> encodeExr(const Image& image) {
    if (image.channels != 1 && image.channels != 3 && image.channels != 4)
        return Error{"EXR: the image has " + std::to_string(image.channels) +
                     " channels; must have 1, 3 or 4"};
    const std::vector<std::vector<float>> planes = splitPlanes(image);
    std::vector<unsigned char*> pointers;
    for (const std::vector<float>& plane : planes)
        pointers.push_back(reinterpret_cast<unsigned char*>(const_cast<float*>(plane.data()))); // only read
    EXRImage exr;
    InitEXRImage(&exr);
    exr.images = pointers.data();
    exr.width = image.width;
    exr.height = image.height;
    exr.num_channels = image.channels;

    std::vector<EXRChannelInfo> channels(planes.size());
    std::vector<int> types(planes.size(), TINYEXR_PIXELTYPE_FLOAT);
    for (std::size_t c = 0; c < channels.size(); ++c)
        std::strcpy(channels[c].name, channelNames(image.channels)[c]);
    EXRHeader header;
    InitEXRHeader(&header);
    header.num_channels = image.channels;
    header.channels = channels.data();
    header.pixel_types = header.requested_pixel_types = types.data();
    header.compression_type = TINYEXR_COMPRESSIONTYPE_ZIP;

    unsigned char* memory = nullptr;
    const char* message = nullptr;
    const std::size_t count = SaveEXRImageToMemory(&exr, &header, &memory, &message);
    const std::unique_ptr<unsigned char, Free> owner(memory);
    if (count == 0) return Error{"EXR: " + takeMessage(message)};
    const auto* begin = reinterpret_cast<const std::byte*>(memory);
    return Bytes(begin, begin + count);
}

} // namespace lucent::scene
