// lucent bench: speed against error, side by side in one run.
#include "cli/Command.h"
#include "cli/ComposeReport.h"
#include "cli/Files.h"
#include "cli/ProgressBar.h"
#include "cli/ReportPage.h"
#include "cli/TruthCache.h"

#include "BuildInfo.h"
#include "base/Text.h"
#include "frame/Renderer.h"
#include "gl/Context.h"
#include "measure/Solve.h"
#include "measure/Steps.h"
#include "measure/TechniqueBench.h"
#include "scene/Load.h"
#include "scene/readers/Readers.h"
#include "technique/Technique.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <thread>

namespace lucent::cli {

namespace fs = std::filesystem;

namespace {

struct BenchOptions {
    std::vector<std::string> parts;
    bool quick = false;
    std::string cells;
    std::string output;
    std::string gallery = "assets/generated/gallery";
    std::string meshes = "assets/generated/meshes";
    std::string truths;
    std::string commit = LUCENT_COMMIT;
};

// Of no technique: tables of their own.
constexpr std::string_view kCompose = "compose", kSteps = "steps";

struct Parts {
    std::vector<const measure::BenchPart*> measured;
    bool compose = false, steps = false;
};

// --- the machine

/// The rest of the first line of a file of the kernel that begins with `key`, from its value on; "" without.
std::string kernelValue(const char* file, const std::string& key) {
    std::ifstream lines(file);
    for (std::string line; std::getline(lines, line);) {
        if (line.rfind(key, 0) != 0) continue;
        const std::size_t value = line.find_first_not_of(" \t:", key.size());
        return value == std::string::npos ? "" : line.substr(value);
    }
    return "";
}

/// A figure in kB of the kernel, in MB; 0 when it is not there.
double megabytes(const char* file, const std::string& key) {
    return std::strtod(kernelValue(file, key).c_str(), nullptr) / 1024;
}

void describeMachine(measure::Machine& machine) {
    machine.cpu = kernelValue("/proc/cpuinfo", "model name");
    machine.cores = int(std::thread::hardware_concurrency());
    machine.memoryMB = megabytes("/proc/meminfo", "MemTotal");
}

std::string today() {
    const std::time_t now = std::time(nullptr);
    char date[16];
    std::strftime(date, sizeof date, "%F", std::gmtime(&now));
    return date;
}

// --- what is measured

Result<Parts> parseParts(std::vector<std::string> names) {
    if (names.empty()) names = {"all"};
    Parts parts;
    for (const std::string& name : names) {
        const auto found = measure::benchParts(name);
        if (found.empty() && name != kCompose && name != kSteps) {
            std::string known = "all";
            for (const measure::BenchPart* part : measure::benchParts())
                known += ", " + std::string(part->name);
            return Error{"NAMES: is " + inQuotes(name) + "; must be one of " + known + ", " +
                         std::string(kCompose) + ", " + std::string(kSteps)};
        }
        parts.compose |= name == kCompose;
        parts.steps |= name == kSteps;
        for (const measure::BenchPart* part : found)
            if (std::find(parts.measured.begin(), parts.measured.end(), part) == parts.measured.end())
                parts.measured.push_back(part);
    }
    return parts;
}

// The field halved by leaving samples out until it fits.
std::shared_ptr<const Image> thinned(std::shared_ptr<const Image> heights, int side) {
    while (std::max(heights->width, heights->height) > side) {
        auto half = std::make_shared<Image>((heights->width + 1) / 2, (heights->height + 1) / 2, 1);
        for (int y = 0; y < half->height; ++y)
            for (int x = 0; x < half->width; ++x)
                *half->at(x, y) = *heights->at(2 * x, 2 * y);
        heights = std::move(half);
    }
    return heights;
}

// The heights of a gallery scene's first height field, for a field 1 m wide with at most `side` texels a
// side.
Result<measure::BenchField> fieldOf(const std::string& path, int side) {
    const Result<scene::Scene> scene = scene::load(path, scene::plainFiles(path), technique::tables());
    if (!scene) return scene.error();
    for (const scene::Object& object : scene->objects)
        if (const auto* field = std::get_if<scene::HeightField>(&object.shape))
            return measure::BenchField{fs::path(path).stem().string(), thinned(field->heights, side),
                                       field->heightScale / field->width};
    return Error{path + ": has no height field; must have one to measure relief on"};
}

Result<measure::BenchEnvironment> environmentOf(const std::string& path) {
    const Result<Bytes> bytes = scene::plainFiles(path)(path);
    if (!bytes) return bytes.error();
    const auto map = scene::loadEnvironmentMap(path, *bytes);
    if (!map) return map.error();
    return measure::BenchEnvironment{fs::path(path).filename().string(), *map};
}

// The first mesh of a model.
Result<measure::BenchMesh> meshOf(const std::string& path) {
    const Result<Bytes> bytes = scene::plainFiles(path)(path);
    if (!bytes) return bytes.error();
    Result<scene::Mesh> mesh = scene::decodeMesh(*bytes, path);
    if (!mesh) return mesh.error();
    if (!mesh->parts.empty()) *mesh = scene::partOf(*mesh, mesh->parts.front());
    if (mesh->normals.empty()) mesh->normals = scene::areaWeightedNormals(mesh->positions, mesh->indices);
    return measure::BenchMesh{fs::path(path).stem().string(),
                              std::make_shared<scene::Mesh>(std::move(*mesh))};
}

// The gallery's files; what is not there is said and left out.
class Gallery : public measure::BenchAssets {
public:
    explicit Gallery(const BenchOptions& options) : folders_{options.gallery, options.meshes} {}

