// lucent bake: what a technique works out once for an object of a scene.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/Interrupt.h"
#include "cli/ProgressBar.h"

#include "base/Text.h"
#include "technique/Technique.h"

#include <atomic>
#include <cstdio>
#include <memory>
#include <string_view>

namespace lucent::cli {

namespace {

struct BakeOptions {
    std::string technique;
    SceneOptions scene;
    std::string object, output;
    int threads = 0;
};

Result<const technique::Technique*> techniqueOf(const BakeOptions& options) {
    std::vector<std::string_view> names;
    for (const technique::Technique* one : technique::all()) {
        if (!one->baker) continue;
        if (one->name == options.technique) return one;
        names.push_back(one->name);
    }
    if (names.empty()) return Error{"bake: no technique that bakes is built in; must have one"};
    return Error{"bake: is " + inQuotes(options.technique) + ", no technique that bakes; the nearest is " +
                 inQuotes(nearest(options.technique, names))};
}

// The object of that name, or the only one that the technique bakes.
Result<const scene::Object*> objectOf(const BakeOptions& options, const technique::Baker& baker,
                                      const scene::Scene& scene) {
    std::vector<const scene::Object*> taken;
    std::vector<std::string_view> names;
    for (const scene::Object& object : scene.objects) {
        if (!baker.takes(object)) continue;
        if (object.name == options.object) return &object;
        taken.push_back(&object);
        names.push_back(object.name);
    }
    if (taken.empty())
        return Error{options.scene.path + ": has no object that " + options.technique +
                     " bakes; must have one whose material is precomputed"};
    if (!options.object.empty())
        return Error{"--object: is " + inQuotes(options.object) + ", which " + options.technique +
                     " does not bake; the nearest is " + inQuotes(nearest(options.object, names))};
    if (taken.size() > 1)
        return Error{options.scene.path + ": has " + std::to_string(taken.size()) + " objects that " +
                     options.technique + " bakes; --object must name one of them"};
    return taken.front();
}

Status bakeObject(const BakeOptions& options) {
    const auto technique = techniqueOf(options);
    if (!technique) return technique.error();
    const technique::Baker& baker = *(*technique)->baker;
    const Result<std::vector<std::string>> inputs = options.scene.files();
    if (!inputs) return inputs.error();
    if (Status possible = checkOutputs({options.output}, *inputs); !possible) return possible;
    const Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene.error();
    const auto object = objectOf(options, baker, *scene);
    if (!object) return object.error();
    const std::atomic<bool>& interrupted = catchInterrupt();
    const Result<Bytes> file = [&]() -> Result<Bytes> {
        constexpr double kSlice = 100; // ms until progress is shown again
        ProgressBar bar;
        const auto baking = baker.bake(scene->technique.at(options.technique), **object, options.threads);
        while (!interrupted) {
            if (auto made = baking->advance(kSlice)) return std::move(*made);
            bar.show(baking->share());
        }
        return Error{"the bake was stopped; nothing is kept of it"};
    }();
    if (!file) return Error{"objects." + (*object)->name + ": " + file.error().message, file.error().fault};
    if (Status written = writeFile(options.output, *file); !written) return written;
    std::printf("%s: %s of %s, %zu bytes\n", options.output.c_str(), options.technique.c_str(),
                (*object)->name.c_str(), file->size());
    return Done{};
}

} // namespace

Command addBake(CLI::App& program) {
    CLI::App* parser = program.add_subcommand(
        "bake", "Works out once what a technique needs of an object, into a file that the scene then names");
    const auto options = std::make_shared<BakeOptions>();
    parser->add_option("technique", options->technique, "Technique that bakes")
        ->required()
        ->type_name("TECHNIQUE");
    options->scene.addTo(*parser);
    parser->add_option("--object", options->object, "Object to bake [the only one that is precomputed]")
        ->type_name("NAME");
    addOutput(*parser, options->output, "File for the object's \"bake\" in the scene");
    parser->add_option("--threads", options->threads, "0: as many as the machine has")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    parser->footer("Ctrl-C stops the work; nothing is written then.\n\n"
                   "Example:\n  lucent bake throughput bust.json -o bust.bake");
    return {parser, [options] { return bakeObject(*options); }};
}

} // namespace lucent::cli
