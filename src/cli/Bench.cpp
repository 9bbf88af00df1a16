// lucent bench: speed against error, side by side in one run.
#include "cli/Command.h"
#include "cli/Files.h"

#include "frame/Renderer.h"
#include "gl/Context.h"
#include "measure/ReliefBench.h"
#include "scene/Load.h"
#include "scene/readers/Readers.h"

#include <cstdio>
#include <fstream>
#include <memory>

namespace lucent::cli {

namespace {

struct Options {
    std::vector<std::string> scenes;
    bool quick = false;
    std::string output;
};

/// Resident memory of this process in bytes, as the kernel counts it.
std::size_t residentBytes(const char* key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.rfind(key, 0) == 0) return std::stoul(line.substr(line.find_first_of("0123456789"))) * 1024;
    return 0;
}

// The heights of a scene's first object, for a field 1 m wide.
Result<measure::BenchField> fieldOf(const std::string& path) {
    const Result<scene::Scene> scene = scene::load(path, scene::plainFiles(), frame::techniques());
    if (!scene) return scene.error();
    const scene::Object& object = scene->objects.front();
    return measure::BenchField{object.name, object.shape.heights,
                               object.shape.heightScale / object.shape.width};
}

Status bench(const Options& options) {
    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    const std::size_t empty = residentBytes("VmRSS:");
    std::vector<measure::BenchField> fields{{"noise", measure::benchNoise(512), 0.12f}};
    for (const std::string& path : options.scenes) {
        Result<measure::BenchField> field = fieldOf(path);
        if (!field) return field.error();
        fields.push_back(std::move(*field));
    }
    {
        // One picture of 512 x 512 pixels before anything larger touches the memory.
        const Status drawn = measure::drawOnce(**context, fields.front());
        if (!drawn) return drawn;
    }
    const std::size_t drawn = residentBytes("VmHWM:");
    const Result<measure::ReliefReport> report =
        measure::benchRelief(**context, fields, options.quick, [](const std::string& line) {
            std::fprintf(stderr, "bench: %s\n", line.c_str());
        });
    if (!report) return report.error();
    std::printf("%s  memory: %.0f MB resident with a context alone, %.0f MB at most with a 512^2 relief "
                "(target 256)\n",
                report->text().c_str(), double(empty) / (1 << 20), double(drawn) / (1 << 20));
    if (options.output.empty()) return Done{};
    return writeAll({{options.output, toBytes(report->json())}});
}

} // namespace

Command addBench(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("bench", "Measures speed against error, all methods in one run");
    const auto options = std::make_shared<Options>();
    parser->add_option("SCENE", options->scenes,
                       "Scenes whose height fields are measured beside synthetic noise");
    parser->add_flag("--quick", options->quick, "Fewer repeats, no field above 2048 texels");
    parser->add_option("-o,--output", options->output, "Also writes the figures as JSON");
    parser->footer("Examples:\n"
                   "  lucent bench --quick\n"
                   "  lucent bench elevation.json dragon.json -o relief.json");
    return {parser, [options] { return bench(*options); }};
}

} // namespace lucent::cli
