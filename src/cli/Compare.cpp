// lucent compare: how far one picture is from another.
#include "cli/Command.h"
#include "cli/Files.h"

#include "base/JsonWriter.h"
#include "measure/Metrics.h"

#include <cstdio>
#include <memory>

namespace lucent::cli {

namespace {
struct CompareOptions {
    std::string image, reference, heatMap;
    bool json = false;
};

std::string metricsJson(const measure::Metrics& metrics) {
    JsonWriter json;
    json.beginObject();
    json.key("rmse").value(metrics.rmse);
    json.key("relMse").value(metrics.relMse).key("relMseEpsilon").value(measure::kRelMseEpsilon);
    json.key("mae").value(metrics.mae).key("p99").value(metrics.p99);
    json.key("max").value(metrics.maximum);
    json.key("maxAt").beginArray().value(metrics.maximumAt.x).value(metrics.maximumAt.y).end();
    json.key("psnr")
        .value(metrics.psnr)
        .key("bias")
        .value(metrics.bias)
        .key("fluxRatio")
        .value(metrics.fluxRatio);
    json.end();
    return json.text();
}

void printMetrics(const measure::Metrics& metrics) {
    std::printf("RMSE        %.6g\n", metrics.rmse);
    std::printf("relMSE      %.6g  (epsilon %g)\n", metrics.relMse, measure::kRelMseEpsilon);
    std::printf("MAE         %.6g\n", metrics.mae);
    std::printf("99th perc.  %.6g\n", metrics.p99);
    std::printf("max         %.6g  at pixel (%d, %d)\n", metrics.maximum, metrics.maximumAt.x,
                metrics.maximumAt.y);
    std::printf("PSNR        %.6g dB\n", metrics.psnr);
    std::printf("bias        %.6g\n", metrics.bias);
    std::printf("flux ratio  %.6g\n", metrics.fluxRatio);
}

Status compare(const CompareOptions& options) {
    if (!options.heatMap.empty())
        if (Status possible = checkImageOutput(options.heatMap); !possible) return possible;
    const Result<Image> image = readImage(options.image, Encoding::Srgb);
    if (!image) return image.error();
    const Result<Image> reference = readImage(options.reference, Encoding::Srgb);
    if (!reference) return reference.error();
    const auto metrics = measure::compare(*image, options.image, *reference, options.reference);
    if (!metrics) return metrics.error();

    if (!options.heatMap.empty()) {
        const double full = metrics->maximum > 0 ? metrics->maximum : 1;
        Result<Bytes> encoded = encode(measure::heatMap(*image, *reference, full), options.heatMap);
        if (!encoded) return encoded.error();
        if (Status written = writeAll({{options.heatMap, std::move(*encoded)}}); !written) return written;
    }
    if (options.json)
        std::fputs(metricsJson(*metrics).c_str(), stdout);
    else
        printMetrics(*metrics);
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
        ->add_option("--heatmap", options->heatMap, "Writes the differences as colours, the largest lightest")
        ->type_name("FILE");
    parser->footer(
        "Linear values of all pixels are compared, red, green and blue alike; integer files are decoded\n"
        "from the sRGB curve. Alpha is not looked at.\n\n"
        "Examples:\n"
        "  lucent compare coin.exr truth.pfm\n"
        "  lucent compare coin.exr truth.pfm --json --heatmap where.png");
    return {parser, [options] { return compare(*options); }};
}

} // namespace lucent::cli
