// lucent render: pictures on the GPU, one or a sequence.
#include "cli/Command.h"
#include "cli/Files.h"
#include "cli/Interrupt.h"
#include "cli/ProgressBar.h"

#include "base/JsonWriter.h"
#include "frame/Renderer.h"
#include "gl/Context.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <memory>

namespace lucent::cli {

namespace fs = std::filesystem;

namespace {

constexpr int kMostFrames = 9999; // four digits

struct RenderOptions {
    SceneOptions scene;
    std::string output, stats;
    std::string time, maxError; ///< empty: the scene's own
    int frames = 0;             ///< 0: one picture, without a number in its name
    int fps = 30;
};

// "out.png" -> "out-0001.png"
std::string numbered(const std::string& output, int number) {
    char digits[16];
    std::snprintf(digits, sizeof digits, "-%04d", number);
    const fs::path path = output;
    return (path.parent_path() / (path.stem().string() + digits + path.extension().string())).string();
}

std::vector<std::string> pathsOf(const RenderOptions& options) {
    std::vector<std::string> paths;
    for (int i = 1; i <= options.frames; ++i)
        paths.push_back(numbered(options.output, i));
    return options.frames > 0 ? paths : std::vector{options.output};
}

void writeCost(JsonWriter& json, const frame::Stats& stats) {
    json.key("milliseconds").value(stats.milliseconds);
    json.key("passes").value(stats.passes).key("draws").value(stats.draws).key("lights").value(stats.lights);
    json.key("textureBytes").value(double(stats.bytes));
    json.key("settings").value(stats.settings).key("predictedError").value(stats.predicted);
    json.key("planMilliseconds").value(stats.planMilliseconds);
}

/// A finished picture.
struct Drawn {
    std::string file;
    float time; ///< s
    frame::Stats cost;
};

std::string statsJson(const RenderOptions& options, ivec2 size, const gl::Context& context,
                      const std::vector<Drawn>& pictures) {
    JsonWriter json;
    json.beginObject();
    json.key("scene").value(options.scene.path);
    json.key("width").value(size.x).key("height").value(size.y);
    json.key("renderer").value(context.caps().renderer);
    if (options.frames == 0) {
        writeCost(json, pictures.front().cost);
    } else {
        json.key("pictures").beginArray();
        for (const Drawn& one : pictures) {
            json.beginObject().key("file").value(one.file).key("time").value(one.time);
            writeCost(json, one.cost);
            json.end();
        }
        json.end();
    }
    return json.end().text();
}

// The scene with what the options change in it.
Result<scene::Scene> loadScene(const RenderOptions& options) {
    Result<scene::Scene> scene = options.scene.load();
    if (!scene) return scene;
    const bool still = std::none_of(scene->objects.begin(), scene->objects.end(),
                                    [](const scene::Object& object) { return scene::moves(object); });
    if (still && (options.frames > 0 || !options.time.empty()))
        return Error{std::string(options.frames > 0 ? "--frames" : "--time") + ": nothing in " +
                     options.scene.path + " moves; must be left out"};
    if (Status read = readParam("--time", options.time, scene::viewParams(), "time", &scene->view.time);
        !read)
        return read.error();
    if (Status read = readParam("--max-error", options.maxError, scene::qualityParams(), "maxError",
                                &scene->quality.maxError);
        !read)
        return read.error();
    return scene;
}

Status checkRenderPaths(const RenderOptions& options) {
    if (Status known = checkImageEnding(options.output); !known) return known;
    const Result<std::vector<std::string>> inputs = options.scene.files();
    if (!inputs) return inputs.error();
    std::vector<std::string> outputs = pathsOf(options);
    outputs.push_back(options.stats);
    return checkOutputs(outputs, *inputs);
}

Result<Bytes> encodePicture(frame::Renderer& renderer, const scene::Scene& scene, const std::string& path) {
    const bool asDisplayed = fs::path(path).extension() == ".png";
    const Result<Image> image =
        asDisplayed ? renderer.readDisplay(scene) : renderer.read(scene, scene.view.show);
    if (!image) return image.error();
    return encode(*image, path);
}

// Draws, writes and adds the scene as it stands. The last picture brings the statistics of all.
Status renderOne(const RenderOptions& options, const gl::Context& context, frame::Renderer& renderer,
                 const scene::Scene& scene, const std::string& path, bool isLast,
                 std::vector<Drawn>& pictures) {
    if (Status finished = renderer.finish(scene, pictures.size() + 1, scene.size); !finished) return finished;
    Result<Bytes> encoded = encodePicture(renderer, scene, path);
    if (!encoded) return encoded.error();
    pictures.push_back({path, scene.view.time, renderer.stats()});
    std::vector<Output> outputs{{path, std::move(*encoded)}};
    if (isLast && !options.stats.empty())
        outputs.push_back({options.stats, toBytes(statsJson(options, scene.size, context, pictures))});
    return writeAll(outputs);
}

// Picture by picture: what was finished stays when it is stopped. Stopped once, it finishes the one at hand.
Status renderAll(const RenderOptions& options, const gl::Context& context, frame::Renderer& renderer,
                 scene::Scene& scene) {
    std::vector<Drawn> pictures;
    const std::vector<std::string> paths = pathsOf(options);
    const float start = scene.view.time;
    const std::atomic<bool> never = false;
    const std::atomic<bool>& interrupted = paths.size() > 1 ? catchInterrupt() : never;
    ProgressBar bar;
    for (std::size_t i = 0; i < paths.size(); ++i) {
        bar.show(double(i) / double(paths.size()));
        if (interrupted)
            return Error{"render: stopped after " + std::to_string(i) + " of " +
                             std::to_string(paths.size()) + " pictures",
                         Fault::Machine};
        scene.view.time = start + float(i) / float(options.fps);
        const bool isLast = i + 1 == paths.size();
        if (Status drawn = renderOne(options, context, renderer, scene, paths[i], isLast, pictures); !drawn)
            return drawn;
    }
    return Done{};
}

Status render(const RenderOptions& options) {
    if (Status possible = checkRenderPaths(options); !possible) return possible;
    Result<scene::Scene> scene = loadScene(options);
    if (!scene) return scene.error();
    const Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return context.error();

    tellNotDrawn(*scene);
    frame::Renderer renderer(**context);
    return renderAll(options, **context, renderer, *scene);
}
} // namespace

Command addRender(CLI::App& program) {
    CLI::App* parser =
        program.add_subcommand("render", "Renders a scene into an image file, or into several");
    const auto options = std::make_shared<RenderOptions>();
    options->scene.addTo(*parser);
    options->scene.addAovTo(*parser, "Quantity to show: color, d (illumination), visibility, normal, depth, "
                                     "position, iterations, irradiance, direction, layers");
    addOutput(*parser, options->output, "Picture: .png as displayed; .hdr, .exr or .pfm with linear values");
    parser
        ->add_option("--time", options->time,
                     "Moment that is shown of what moves, in s; else the scene's own")
        ->type_name("S");
    CLI::Option* frames = parser
                              ->add_option("--frames", options->frames,
                                           "Renders so many pictures, a step of time apart, and numbers "
                                           "them: FILE-0001.png, ...; those that "
                                           "are finished stay when a later one fails")
                              ->check(integerIn(1, kMostFrames));
    parser->add_option("--fps", options->fps, "Pictures a second of a sequence")
        ->check(integerIn(1, 1000))
        ->needs(frames)
        ->capture_default_str();
    parser
        ->add_option(
            "--max-error", options->maxError,
            "Root mean square error that the picture may have, over its mean: the cheapest settings\n"
            "that keep it are chosen")
        ->type_name("E");
    parser
        ->add_option("--stats", options->stats,
                     "Writes time, passes, lights, bytes and what --max-error chose and predicts, as JSON")
        ->type_name("FILE");
    parser->footer("Examples:\n"
                   "  lucent render coin.json -o picture.png\n"
                   "  lucent render coin.json -o coin.exr --size 1024x1024 --aov d\n"
                   "  lucent render coin.json -o shiny.png --set objects.coin.material.specularity=0.6\n"
                   "  lucent render coin.json -o quick.png --max-error 0.03 --stats quick.json\n"
                   "  lucent render pool.json -o pool.png --frames 90 --fps 30");
    return {parser, [options] { return render(*options); }};
}

} // namespace lucent::cli
