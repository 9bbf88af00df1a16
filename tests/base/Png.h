#pragma once
/// PNG files of any bit depth for tests: our own writer knows 8 bits only.

#include "base/File.h"

#include <cstdint>

namespace lucent::test {

inline void addBigEndian(Bytes& out, std::uint32_t value) {
    for (const int shift : {24, 16, 8, 0})
        out.push_back(std::byte(value >> shift));
}

inline std::uint32_t crcOf(std::span<const std::byte> bytes) {
    std::uint32_t crc = ~0u;
    for (const std::byte byte : bytes) {
        crc ^= std::uint32_t(byte);
        for (int bit = 0; bit < 8; ++bit)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
    }
    return ~crc;
}

inline void addChunk(Bytes& out, std::string_view type, const Bytes& data) {
    addBigEndian(out, std::uint32_t(data.size()));
    const std::size_t begin = out.size();
    for (const char c : type)
        out.push_back(std::byte(c));
    out.insert(out.end(), data.begin(), data.end());
    addBigEndian(out, crcOf(std::span(out).subspan(begin)));
}

/// PNG with one stored (not compressed) block.
///
/// @param colorType  0 grey, 2 RGB, 4 grey and alpha, 6 RGBA
/// @param samples    all samples in order, 16-bit ones big-endian; at most 65535 bytes with one more a row
inline Bytes makePng(std::uint32_t width, std::uint32_t height, int bitDepth, int colorType,
                     const Bytes& samples) {
    Bytes out;
    for (const char c : std::string_view("\x89PNG\r\n\x1a\n"))
        out.push_back(std::byte(c));
    Bytes header;
    addBigEndian(header, width);
    addBigEndian(header, height);
    for (const int value : {bitDepth, colorType, 0, 0, 0})
        header.push_back(std::byte(value));
    addChunk(out, "IHDR", header);

    Bytes raw;
    const std::size_t row = height ? samples.size() / height : 0;
    for (std::size_t y = 0; y < height && row; ++y) {
        raw.push_back(std::byte(0)); // no filter
        raw.insert(raw.end(), samples.begin() + std::ptrdiff_t(y * row),
                   samples.begin() + std::ptrdiff_t((y + 1) * row));
    }
    std::uint32_t a = 1, b = 0; // Adler-32
    for (const std::byte byte : raw) {
        a = (a + std::uint32_t(byte)) % 65521;
        b = (b + a) % 65521;
    }
    const auto size = std::uint32_t(raw.size());
    Bytes data;
    for (const std::uint32_t value : {0x78u, 0x01u, 1u, size & 255, size >> 8, ~size & 255, ~size >> 8 & 255})
        data.push_back(std::byte(value));
    data.insert(data.end(), raw.begin(), raw.end());
    addBigEndian(data, b << 16 | a);
    addChunk(out, "IDAT", data);
    addChunk(out, "IEND", {});
    return out;
}

inline Bytes bytesOf(std::string_view text) {
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return Bytes(begin, begin + text.size());
}

} // namespace lucent::test