    Result<std::vector<measure::BenchField>> fields(Names names, int side) const override {
        return each<measure::BenchField>(names, ".json",
                                         [side](const std::string& path) { return fieldOf(path, side); });
    }
    Result<std::vector<measure::BenchEnvironment>> environments(Names names) const override {
        return each<measure::BenchEnvironment>(names, "", environmentOf);
    }
    Result<std::vector<measure::BenchMesh>> meshes(Names names) const override {
        return each<measure::BenchMesh>(names, ".glb", meshOf);
    }

private:
    template <class Asset, class Read>
    Result<std::vector<Asset>> each(Names names, const char* ending, const Read& read) const {
        std::vector<Asset> found;
        for (const std::string_view name : names) {
            const std::string file = std::string(name) + ending;
            const auto folder = std::find_if(folders_.begin(), folders_.end(),
                                             [&](const fs::path& one) { return fs::exists(one / file); });
            if (folder == folders_.end()) {
                std::fprintf(stderr, "bench: %s: is not there and left out\n",
                             (folders_.front() / file).c_str());
                continue;
            }
            Result<Asset> asset = read((*folder / file).string());
            if (!asset) return asset.error();
            found.push_back(std::move(*asset));
        }
        return found;
    }

    std::array<fs::path, 2> folders_;
};

// --- the run

/// Memory that one picture of a relief of 512 x 512 texels takes: before anything larger touches any.
Status drawOnce(gl::Context& context) {
    scene::Scene scene = measure::fieldScene(measure::benchNoise(512), 0.03f);
    scene.lights.emplace_back(scene::PointLight{});
    frame::Renderer renderer(context);
    if (Status done = renderer.finish(scene, 1, scene.size); !done) return done;
    renderer.wait();
    return Done{};
}

// Whole solutions, kept in a folder.
measure::SolveTruth solvingOnce(const std::string& truths) {
    return [truths](const scene::Scene& scene, int directions, const truth::Tile& rows) {
        return cachedTruth(truthPath(truths, scene, directions),
                           [&] { return measure::solveWhatIsShown(scene, directions, rows, 0); });
    };
}

measure::BenchReport runPlan(gl::Context& context, measure::Plan plan, const measure::SolveTruth& solveOnce) {
    plan.truthParts = 1;
    const auto start = std::chrono::steady_clock::now();
    std::unique_ptr<measure::Sweep> sweep;
    const auto say = [&](const std::string& what) {
        const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
        std::fprintf(stderr, "bench: %s  %s\n", progressLine(sweep->share(), elapsed.count()).c_str(),
                     what.c_str());
    };
    sweep = std::make_unique<measure::Sweep>(context, std::move(plan), solveOnce, say);
    while (sweep->step())
        ;
    return sweep->report();
}

measure::Say saying(std::string_view part) {
    return [name = std::string(part)](const std::string& line) {
        std::fprintf(stderr, "bench: %s: %s\n", name.c_str(), line.c_str());
    };
}

// Figures that no sweep finds go into the report; what stands behind them into a file of the part's name.
Status prove(const measure::BenchPart& part, const measure::BenchRun& run, const std::string& folder,
             measure::BenchReport& report) {
    const Result<measure::Proof> proof = part.prove(run);
    if (!proof) return proof.error();
    std::fputs(proof->text.c_str(), stdout);
    report.ratios.insert(report.ratios.end(), proof->ratios.begin(), proof->ratios.end());
    if (proof->json.empty()) return Done{};
    return writeAll({{folder + "/" + std::string(part.name) + ".json", toBytes(proof->json)}});
}

// How long a page stands still while it draws the gallery's scenes, into steps.json.
Status benchSteps(gl::Context& context, const BenchOptions& options) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (const fs::directory_entry& file : fs::directory_iterator(options.gallery, failed))
        if (file.path().extension() == ".json") files.push_back(file.path());
    if (failed) return Error{options.gallery + ": cannot be read (" + failed.message() + ")"};
    std::sort(files.begin(), files.end());
    std::vector<measure::StepTimes> times;
    for (const fs::path& file : files) {
        const Result<scene::Scene> scene =
            scene::load(file.string(), scene::plainFiles(file.string()), technique::tables());
        if (!scene) continue; // lists and strokes lie there as well
        times.push_back(measure::timeSteps(context, file.stem().string(), *scene));
        saying(kSteps)(times.back().scene);
    }
    std::fputs(measure::stepsText(times).c_str(), stdout);
    return writeAll({{options.output + "/steps.json", toBytes(measure::stepsJson(times))}});
}

Status bench(const BenchOptions& options) {
    const Result<Parts> parts = parseParts(options.parts);
    if (!parts) return parts.error();
    const Gallery gallery(options);
    Result<measure::Plan> plan = measure::planOf(parts->measured, gallery, options.quick);
    if (!plan) return plan.error();
    const fs::path folder = options.output;
    const std::string truths = options.truths.empty() ? (folder / "truths").string() : options.truths;
    for (const fs::path& needed : {folder, fs::path(truths)}) {
        std::error_code failed;
        fs::create_directories(needed, failed);
        if (failed)
            return Error{needed.string() + ": cannot be made (" + failed.message() +
                         "); must be a folder, or a place where one can be made"};
    }

    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();
    const double contextMB = megabytes("/proc/self/status", "VmRSS");
    if (Status drawn = drawOnce(**context); !drawn) return drawn;
    const double peakMB = megabytes("/proc/self/status", "VmHWM");

    const measure::SolveTruth solveOnce = solvingOnce(truths);
    measure::BenchReport report = runPlan(**context, std::move(*plan), solveOnce);
    describeMachine(report.machine);
    report.date = today();
    report.commit = options.commit;
    report.contextMB = contextMB;
    report.peakMB = peakMB;
    for (const measure::BenchPart* part : parts->measured)
        if (part->prove)
            if (Status proved =
                    prove(*part, {**context, gallery, solveOnce, saying(part->name), options.quick},
                          options.output, report);
                !proved)
                return proved;
    if (parts->compose)
        if (Status proved = benchCompose(**context, options.output, options.quick, options.cells); !proved)
            return proved;
    if (parts->steps)
        if (Status timed = benchSteps(**context, options); !timed) return timed;
    report.ratios.push_back({"MB resident with a relief of 512^2 texels", peakMB, 256, false});
    std::fputs(report.text().c_str(), stdout);
    // The figures first: minutes of measuring are not lost with a page that cannot be made.
    const std::string json = report.json();
    if (Status written = writeAll({{(folder / "bench.json").string(), toBytes(json)}}); !written)
        return written;
    const Result<std::string> page = reportPage({json});
    if (!page) return page.error();
    return writeAll({{(folder / "report.html").string(), toBytes(*page)}});
}

std::string partsHelp() {
    std::string usual, text;
    const auto add = [&](std::string_view name, std::string_view help) {
        text += measure::formatted("  %-14s%s\n", std::string(name).c_str(), std::string(help).c_str());
    };
    for (const measure::BenchPart* part : measure::benchParts()) {
        if (part->isUsual) usual += (usual.empty() ? "" : ", ") + std::string(part->name);
        add(part->name, part->help);
    }
    add(kCompose, "every lamp past everything on everything");
    add(kSteps, "how long a page stands still while it draws the gallery");
    add("all", usual);
    return "Parts:\n" + text + "\n";
}

} // namespace

