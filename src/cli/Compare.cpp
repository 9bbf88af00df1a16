// lucent compare: how far one picture is from another.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/JsonWriter.h"
#include "measure/Flip.h"
#include "measure/Metrics.h"
#include "measure/Ssim.h"
#include "scene/Json.h"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>

namespace lucent::cli {

namespace {
struct CompareOptions {
    std::string image, reference, heatMap, flipMap, mask;
    bool json = false;
};

/// What compare finds out about two pictures.
struct Findings {
    measure::Metrics metrics;
    measure::Flip flip, hdrFlip;
    std::optional<double> truthNoise; ///< standard error of the reference, RMS, where its maker wrote it down
    bool tooNoisy() const { return truthNoise && metrics.rmse < 3 * *truthNoise; }
};

std::string findingsJson(const Findings& found) {
    JsonWriter json;
    json.beginObject();
    writeMembers(json, found.metrics);
    json.key("relMseEpsilon").value(measure::kRelMseEpsilon);
    json.key("maxAt").beginArray();
    json.value(found.metrics.maximumAt.x).value(found.metrics.maximumAt.y).end();
    json.key("hdrFlip").value(found.hdrFlip.mean).key("hdrFlipExposures").beginArray();
    json.value(found.hdrFlip.start).value(found.hdrFlip.stop).end();
    if (found.truthNoise)
        json.key("truthNoise").value(*found.truthNoise).key("truthTooNoisy").value(found.tooNoisy());
    json.end();
    return json.text();
}

void printFindings(const Findings& found) {
    const measure::Metrics& metrics = found.metrics;
    std::printf("RMSE        %.6g\n", metrics.rmse);
    std::printf("  over mean %.6g\n", metrics.relRmse);
    std::printf("relMSE      %.6g  (epsilon %g)\n", metrics.relMse, measure::kRelMseEpsilon);
    std::printf("MAE         %.6g\n", metrics.mae);
    std::printf("median      %.6g\n", metrics.p50);
    std::printf("90th perc.  %.6g\n", metrics.p90);
    std::printf("99th perc.  %.6g\n", metrics.p99);
    std::printf("max         %.6g  at pixel (%d, %d)\n", metrics.maximum, metrics.maximumAt.x,
                metrics.maximumAt.y);
    std::printf("PSNR        %.6g dB\n", metrics.psnr);
    std::printf("SSIM        %.6g\n", *metrics.ssim);
    std::printf("FLIP        %.6g  (as displayed, %.0f pixels per degree)\n", found.flip.mean,
                measure::defaultPixelsPerDegree());
    std::printf("HDR-FLIP    %.6g  (%d exposures from %.2f to %.2f stops)\n", found.hdrFlip.mean,
                found.hdrFlip.exposures, found.hdrFlip.start, found.hdrFlip.stop);
    std::printf("bias        %.6g\n", metrics.bias);
    std::printf("flux ratio  %.6g\n", metrics.fluxRatio);
    if (!found.truthNoise) return;
    std::printf("truth noise %.6g\n", *found.truthNoise);
    if (found.tooNoisy())
        std::printf(
            "The reference is too noisy to judge: the difference is below 3 times its standard error\n");
}

/// The standard error that the maker of a reference wrote beside it, in FILE.json; nothing without one.
Result<std::optional<double>> noiseOf(const std::string& reference) {
    const std::string path = reference + ".json";
    std::error_code ignored;
    if (!std::filesystem::exists(path, ignored)) return std::optional<double>();
    const Result<Bytes> bytes = readFile(path);
    if (!bytes) return bytes.error();
    const Result<scene::Json> facts = scene::parseJson(*bytes, path);
    if (!facts) return facts.error();
    const scene::Json* noise = facts->find("standardError");
    if (!noise) return std::optional<double>();
    if (noise->type != scene::Json::Type::Number || noise->number < 0)
        return Error{path + ":" + std::to_string(noise->line) + ": standardError is " + noise->describe() +
                     "; must be a number of at least 0"};
    return std::optional(noise->number);
}

/// The picture of --mask; nothing without one.
Result<std::optional<Image>> maskOf(const CompareOptions& options, const Image& image) {
    if (options.mask.empty()) return std::optional<Image>();
    Result<Image> mask = readImage(options.mask, Encoding::Linear);
    if (!mask) return mask.error();
    if (mask->size() != image.size())
        return Error{options.mask + ": has " + std::to_string(mask->width) + "x" +
                     std::to_string(mask->height) + " pixels; must have " + std::to_string(image.width) +
                     "x" + std::to_string(image.height) + " like " + options.image};
    return std::optional(std::move(*mask));
}

/// FLIP's map as colours: an error of 1 is the lightest.
Result<Bytes> flipPicture(const Findings& found, const std::string& path) {
    // Values above 1 are not displayed as they are: there the exposures tell more.
    const Image& map = found.hdrFlip.mean > found.flip.mean ? found.hdrFlip.map : found.flip.map;
    return encode(measure::heatMap(map, Image(map.width, map.height, 1), 1), path);
}

Status checkComparePaths(const CompareOptions& options) {
    const std::vector<std::string> outputs{options.heatMap, options.flipMap};
    for (const std::string& output : outputs)
        if (!output.empty())
            if (Status known = checkImageEnding(output); !known) return known;
    return checkOutputs(outputs, {options.image, options.reference, options.mask});
}

Status compare(const CompareOptions& options) {
    if (Status possible = checkComparePaths(options); !possible) return possible;
    const Result<Image> image = readImage(options.image, Encoding::Srgb);
    if (!image) return image.error();
    const Result<Image> reference = readImage(options.reference, Encoding::Srgb);
    if (!reference) return reference.error();
    const Result<std::optional<double>> noise = noiseOf(options.reference);
    if (!noise) return noise.error();
    const Result<std::optional<Image>> mask = maskOf(options, *image);
    if (!mask) return mask.error();
    const auto metrics =
        measure::compare(*image, options.image, *reference, options.reference, *mask ? &**mask : nullptr);
    if (!metrics) return metrics.error();
    Findings found{*metrics, measure::flip(*image, *reference), measure::hdrFlip(*image, *reference), *noise};
    found.metrics.ssim = measure::ssim(*image, *reference);
    found.metrics.flip = found.flip.mean;

    std::vector<Output> outputs;
    if (!options.heatMap.empty()) {
        const double full = metrics->maximum > 0 ? metrics->maximum : 1;
        Result<Bytes> encoded = encode(measure::heatMap(*image, *reference, full), options.heatMap);
        if (!encoded) return encoded.error();
        outputs.push_back({options.heatMap, std::move(*encoded)});
    }
    if (!options.flipMap.empty()) {
        Result<Bytes> encoded = flipPicture(found, options.flipMap);
        if (!encoded) return encoded.error();
        outputs.push_back({options.flipMap, std::move(*encoded)});
    }
    if (Status written = writeAll(outputs); !written) return written;
    if (options.json)
        std::fputs(findingsJson(found).c_str(), stdout);
    else
        printFindings(found);
    return Done{};
}
} // namespace

Command addCompare(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("compare", "Measures how far one picture is from another");
    const auto options = std::make_shared<CompareOptions>();
    parser->add_option("A", options->image, "Picture to judge")->required();
    parser->add_option("B", options->reference, "Reference it is measured against")->required();
    parser->add_flag("--json", options->json, "Prints JSON");
    parser
        ->add_option("--heatmap,--heat", options->heatMap,
                     "Writes the differences as colours, the largest lightest")
        ->type_name("FILE");
    parser->add_option("--flip", options->flipMap, "Writes how visible the difference is, as colours")
        ->type_name("FILE");
    parser
        ->add_option("--mask", options->mask,
                     "Counts only pixels where the last channel of this picture is above 0; SSIM and FLIP\n"
                     "see all")
        ->type_name("FILE");
    parser->footer(
        "Linear values of all pixels are compared, red, green and blue alike; integer files are decoded\n"
        "from the sRGB curve. Alpha is not looked at. FLIP is that of the pictures as displayed, HDR-FLIP\n"
        "the largest over exposures; --flip draws the larger of both. Where lucent truth left B.json beside\n"
        "B, the noise of the reference is told, and whether it is too large to judge.\n\n"
        "Examples:\n"
        "  lucent compare coin.exr truth.pfm\n"
        "  lucent compare coin.exr truth.pfm --json --heatmap where.png");
    return {parser, [options] { return compare(*options); }};
}

} // namespace lucent::cli
