/// The module of the benchmark page: the sweep of `lucent bench`, step by step, and single pictures as
/// numbers beside their truth. C functions as in Api.h; strings returned stay valid until the next call that
/// returns one.
///
/// A page makes a WebGL2 context, makes it current, calls bench_start once and puts files. Then it either
/// loads a scene and sets, draws, reads and solves it, or adds fields and environments and takes steps of the
/// sweep.

#include "base/Text.h"
#include "frame/Renderer.h"
#include "gl/Context.h"
#include "measure/Solve.h"
#include "measure/TechniqueBench.h"
#include "scene/Load.h"
#include "technique/Technique.h"
#include "web/Files.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

using namespace lucent;

namespace {

/// What the page has added.
struct Added : measure::BenchAssets {
    std::vector<measure::BenchField> ownFields;
    std::vector<measure::BenchEnvironment> ownEnvironments;

    template <class Asset>
    static Result<std::vector<Asset>> named(const std::vector<Asset>& all, Names names) {
        std::vector<Asset> found;
        for (const Asset& one : all)
            if (std::find(names.begin(), names.end(), one.name) != names.end()) found.push_back(one);
        return found;
    }
    Result<std::vector<measure::BenchField>> fields(Names names, int) const override {
        return named(ownFields, names);
    }
    Result<std::vector<measure::BenchEnvironment>> environments(Names names) const override {
        return named(ownEnvironments, names);
    }
};

struct Bench {
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<frame::Renderer> renderer;
    PutFiles files;
    scene::Scene scene;
    std::uint64_t revision = 0;
    Image pixels; // linear, 4 channels, row 0 at the top
    Added added;
    std::unique_ptr<measure::Sweep> sweep;
    std::string part; // of the sweep that is under way
    std::string answer;
};

Bench& bench() {
    static Bench only;
    return only;
}

const char* answer(std::string text) {
    bench().answer = std::move(text);
    return bench().answer.c_str();
}

const char* answer(const Status& status) { return answer(status ? std::string() : status.error().message); }

Result<Bytes> readPut(const std::string& path) { return bench().files.read(path); }

Status load(const std::string& path) {
    Result<scene::Scene> scene = scene::load(path, readPut, technique::tables());
    if (!scene) return scene.error();
    bench().scene = std::move(*scene);
    return Done{};
}

Status draw(Bench& b) {
    if (Status done = b.renderer->finish(b.scene, ++b.revision, b.scene.size); !done) return done;
    return b.renderer->present(b.scene);
}

// Keeps the pixels for bench_pixels().
Status keep(Result<Image> image) {
    if (!image) return image.error();
    bench().pixels = std::move(*image);
    return Done{};
}

// One thread: a page has no more.
Result<truth::Picture> solve(const scene::Scene& scene, int directions, const truth::Tile& rows) {
    return measure::solveWhatIsShown(scene, directions, rows, 1);
}

Status addField(const std::string& name) {
    for (const scene::Object& object : bench().scene.objects)
        if (const auto* field = std::get_if<scene::HeightField>(&object.shape)) {
            bench().added.ownFields.push_back({name, field->heights, field->heightScale / field->width});
            return Done{};
        }
    return Error{name + ": has no height field; must have one to measure relief on"};
}

Status addEnvironment(const std::string& path) {
    const Result<Bytes> bytes = readPut(path);
    if (!bytes) return bytes.error();
    const auto map = scene::loadEnvironmentMap(path, *bytes);
    if (!map) return map.error();
    bench().added.ownEnvironments.push_back({path, *map});
    return Done{};
}

Status sweep(const std::string& names, bool quick) {
    Bench& b = bench();
    std::vector<const measure::BenchPart*> parts;
    for (std::size_t at = 0, end = 0; at < names.size(); at = end + 1) {
        end = std::min(names.find(' ', at), names.size());
        const std::string name = names.substr(at, end - at);
        const auto found = measure::benchParts(name);
        if (found.empty()) return Error{"bench: is " + inQuotes(name) + "; must be a part that is built in"};
        parts.insert(parts.end(), found.begin(), found.end());
    }
    Result<measure::Plan> plan = measure::planOf(parts, b.added, quick);
    if (!plan) return plan.error();
    b.sweep = std::make_unique<measure::Sweep>(*b.context, std::move(*plan), solve,
                                               [](const std::string& line) { bench().part = line; });
    return Done{};
}

} // namespace

extern "C" {

/// Takes the current WebGL2 context; "" or the message why it cannot be used.
const char* bench_start() {
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return answer(context.error().message);
    bench().context = std::move(*context);
    bench().renderer = std::make_unique<frame::Renderer>(*bench().context);
    return answer(std::string());
}

/// Name of the driver.
const char* bench_driver() { return answer(bench().context->caps().renderer); }

/// Makes room for a file for later loads. @return  where its bytes are to be written
std::uint8_t* bench_file_space(const char* path, int size) { return bench().files.space(path, size); }

// --- single pictures

/// Loads a scene file that was put; "" or the message.
const char* bench_load(const char* path) { return answer(load(path)); }

/// Sets a parameter of the scene ("lights.0.direction"); "" or the message.
const char* bench_set(const char* path, const char* value) {
    return answer(scene::setParam(bench().scene, path, value));
}

/// Draws the whole picture anew, first hits included, on the canvas, which must have its size. Reading a
/// pixel of the canvas then waits for it. "" or the message.
const char* bench_draw() { return answer(draw(bench())); }

/// Reads what the scene shows, as it was drawn; "" or the message.
const char* bench_read() {
    return answer(keep(bench().renderer->read(bench().scene, bench().scene.view.show)));
}

/// Solves exactly, on the CPU, what the scene shows (d or colours); "" or the message.
///
/// @param directions  that stand for an environment
const char* bench_solve(int directions) {
    Result<truth::Picture> solved = solve(bench().scene, directions, {});
    return answer(solved ? keep(std::move(solved->values)) : Status(solved.error()));
}

/// What was read or solved last: rows from the top, 4 floats a pixel, of the scene's size.
const float* bench_pixels() { return bench().pixels.pixels.data(); }

// --- the sweep

/// Adds the loaded scene's first height field to what the sweep measures; "" or the message.
const char* bench_add_field(const char* name) { return answer(addField(name)); }

/// Adds an environment map that was put; "" or the message.
const char* bench_add_environment(const char* path) { return answer(addEnvironment(path)); }

/// Begins what the sweep measures of some parts on what was added and on shapes; "" or the message.
///
/// @param names  as lucent bench takes them, with a blank between
const char* bench_sweep(const char* names, int quick) { return answer(sweep(names, quick != 0)); }

/// Some rows of an exact solution, or one picture; 0 when all is done.
int bench_step() { return bench().sweep->step(); }

/// Done part of the sweep, [0,1].
double bench_share() { return bench().sweep->share(); }

/// What the sweep is at.
const char* bench_part() { return answer(bench().part); }

/// What the sweep found, as "lucent-bench-1"; the page adds date, commit and machine.
const char* bench_report() { return answer(bench().sweep->report().json()); }

/// The same as lines for people.
const char* bench_report_text() { return answer(bench().sweep->report().text()); }
}