Command addBench(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("bench", "Measures speed against error, all methods in one run");
    const auto options = std::make_shared<BenchOptions>();
    parser->add_option("NAMES", options->parts, "Parts, as listed below; all without");
    parser->add_flag("--quick", options->quick, "Smaller scenes, fewer repeats: two minutes without a GPU");
    parser->add_option("-o,--output", options->output, "Folder for bench.json and report.html")
        ->required()
        ->type_name("DIR");
    parser
        ->add_option("--gallery", options->gallery,
                     "Folder with scenes, light probes and meshes to measure on")
        ->capture_default_str()
        ->type_name("DIR");
    parser->add_option("--meshes", options->meshes, "Folder with more meshes")
        ->capture_default_str()
        ->type_name("DIR");
    parser
        ->add_option("--truths", options->truths,
                     "Folder where exact solutions are kept for the next run; else truths in the output's")
        ->type_name("DIR");
    parser
        ->add_option("--cells", options->cells,
                     "Of compose: only cells whose name, as \"spot / water / matt mesh\", contains this")
        ->type_name("TEXT");
    parser->add_option("--commit", options->commit, "What was built, for the report's header")
        ->capture_default_str();
    parser->footer(partsHelp() + "Examples:\n"
                                 "  lucent bench --quick -o build/bench\n"
                                 "  lucent bench relief environment -o build/bench\n"
                                 "  lucent bench compose -o build/compose\n"
                                 "  lucent bench compose --cells \"glass ball\" -o build/compose");
    return {parser, [options] { return bench(*options); }};
}

} // namespace lucent::cli
