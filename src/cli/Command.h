#pragma once
/// The commands of the program: each adds its options to the parser and says what to do with them.

#include "base/Result.h"

#include <CLI/CLI.hpp>

#include <functional>

namespace lucent::cli {

struct Command {
    CLI::App* parser;            ///< knows whether the command was given
    std::function<Status()> run; ///< after parsing
};

Command addRender(CLI::App& program);
Command addTruth(CLI::App& program);
Command addMerge(CLI::App& program);
Command addCompare(CLI::App& program);
Command addExplain(CLI::App& program);
Command addList(CLI::App& program);
Command addConvert(CLI::App& program);
Command addPaint(CLI::App& program);
Command addTabulate(CLI::App& program);
Command addBake(CLI::App& program);
Command addSchema(CLI::App& program);
Command addBench(CLI::App& program);
Command addReport(CLI::App& program);
Command addSelfCheck(CLI::App& program);

} // namespace lucent::cli
