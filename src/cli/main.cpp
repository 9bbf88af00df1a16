// lucent: renders, solves and compares scenes from the command line.
//
// Exit codes: 0 done; 1 the input is wrong; 2 the machine cannot. Results go to stdout or files, messages to
// stderr.
#include "cli/Command.h"

#include "base/Text.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <unistd.h>
#include <vector>

namespace lucent::cli {

namespace {
/// Out of memory: nothing of what is under way can be finished, and there is none left to say so elegantly.
void reportNoMemory() {
    constexpr char kMessage[] = "lucent: out of memory; must have more, or a smaller scene or picture\n";
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
    _exit(int(Fault::Machine));
}

int report(const Error& error) {
    std::fprintf(stderr, "lucent: %s\n", error.message.c_str());
    return int(error.fault);
}

int reportUsage(const CLI::App& program, const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return program.exit(error); // --help and --version print themselves
    if (const auto unknown = program.remaining(); program.get_subcommands().empty() && !unknown.empty())
        return report(
            {"command: is " + inQuotes(unknown.front()) + "; must be one that lucent --help names"});
    const auto given = program.get_subcommands();
    const std::string command = given.empty() ? "lucent" : "lucent " + given.front()->get_name();
    return report({std::string(error.what()) + "; see " + command + " --help"});
}

int run(int argc, char** argv) {
    CLI::App program("Light on and in height fields, rendered in image space.", "lucent");
    program.set_version_flag("--version", LUCENT_VERSION);
    program.set_help_flag("-h,--help", "Prints this help");
    program.require_subcommand(1);
    program.footer("lucent COMMAND --help explains a command, with examples.\n"
                   "Exit codes: 0 done; 1 the input is wrong; 2 the machine cannot.");
    const std::vector<Command> commands{addRender(program),  addTruth(program),    addMerge(program),
                                        addCompare(program), addExplain(program),  addList(program),
                                        addConvert(program), addPaint(program),    addTabulate(program),
                                        addBake(program),    addSchema(program),   addBench(program),
                                        addReport(program),  addSelfCheck(program)};
    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return reportUsage(program, error);
    }
    const auto given = std::find_if(commands.begin(), commands.end(),
                                    [](const Command& command) { return command.parser->parsed(); });
    const Status done = given->run();
    return done ? 0 : report(done.error());
}
} // namespace

} // namespace lucent::cli

int main(int argc, char** argv) {
    std::set_new_handler(lucent::cli::reportNoMemory);
    return lucent::cli::run(argc, argv);
}
