// lucent schema: the JSON Schema of scene files.
#include "cli/Command.h"

#include "frame/Renderer.h"
#include "scene/Load.h"
#include "technique/Technique.h"

#include <cstdio>

namespace lucent::cli {

Command addSchema(CLI::App& program) {
    CLI::App* parser = program.add_subcommand("schema", "Prints the JSON Schema of scene files");
    parser->footer("Example:\n"
                   "  lucent schema > lucent.schema.json");
    return {parser, []() -> Status {
                std::fputs(scene::jsonSchema(technique::tables()).c_str(), stdout);
                return Done{};
            }};
}

} // namespace lucent::cli
