#include "base/Hdr.h"

#include "base/ImageSize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

namespace lucent {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

// Takes bytes off the front; says when there are none left.
class Input {
public:
    explicit Input(std::span<const std::byte> bytes) : bytes_(bytes) {}

    std::size_t left() const { return bytes_.size(); }
    std::uint8_t peek(std::size_t i) const { return i < bytes_.size() ? std::uint8_t(bytes_[i]) : 0; }
    bool take(std::uint8_t& value) {
        if (bytes_.empty()) return false;
        value = std::uint8_t(bytes_.front());
        bytes_ = bytes_.subspan(1);
        return true;
    }
    // So many at once; none where fewer are left.
    std::span<const std::byte> take(std::size_t count) {
        if (count > bytes_.size()) return {};
        const auto taken = bytes_.first(count);
        bytes_ = bytes_.subspan(count);
        return taken;
    }
    bool take(Rgbe& pixel) { return take(pixel[0]) && take(pixel[1]) && take(pixel[2]) && take(pixel[3]); }
    bool takeLine(std::string& line) {
        line.clear();
        std::uint8_t c;
        while (take(c)) {
            if (c == '\n') return true;
            line += char(c);
        }
        return false;
    }

private:
    std::span<const std::byte> bytes_;
};

// New kind of coding: each channel of the row on its own, in runs (count above 128) and plain stretches.
bool takeChannels(Input& input, std::vector<Rgbe>& row) {
    for (std::size_t channel = 0; channel < 4; ++channel)
        for (std::size_t x = 0; x < row.size();) {
            std::uint8_t count, value = 0;
            if (!input.take(count)) return false;
            const bool run = count > 128;
            const std::size_t length = run ? count - 128u : count;
            if (length == 0 || length > row.size() - x || (run && !input.take(value))) return false;
            if (run) {
                for (std::size_t i = 0; i < length; ++i)
                    row[x++][channel] = value;
                continue;
            }
            const std::span<const std::byte> values = input.take(length);
            if (values.empty()) return false;
            for (const std::byte one : values)
                row[x++][channel] = std::uint8_t(one);
        }
    return true;
}

// Plain pixels; (1, 1, 1, n) repeats the last one n times, several of them in a row count in bytes from the
// lowest.
bool takePixels(Input& input, std::vector<Rgbe>& row) {
    int shift = 0;
    for (std::size_t x = 0; x < row.size();) {
        Rgbe pixel;
        if (!input.take(pixel)) return false;
        if (pixel[0] != 1 || pixel[1] != 1 || pixel[2] != 1) {
            row[x++] = pixel;
            shift = 0;
            continue;
        }
        const std::size_t length = shift > 16 ? 0 : std::size_t(pixel[3]) << shift;
        if (x == 0 || length > row.size() - x) return false;
        for (std::size_t i = 0; i < length; ++i, ++x)
            row[x] = row[x - 1];
        shift += 8;
    }
    return true;
}

bool takeRow(Input& input, std::vector<Rgbe>& row) {
    const bool canBeCoded = row.size() >= 8 && row.size() < 32768;
    const bool coded = canBeCoded && input.peek(0) == 2 && input.peek(1) == 2 && input.peek(2) < 128;
    if (!coded) return takePixels(input, row);
    Rgbe start;
    const bool fits = input.take(start) && (std::size_t(start[2]) << 8 | start[3]) == row.size();
    return fits && takeChannels(input, row);
}

// What a step of the mantissa is worth, by exponent.
std::array<float, 256> stepsOf() {
    std::array<float, 256> steps{};
    for (int exponent = 1; exponent < 256; ++exponent)
        steps[std::size_t(exponent)] = std::ldexp(1.0f, exponent - 136); // 128 + 8 bits of mantissa
    return steps;
}

} // namespace

bool isHdr(std::span<const std::byte> bytes) {
    return bytes.size() > 2 && bytes[0] == std::byte('#') && bytes[1] == std::byte('?');
}

struct HdrReading::State {
    Bytes bytes;
    std::string name;
    Input input{bytes};
    std::array<float, 256> steps = stepsOf();
    std::vector<Rgbe> row;
    Image image;
    int rows = 0; // that are there

    State(Bytes all, std::string of) : bytes(std::move(all)), name(std::move(of)) {}

    Error damaged() const {
        return {name + ": the HDR file is cut or damaged; must be a whole Radiance RGBE file"};
    }

    Status begin() {
        std::string line;
        bool known = false;
        do {
            if (!input.takeLine(line)) return damaged();
            if (line.starts_with("FORMAT=") && line != "FORMAT=32-bit_rle_rgbe")
                return Error{name + ": is stored as " + line.substr(7) + "; must be 32-bit_rle_rgbe"};
            known |= line.starts_with("FORMAT=");
        } while (!line.empty());
        if (!known || !input.takeLine(line)) return damaged();
        int width = 0, height = 0;
        if (std::sscanf(line.c_str(), "-Y %d +X %d", &height, &width) != 2)
            return Error{name + ": has the layout \"" + line + "\"; must be -Y height +X width"};
        if (Status size = checkImageSize(width, height, 3, name); !size) return size.error();
        // A run codes at most 127 pixels of a channel in two bytes: fewer bytes than this cannot hold the
        // picture.
        if (input.left() < std::size_t(height) * 4) return damaged();
        image = Image(width, height, 3);
        row.resize(std::size_t(width));
        return Done{};
    }

    Status takeNext() {
        if (!takeRow(input, row)) return damaged();
        float* to = image.at(0, rows++);
        for (const Rgbe& pixel : row) {
            const float step = steps[pixel[3]];
            for (std::size_t c = 0; c < 3; ++c)
                *to++ = float(pixel[c]) * step;
        }
        return Done{};
    }

    std::optional<Result<Image>> advance() {
        if (row.empty()) {
            const Status begun = begin();
            return begun ? std::nullopt : std::optional(Result<Image>(begun.error()));
        }
        constexpr int kPixels = 1 << 17; // of a piece
        const int end = std::min(image.height, rows + std::max(1, kPixels / image.width));
        while (rows < end)
            if (const Status taken = takeNext(); !taken) return Result<Image>(taken.error());
        if (rows < image.height) return std::nullopt;
        return Result<Image>(std::move(image));
    }
};

HdrReading::HdrReading(Bytes bytes, std::string name)
    : state_(std::make_unique<State>(std::move(bytes), std::move(name))) {}
HdrReading::~HdrReading() = default;

std::optional<Result<Image>> HdrReading::advance() { return state_->advance(); }

Result<Image> decodeHdr(std::span<const std::byte> bytes, const std::string& name) {
    HdrReading reading(Bytes(bytes.begin(), bytes.end()), name);
    for (;;)
        if (std::optional<Result<Image>> image = reading.advance()) return std::move(*image);
}

} // namespace lucent
