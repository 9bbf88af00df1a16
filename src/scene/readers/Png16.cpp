#include "scene/readers/Png16.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace lucent::scene {
namespace {

void put(Bytes& out, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0})
        out.push_back(std::byte(value >> shift));
}

void putChunk(Bytes& out, std::string_view type, std::span<const std::uint8_t> data) {
    put(out, std::uint32_t(data.size()));
    const std::size_t begin = out.size();
    const auto bytes = std::as_bytes(data), name = std::as_bytes(std::span(type.data(), type.size()));
    out.insert(out.end(), name.begin(), name.end());
    out.insert(out.end(), bytes.begin(), bytes.end());
    const auto* covered = reinterpret_cast<const Bytef*>(out.data() + begin);
    put(out, std::uint32_t(crc32(0, covered, uInt(out.size() - begin))));
}

// Rows of big-endian samples, each less the one above it (filter 2), which compresses what is smooth.
std::vector<std::uint8_t> filteredRows(const Image& image) {
    constexpr std::uint8_t kUp = 2;
    const std::size_t row = 2 * std::size_t(image.width) * std::size_t(image.channels);
    std::vector<std::uint8_t> above(row), now(row), rows;
    rows.reserve((row + 1) * std::size_t(image.height));
    for (int y = 0; y < image.height; ++y) {
        const float* value = image.at(0, y);
        for (std::size_t i = 0; i < row; i += 2, ++value) {
            const auto sample = std::uint16_t(std::lround(65535 * std::clamp(*value, 0.0f, 1.0f)));
            now[i] = std::uint8_t(sample >> 8);
            now[i + 1] = std::uint8_t(sample);
        }
        rows.push_back(kUp);
        for (std::size_t i = 0; i < row; ++i)
            rows.push_back(std::uint8_t(now[i] - above[i]));
        std::swap(above, now);
    }
    return rows;
}

} // namespace

Bytes encodePng16(const Image& image) {
    constexpr std::uint8_t kColorTypes[] = {0, 4, 2, 6}; // of 1 to 4 channels
    Bytes out;
    for (const char c : std::string_view("\x89PNG\r\n\x1a\n"))
        out.push_back(std::byte(c));
    Bytes size;
    put(size, std::uint32_t(image.width));
    put(size, std::uint32_t(image.height));
    std::vector<std::uint8_t> header(8);
    std::memcpy(header.data(), size.data(), 8);
    for (const int value : {16, int(kColorTypes[image.channels - 1]), 0, 0, 0})
        header.push_back(std::uint8_t(value));
    putChunk(out, "IHDR", header);

    const std::vector<std::uint8_t> rows = filteredRows(image);
    uLongf length = compressBound(uLong(rows.size()));
    std::vector<std::uint8_t> data(length);
    compress(data.data(), &length, rows.data(), uLong(rows.size())); // has room for all
    putChunk(out, "IDAT", std::span(data).first(length));
    putChunk(out, "IEND", {});
    return out;
}

} // namespace lucent::scene
