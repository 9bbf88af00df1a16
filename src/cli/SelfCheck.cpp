// lucent selfcheck: closed forms and capabilities on this machine.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/ProgressBar.h"

#include "gl/Context.h"
#include "measure/SelfCheck.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace lucent::cli {

namespace {

void printChecks(const std::vector<measure::CheckResult>& results) {
    std::printf("%-34s %12s %12s %12s\n", "closed form", "expected", "found", "tolerance");
    for (const measure::CheckResult& one : results) {
        std::printf("%-34s %12.7g %12.7g %12.2g  %s\n", std::string(one.check.name).c_str(), one.expected,
                    one.found, one.check.tolerance.value, one.passed() ? "passed" : "FAILED");
        if (!one.passed()) std::printf("    %s\n", std::string(one.check.meaning).c_str());
        if (!one.message.empty()) std::printf("    %s\n", one.message.c_str());
    }
}

void printCapabilities(const std::vector<measure::Capability>& rows) {
    for (const measure::Capability& one : rows) {
        const std::string state = one.amount.empty() ? (one.present ? "yes" : "no") : one.amount;
        std::printf("\n%s%s%s: %s\n", std::string(one.name).c_str(), one.extension.empty() ? "" : ", ",
                    std::string(one.extension).c_str(), state.c_str());
        std::printf("    used for   %s\n    without    %s\n", std::string(one.use).c_str(),
                    std::string(one.fallback).c_str());
        if (!std::isnan(one.measured))
            std::printf("    measured   %.3g: %s\n", one.measured, std::string(one.measure).c_str());
    }
}

Status selfCheck(const std::string& output) {
    if (Status possible = checkOutputs({output}, {}); !possible) return possible;
    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    measure::SelfCheck check(**context);
    {
        ProgressBar bar;
        while (check.step())
            bar.show(check.progress());
    }
    const gl::Caps& caps = (*context)->caps();
    std::printf("%s, %s\n\n", caps.renderer.c_str(), caps.version.c_str());
    printChecks(check.results());
    printCapabilities(check.capabilities());
    if (!output.empty())
        if (Status written = writeAll({{output, toBytes(check.json())}}); !written) return written;
    if (check.passed()) return Done{};
    const auto failed = std::count_if(check.results().begin(), check.results().end(),
                                      [](const measure::CheckResult& one) { return !one.passed(); });
    return Error{"selfcheck: " + std::to_string(failed) + " of " + std::to_string(check.results().size()) +
                     " closed forms fail on " + caps.renderer + "; must all pass",
                 Fault::Machine};
}

} // namespace

Command addSelfCheck(CLI::App& program) {
    CLI::App* parser = program.add_subcommand(
        "selfcheck", "Compares what this machine computes with closed forms, and measures what it can");
    const auto output = std::make_shared<std::string>();
    parser->add_option("--json", *output, "Also writes both tables as JSON")->type_name("FILE");
    parser->footer("Ends with 2 when a closed form fails.\n\n"
                   "Examples:\n"
                   "  lucent selfcheck\n"
                   "  lucent selfcheck --json machine.json");
    return {parser, [output] { return selfCheck(*output); }};
}

} // namespace lucent::cli
