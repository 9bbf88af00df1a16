// lucent merge: the parts of a truth become one picture.
#include "cli/Command.h"
#include "cli/TruthOutput.h"

#include "truth/Part.h"

#include <memory>
#include <string>
#include <vector>

namespace lucent::cli {

namespace {
struct MergeOptions {
    std::vector<std::string> parts;
    TruthOutput output;
};

Status merge(const MergeOptions& options) {
    if (Status possible = options.output.check(options.parts); !possible) return possible;
    std::vector<truth::Part> parts;
    for (const std::string& path : options.parts) {
        const Result<Bytes> bytes = readFile(path);
        if (!bytes) return bytes.error();
        Result<truth::Part> part = truth::decodePart(*bytes, path);
        if (!part) return part.error();
        parts.push_back(std::move(*part));
    }
    const Result<truth::Picture> picture = truth::merge(parts, options.parts);
    if (!picture) return picture.error();
    return options.output.write(parts.front().facts, *picture);
}
} // namespace

Command addMerge(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("merge", "Puts the parts of a truth together");
    const auto options = std::make_shared<MergeOptions>();
    parser->add_option("PARTS", options->parts, "Files of lucent truth --tile, in any order")->required();
    options->output.addTo(*parser);
    parser->footer(
        "The picture is, bit by bit, the one that lucent truth makes in one piece. Parts of other\n"
        "pictures, parts given twice and missing parts are refused.\n\n"
        "Example:\n"
        "  lucent merge coin-*.tile -o truth.pfm");
    return {parser, [options] { return merge(*options); }};
}

} // namespace lucent::cli
