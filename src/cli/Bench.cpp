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
#include "measure/BudgetProof.h"
#include "measure/CausticsPlan.h"
#include "measure/GlassProof.h"
#include "measure/RefractPlan.h"
#include "measure/ReliefPlan.h"
#include "measure/Solve.h"
#include "measure/SubsurfacePlan.h"
#include "scene/Load.h"
#include "scene/readers/Readers.h"
#include "technique/Technique.h"

#include <algorithm>
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
    std::string output;
    std::string gallery = "assets/generated/gallery";
    std::string meshes = "assets/generated/meshes";
    std::string truths;
    std::string commit = LUCENT_COMMIT;
};

constexpr std::string_view kParts[] = {"relief", "environment",  "scaling",  "hard",
                                       "all",    "refraction",   "caustics", "subsurface",
                                       "budget", "budget-glass", "compose"};

struct Parts {
    measure::ReliefParts relief;
    bool refraction = false, caustics = false, subsurface = false, glassBudget = false, compose = false;
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

Result<Parts> parseParts(const std::vector<std::string>& names) {
    if (names.empty()) return Parts{};
    Parts parts{{false, false, false, false}};
    for (const std::string& name : names) {
        if (std::find(std::begin(kParts), std::end(kParts), name) == std::end(kParts)) {
            std::string known;
            for (const std::string_view part : kParts)
                known += (known.empty() ? "" : ", ") + std::string(part);
            return Error{"NAMES: is " + inQuotes(name) + "; must be one of " + known};
        }
        const bool all = name == "all";
        parts.relief.relief |= all || name == "relief";
        parts.relief.environment |= all || name == "environment";
        parts.relief.scaling |= all || name == "scaling";
        parts.relief.hard |= all || name == "hard";
        parts.relief.budget |= name == "budget";
        parts.glassBudget |= name == "budget-glass";
        parts.refraction |= name == "refraction";
        parts.caustics |= name == "caustics";
        parts.subsurface |= name == "subsurface";
        parts.compose |= name == "compose";
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

Result<measure::Plan> makeReliefPlan(const BenchOptions& options, const measure::ReliefParts& parts) {
    std::vector<measure::BenchField> fields;
    std::vector<measure::BenchEnvironment> environments;
    if (!parts.relief && !parts.environment && !parts.scaling && !parts.hard)
        return measure::reliefPlan(parts, fields, environments, options.quick);
    if (!fs::is_directory(options.gallery)) {
        std::fprintf(stderr, "bench: %s: is no folder; elevation, dragon and sunset are left out\n",
                     options.gallery.c_str());
        return measure::reliefPlan(parts, fields, environments, options.quick);
    }
    for (const char* name : {"elevation.json", "dragon.json"}) {
        Result<measure::BenchField> field = fieldOf(options.gallery + "/" + name, options.quick ? 256 : 4096);
        if (!field) return field.error();
        fields.push_back(std::move(*field));
    }
    Result<measure::BenchEnvironment> sunset = environmentOf(options.gallery + "/sunset.hdr");
    if (!sunset) return sunset.error();
    environments.push_back(std::move(*sunset));
    return measure::reliefPlan(parts, fields, environments, options.quick);
}

// The first mesh of a file that make_assets left; nothing when it is not there.
Result<std::optional<measure::BenchMesh>> meshOf(const std::string& path) {
    const std::string name = fs::path(path).stem().string();
    if (!fs::exists(path)) {
        std::fprintf(stderr, "bench: %s: is not there; %s is left out\n", path.c_str(), name.c_str());
        return std::optional<measure::BenchMesh>();
    }
    const Result<Bytes> bytes = scene::plainFiles(path)(path);
    if (!bytes) return bytes.error();
    const Result<scene::Scene> scene = scene::sceneFromMesh(path, *bytes, technique::tables());
    if (!scene) return scene.error();
    return std::optional(
        measure::BenchMesh{name, std::get<scene::MeshShape>(scene->objects.front().shape).mesh});
}

Status addMesh(const std::string& path, std::vector<measure::BenchMesh>& meshes) {
    const auto mesh = meshOf(path);
    if (!mesh) return mesh.error();
    if (*mesh) meshes.push_back(**mesh);
    return Done{};
}

// What refraction and light inside are measured on beside shapes.
struct BodyMeshes {
    std::vector<measure::BenchMesh> bunny;   // nothing where it is not there
    std::vector<measure::BenchMesh> dragons; // in several numbers of triangles; nothing where one is missing
};
Result<BodyMeshes> bodyMeshes(const BenchOptions& options) {
    BodyMeshes meshes;
    if (Status added = addMesh(options.gallery + "/bunny.glb", meshes.bunny); !added) return added.error();
    for (const std::string& path : {options.meshes + "/dragon-4k.glb", options.gallery + "/dragon-40k.glb",
                                    options.meshes + "/dragon.glb"})
        if (Status added = addMesh(path, meshes.dragons); !added) return added.error();
    if (meshes.dragons.size() < 3) meshes.dragons.clear();
    return meshes;
}

// What caustics are measured on beside shapes.
Result<std::vector<measure::BenchMesh>> causticMeshes(const BenchOptions& options) {
    std::vector<measure::BenchMesh> meshes;
    for (const std::string& path : {options.gallery + "/bunny.glb", options.gallery + "/dragon-40k.glb"})
        if (Status added = addMesh(path, meshes); !added) return added.error();
    return meshes;
}

Result<measure::Plan> makePlan(const BenchOptions& options, const Parts& parts) {
    Result<measure::Plan> plan = makeReliefPlan(options, parts.relief);
    if (plan && (parts.refraction || parts.subsurface)) {
        const Result<BodyMeshes> meshes = bodyMeshes(options);
        if (!meshes) return meshes.error();
        const auto& [bunny, dragons] = *meshes;
        if (parts.refraction) append(*plan, measure::refractPlan(bunny, dragons, options.quick));
        if (parts.subsurface) append(*plan, measure::subsurfacePlan(bunny, dragons, options.quick));
    }
    if (plan && parts.caustics) {
        const auto meshes = causticMeshes(options);
        if (!meshes) return meshes.error();
        append(*plan, measure::causticsPlan(*meshes, options.quick));
    }
    return plan;
}

// --- the run

/// Memory that one picture of a relief of 512 x 512 texels takes: before anything larger touches any.
Status drawOnce(gl::Context& context) {
    scene::Scene scene = measure::fieldScene(measure::benchNoise(512), 0.03f);
    scene.lights.push_back(scene::PointLight{});
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

measure::Say saying(const std::string& part) {
    return [part](const std::string& line) {
        std::fprintf(stderr, "bench: %s: %s\n", part.c_str(), line.c_str());
    };
}

// The proof of quality.maxError on the gallery's fields and light probes and on synthetic ones; its totals go
// into the report, each result into budget.json.
Status proveBudget(gl::Context& context, const BenchOptions& options, measure::BenchReport& report) {
    constexpr int kSide = 96, kFieldSide = 128; // pixels, texels
    std::vector<measure::BenchField> fields;
    for (const char* name : {"elevation", "dragon", "coin", "weave", "bunny"}) {
        Result<measure::BenchField> field = fieldOf(options.gallery + "/" + name + ".json", kFieldSide);
        if (!field) return field.error();
        fields.push_back(std::move(*field));
    }
    Result<measure::BenchEnvironment> window = environmentOf(options.gallery + "/window.exr");
    if (!window) return window.error();
    const Result<measure::BudgetReport> proof =
        measure::proveBudget(context, fields, {*window}, kSide, saying("budget"));
    if (!proof) return proof.error();
    std::fputs(proof->text().c_str(), stdout);
    const std::vector<measure::Ratio> totals = proof->totals();
    report.ratios.insert(report.ratios.end(), totals.begin(), totals.end());
    return writeAll({{options.output + "/budget.json", toBytes(proof->json())}});
}

// The same for light through glass.
Status proveGlass(gl::Context& context, const BenchOptions& options, measure::BenchReport& report) {
    constexpr int kSide = 96; // pixels
    Result<measure::BenchEnvironment> window = environmentOf(options.gallery + "/window.exr");
    if (!window) return window.error();
    const Result<measure::BudgetReport> proof =
        measure::proveGlassBudget(context, {*window}, kSide, saying("budget of glass"));
    if (!proof) return proof.error();
    std::fputs(proof->text().c_str(), stdout);
    const std::vector<measure::Ratio> totals = proof->totals();
    report.ratios.insert(report.ratios.end(), totals.begin(), totals.end());
    return writeAll({{options.output + "/budget-glass.json", toBytes(proof->json())}});
}

// Figures that are no pictures', into the report.
Status add(const Result<std::vector<measure::Ratio>>& ratios, measure::BenchReport& report) {
    if (!ratios) return ratios.error();
    report.ratios.insert(report.ratios.end(), ratios->begin(), ratios->end());
    return Done{};
}
Status proveCaustics(gl::Context& context, const BenchOptions& options, measure::BenchReport& report) {
    const auto meshes = causticMeshes(options);
    if (!meshes) return meshes.error();
    return add(measure::proveCaustics(context, *meshes, options.quick, saying("caustics")), report);
}
Status proveSubsurface(gl::Context& context, const BenchOptions& options,
                       const measure::SolveTruth& solveOnce, measure::BenchReport& report) {
    const Result<BodyMeshes> meshes = bodyMeshes(options);
    if (!meshes) return meshes.error();
    return add(
        measure::proveSubsurface(context, meshes->bunny, solveOnce, options.quick, saying("subsurface")),
        report);
}

Status bench(const BenchOptions& options) {
    const Result<Parts> parts = parseParts(options.parts);
    if (!parts) return parts.error();
    Result<measure::Plan> plan = makePlan(options, *parts);
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
    if (parts->relief.budget)
        if (Status proved = proveBudget(**context, options, report); !proved) return proved;
    if (parts->glassBudget)
        if (Status proved = proveGlass(**context, options, report); !proved) return proved;
    if (parts->caustics)
        if (Status proved = proveCaustics(**context, options, report); !proved) return proved;
    if (parts->subsurface)
        if (Status proved = proveSubsurface(**context, options, solveOnce, report); !proved) return proved;
    if (parts->compose)
        if (Status proved = benchCompose(**context, options.output, options.quick); !proved) return proved;
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

} // namespace

Command addBench(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("bench", "Measures speed against error, all methods in one run");
    const auto options = std::make_shared<BenchOptions>();
    parser->add_option(
        "NAMES", options->parts,
        "Parts: relief, environment, scaling, hard, all of them without; refraction; "
        "caustics; subsurface; budget; budget-glass; compose: every lamp past everything on everything");
    parser->add_flag("--quick", options->quick, "Smaller scenes, fewer repeats: two minutes without a GPU");
    parser->add_option("-o,--output", options->output, "Folder for bench.json and report.html")
        ->required()
        ->type_name("DIR");
    parser->add_option("--gallery", options->gallery, "Folder with elevation, dragon, sunset and bunny")
        ->capture_default_str()
        ->type_name("DIR");
    parser->add_option("--meshes", options->meshes, "Folder with the dragon in several numbers of triangles")
        ->capture_default_str()
        ->type_name("DIR");
    parser
        ->add_option("--truths", options->truths,
                     "Folder where exact solutions are kept for the next run; else truths in the output's")
        ->type_name("DIR");
    parser->add_option("--commit", options->commit, "What was built, for the report's header")
        ->capture_default_str();
    parser->footer("Examples:\n"
                   "  lucent bench --quick -o build/bench\n"
                   "  lucent bench relief environment -o build/bench\n"
                   "  lucent bench refraction --quick -o build/bench-refraction\n"
                   "  lucent bench caustics --quick -o build/bench-caustics\n"
                   "  lucent bench subsurface --quick -o build/bench-subsurface\n"
                   "  lucent bench compose -o build/compose   # the matrix of everything on everything\n"
                   "  lucent bench budget -o build/budget   # proves quality.maxError: half an hour\n"
                   "  lucent bench budget-glass -o build/budget-glass   # the same for light through glass");
    return {parser, [options] { return bench(*options); }};
}

} // namespace lucent::cli
