#include "cli/TruthOutput.h"

#include "cli/Files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

namespace lucent::cli {

namespace {
/// The picture of linear values: exposure for colours, then clamp and sRGB curve.
Image toDisplay(Image image, const truth::Facts& facts) {
    const float gain = facts.aov == "color" ? std::exp2(facts.exposure) : 1;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        if (i % 4 != 3) image.pixels[i] = srgbFromLinear(std::clamp(gain * image.pixels[i], 0.f, 1.f));
    return image;
}
} // namespace

void TruthOutput::addTo(CLI::App& parser) {
    addOutput(
        parser, picture,
        "Picture: .png as displayed; .hdr, .exr or .pfm with linear values. What it is, its standard error "
        "included, goes beside it to FILE.json");
    parser.add_option("--errors", errors, "Also writes the standard error of each pixel: .hdr, .exr or .pfm")
        ->type_name("FILE");
}

Status TruthOutput::check(const std::vector<std::string>& inputs) const {
    if (Status known = checkImageEnding(picture); !known) return known;
    if (std::filesystem::path(errors).extension() == ".png")
        return Error{errors + ": PNG cannot hold standard errors; must be .hdr, .exr or .pfm"};
    if (!errors.empty())
        if (Status known = checkImageEnding(errors); !known) return known;
    return checkOutputs({picture, facts(), errors}, inputs);
}

Status TruthOutput::write(const truth::Facts& what, const truth::Picture& solved) const {
    const bool displayed = std::filesystem::path(picture).extension() == ".png";
    Result<Bytes> encoded = encode(displayed ? toDisplay(solved.values, what) : solved.values, picture);
    if (!encoded) return encoded.error();
    std::vector<Output> outputs{{picture, std::move(*encoded)},
                                {facts(), toBytes(truth::sidecar(what, solved))}};
    if (!errors.empty()) {
        Result<Bytes> more = encode(solved.errors, errors);
        if (!more) return more.error();
        outputs.push_back({errors, std::move(*more)});
    }
    if (Status written = writeAll(outputs); !written) return written;
    std::printf("%s: standard error %.3g\n", picture.c_str(), solved.standardError());
    return Done{};
}

} // namespace lucent::cli
