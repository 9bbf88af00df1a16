#pragma once
/// Zip archives byte by byte (APPNOTE 6.3.9), true ones and such as no program writes.

#include "base/File.h"

#include <cstdint>
#include <string>
#include <vector>
#include <zlib.h>

namespace lucent::test {

/// A file of an archive. What is said of it need not be so.
struct ZipFile {
    std::string name, content;
    std::uint32_t size = std::uint32_t(content.size()); ///< that the archive says
    bool deflated = false;                              ///< else stored
    std::uint16_t flags = 0;                            ///< 1: encrypted
    std::uint32_t crc =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size())));
};

/// Appends little-endian numbers and text.
class ZipWriter {
public:
    ZipWriter& number(std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            text_ += char(value >> (8 * i) & 0xff);
        return *this;
    }
    ZipWriter& text(const std::string& text) {
        text_ += text;
        return *this;
    }
    const std::string& all() const { return text_; }
    std::uint32_t size() const { return std::uint32_t(text_.size()); }

private:
    std::string text_;
};

/// A raw deflate stream.
inline std::string deflated(const std::string& content) {
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
    std::string packed(deflateBound(&stream, content.size()), '\0');
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(content.data()));
    stream.avail_in = uInt(content.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = uInt(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(stream.total_out);
    deflateEnd(&stream);
    return packed;
}

inline std::string zipOf(const std::vector<ZipFile>& files) {
    ZipWriter zip, list;
    for (const ZipFile& file : files) {
        const std::string packed = file.deflated ? deflated(file.content) : file.content;
        const std::uint32_t start = zip.size();
        const auto describe = [&](ZipWriter& out) {
            out.number(20, 2)
                .number(file.flags, 2)
                .number(file.deflated ? 8 : 0, 2)
                .number(0, 2)
                .number(0x21, 2);
            out.number(file.crc, 4).number(std::uint32_t(packed.size()), 4).number(file.size, 4);
            out.number(std::uint32_t(file.name.size()), 2).number(0, 2);
        };
        describe(zip.number(0x04034b50, 4));
        zip.text(file.name).text(packed);
        describe(list.number(0x02014b50, 4).number(20, 2));
        list.number(0, 2).number(0, 2).number(0, 2).number(0, 4).number(start, 4).text(file.name);
    }
    const std::uint32_t start = zip.size(), count = std::uint32_t(files.size());
    zip.text(list.all()).number(0x06054b50, 4).number(0, 4).number(count, 2).number(count, 2);
    return zip.number(list.size(), 4).number(start, 4).number(0, 2).all();
}

} // namespace lucent::test
