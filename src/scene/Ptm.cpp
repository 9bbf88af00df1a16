#include "scene/Ptm.h"

#include "base/ImageSize.h"
#include "base/Text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lucent::scene {
namespace {

constexpr std::string_view kStart = "PTM_1.";
constexpr std::size_t kTerms = 6;

using Polynomial = std::array<double, kTerms>;

double valueAt(const Polynomial& a, dvec2 light) {
    const double u = light.x, v = light.y;
    return a[0] * u * u + a[1] * v * v + a[2] * u * v + a[3] * u + a[4] * v + a[5];
}

// The light that makes it brightest, on or above the horizon.
dvec3 brightestLight(const Polynomial& a) {
    constexpr double kLeastZ = 0.05;
    const double most = std::sqrt(1 - kLeastZ * kLeastZ), bend = 4 * a[0] * a[1] - a[2] * a[2];
    dvec2 place(a[3], a[4]);
    if (bend > 1e-12 && a[0] < 0)
        place = dvec2(a[2] * a[4] - 2 * a[1] * a[3], a[2] * a[3] - 2 * a[0] * a[4]) / bend;
    else
        place = glm::length(place) > 1e-9 ? most * glm::normalize(place) : dvec2(0);
    if (glm::length(place) > most) place = most * glm::normalize(place);
    return {place, std::sqrt(1 - glm::dot(place, place))};
}

// A header of words and what follows it.
struct Reader {
    std::span<const std::byte> bytes;
    const std::string& name;

    std::string_view word() {
        const auto text = std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const std::size_t begin = std::min(text.find_first_not_of(" \t\r\n"), text.size());
        const std::size_t end = std::min(text.find_first_of(" \t\r\n", begin), text.size());
        bytes = bytes.subspan(end);
        return text.substr(begin, end - begin);
    }
    Result<double> number(std::string_view what) {
        const std::string_view text = word();
        if (const std::optional<double> value = numberIn(text)) return *value;
        return Error{name + ": " + std::string(what) + " is " + inQuotes(text.substr(0, 40)) +
                     "; must be a number"};
    }
    Status numbers(std::string_view what, std::span<double> values) {
        for (double& value : values) {
            const Result<double> read = number(what);
            if (!read) return read.error();
            value = *read;
        }
        return Done{};
    }
};

// Which bytes hold the coefficients and colours of a pixel; the file's rows begin at the bottom.
struct Ptm {
    int width = 0, height = 0;
    bool isRgb = false; // a polynomial for each colour, else one and a colour
    Polynomial scale{}, bias{};
    std::span<const std::byte> data;

    std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
    std::size_t bytesOfPixel() const { return isRgb ? 3 * kTerms : kTerms + 3; }
    Polynomial polynomial(std::size_t plane, std::size_t pixel) const {
        Polynomial a;
        for (std::size_t i = 0; i < kTerms; ++i)
            a[i] = scale[i] * (double(data[(plane * pixels() + pixel) * kTerms + i]) - bias[i]) / 255;
        return a;
    }
    double color(std::size_t pixel, int channel) const {
        return double(data[pixels() * kTerms + 3 * pixel + std::size_t(channel)]) / 255;
    }
};

Result<Ptm> readHeader(std::span<const std::byte> bytes, const std::string& name) {
    Reader reader{bytes, name};
    reader.word();
    const std::string_view format = reader.word();
    Ptm ptm;
    ptm.isRgb = format == "PTM_FORMAT_RGB";
    if (!ptm.isRgb && format != "PTM_FORMAT_LRGB")
        return Error{name + ": is of the kind " + inQuotes(format.substr(0, 40)) +
                     "; must be PTM_FORMAT_LRGB or PTM_FORMAT_RGB"};
    double size[2]{};
    if (Status read = reader.numbers("its size", size); !read) return read.error();
    if (Status legal = checkImageSize(size[0], size[1], 3, name); !legal) return legal.error();
    ptm.width = int(size[0]);
    ptm.height = int(size[1]);
    if (Status read = reader.numbers("a scale", ptm.scale); !read) return read.error();
    if (Status read = reader.numbers("a bias", ptm.bias); !read) return read.error();
    // One white space, or two in files of Windows, stands before the data, which reach the end of the file.
    const std::size_t wanted = ptm.pixels() * ptm.bytesOfPixel();
    if (reader.bytes.size() < wanted + 1)
        return Error{name + ": ends after " + std::to_string(reader.bytes.size()) +
                     " bytes of pixels; must have " + std::to_string(wanted)};
    ptm.data =
        reader.bytes.subspan(reader.bytes[0] == std::byte('\r') && reader.bytes.size() > wanted + 1 ? 2 : 1);
    return ptm;
}

} // namespace

bool isPtm(std::span<const std::byte> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()),
                                std::min(bytes.size(), kStart.size()));
    return text == kStart;
}

Result<SurfaceMaps> decodePtm(std::span<const std::byte> bytes, const std::string& name) {
    if (!isPtm(bytes)) return Error{name + ": does not begin with PTM_1.2; must be a polynomial texture map"};
    const Result<Ptm> ptm = readHeader(bytes, name);
    if (!ptm) return ptm.error();
    SurfaceMaps maps;
    maps.normals = maps.albedo = Image(ptm->width, ptm->height, 3);
    for (int y = 0; y < ptm->height; ++y)
        for (int x = 0; x < ptm->width; ++x) {
            const std::size_t pixel =
                std::size_t(ptm->height - 1 - y) * std::size_t(ptm->width) + std::size_t(x);
            std::array<Polynomial, 3> colors{};
            Polynomial mean{};
            for (std::size_t c = 0; c < 3; ++c) {
                colors[c] = ptm->polynomial(ptm->isRgb ? c : 0, pixel);
                for (std::size_t i = 0; i < kTerms; ++i)
                    mean[i] += colors[c][i] / 3;
            }
            const dvec3 normal = brightestLight(mean);
            for (int c = 0; c < 3; ++c) {
                const double bright = valueAt(colors[std::size_t(c)], dvec2(normal));
                const double coded = ptm->isRgb ? bright : bright * ptm->color(pixel, c);
                maps.normals.at(x, y)[c] = float(normal[c] / 2 + 0.5);
                maps.albedo.at(x, y)[c] = linearFromSrgb(float(std::clamp(coded, 0.0, 1.0)));
            }
        }
    return maps;
}

} // namespace lucent::scene
