#include "base/Pfm.h"

#include "base/ImageSize.h"

#include <algorithm>
#include <bit>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

namespace lucent {
namespace {

constexpr std::size_t kLongestHeader = 256; // type, two sizes and a scale take less than 100

bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

struct Header {
    std::string_view text;
    std::size_t at; // behind the type

    // Next word of the header; empty when there is none.
    std::string word() {
        while (at < text.size() && isBlank(text[at]))
            ++at;
        const std::size_t begin = at;
        while (at < text.size() && !isBlank(text[at]))
            ++at;
        return std::string(text.substr(begin, at - begin));
    }
};

bool parseNumber(const std::string& word, double& number) {
    char* end = nullptr;
    number = std::strtod(word.c_str(), &end);
    return !word.empty() && !*end;
}

// Which the type says: "Pf", "PF" or "PF4"; 0 for other files.
int channelsOf(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min<std::size_t>(bytes.size(), 4));
    for (const auto& [type, channels] : {std::pair<std::string_view, int>{"Pf", 1}, {"PF", 3}, {"PF4", 4}})
        if (text.starts_with(type) && text.size() > type.size() && isBlank(text[type.size()]))
            return channels;
    return 0;
}

void swapBytes(float& value) {
    auto* bytes = reinterpret_cast<std::byte*>(&value);
    std::reverse(bytes, bytes + sizeof value);
}

} // namespace

bool isPfm(std::span<const std::byte> bytes) { return channelsOf(bytes) != 0; }

Result<Image> decodePfm(std::span<const std::byte> bytes, const std::string& name) {
    const std::size_t length = std::min(bytes.size(), kLongestHeader);
    const int channels = channelsOf(bytes);
    Header header{{reinterpret_cast<const char*>(bytes.data()), length}, channels == 4 ? std::size_t(3) : 2};
    double width, height, scale;
    if (!parseNumber(header.word(), width) || !parseNumber(header.word(), height) ||
        !parseNumber(header.word(), scale) || scale == 0)
        return Error{name + ": the PFM header is damaged; must be PF or Pf, width, height, scale"};
    if (Status size = checkImageSize(width, height, channels, name); !size) return size.error();
    const std::size_t row = std::size_t(width) * std::size_t(channels) * sizeof(float);
    const std::size_t start = header.at + 1, needed = row * std::size_t(height); // one blank ends the header
    if (bytes.size() < start + needed)
        return Error{name + ": the PFM file ends after " + std::to_string(bytes.size()) +
                     " bytes; must have " + std::to_string(start + needed)};

    Image image(int(width), int(height), channels);
    for (int y = 0; y < image.height; ++y)
        std::memcpy(image.at(0, image.height - 1 - y), bytes.data() + start + std::size_t(y) * row, row);
    const bool littleEndian = scale < 0;
    if (littleEndian != (std::endian::native == std::endian::little))
        for (float& value : image.pixels)
            swapBytes(value);
    return image;
}

Bytes encodePfm(const Image& image) {
    char header[64];
    const char* type = image.channels == 4 ? "PF4" : image.channels == 3 ? "PF" : "Pf";
    const int length =
        std::snprintf(header, sizeof header, "%s\n%d %d\n-1.0\n", type, image.width, image.height);
    const std::size_t row = std::size_t(image.width) * std::size_t(image.channels) * sizeof(float);
    Bytes bytes(std::size_t(length) + row * std::size_t(image.height));
    std::memcpy(bytes.data(), header, std::size_t(length));
    for (int y = 0; y < image.height; ++y)
        std::memcpy(bytes.data() + length + std::size_t(y) * row, image.at(0, image.height - 1 - y), row);
    return bytes;
}

} // namespace lucent
