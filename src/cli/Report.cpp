// lucent report: several benchmark reports on one page.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/ReportPage.h"

#include <memory>

namespace lucent::cli {

namespace {
struct ReportOptions {
    std::vector<std::string> reports;
    std::string output;
};

Status report(const ReportOptions& options) {
    if (Status possible = checkOutputs({options.output}, options.reports); !possible) return possible;
    std::vector<std::string> reports;
    for (const std::string& path : options.reports) {
        const Result<Bytes> bytes = readFile(path);
        if (!bytes) return bytes.error();
        reports.emplace_back(reinterpret_cast<const char*>(bytes->data()), bytes->size());
        if (Status checked = checkReport(reports.back(), path); !checked) return checked;
    }
    const Result<std::string> page = reportPage(reports);
    if (!page) return page.error();
    return writeAll({{options.output, toBytes(*page)}});
}
} // namespace

Command addReport(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("report", "Puts benchmark reports side by side on one page");
    const auto options = std::make_shared<ReportOptions>();
    parser->add_option("JSON", options->reports, "What lucent bench, the page or a peer's script wrote")
        ->required();
    addOutput(*parser, options->output, "The page: one HTML file that needs no other");
    parser->footer("Example:\n"
                   "  lucent report native/bench.json browser.json peers.json -o report.html");
    return {parser, [options] { return report(*options); }};
}

} // namespace lucent::cli
