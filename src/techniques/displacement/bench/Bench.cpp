// How many steps ray casts of displaced surfaces take, and their time over their error.
#include "frame/Renderer.h"
#include "measure/FormScenes.h"
#include "measure/Stopwatch.h"
#include "measure/TechniqueBench.h"

#include <algorithm>
#include <cmath>

namespace lucent::displacement {

namespace {

using namespace measure;
using scene::DisplacementMethod;

constexpr float kScale = 0.15f; // m
constexpr int kMostRefinements = 24;

struct Field {
    const char* name;
    std::shared_ptr<const Image> heights; // go on from tile to tile
};

// The dissertation's kind: a wave, stones with gaps between them, and walls.
std::vector<Field> fieldsOf(int side) {
    const auto map = [&](const auto& height) {
        return heightsOf({side, side},
                         [&](int x, int y) { return height((vec2(x, y) + 0.5f) / float(side)); });
    };
    return {{"waves", map([](vec2 t) {
                 return 0.5f + 0.3f * std::sin(4 * kPi * t.x) + 0.2f * std::cos(6 * kPi * t.y);
             })},
            {"stones", map([](vec2 t) {
                 const vec2 at = 2.0f * glm::fract(5.0f * t) - 1.0f;
                 return std::sqrt(std::max(0.02f, 1 - glm::dot(at, at)));
             })},
            {"walls", map([](vec2 t) { return int(4 * t.x) % 2 == int(4 * t.y) % 2 ? 0.95f : 0.1f; })}};
}

// A square of 2 m with two tiles a side, seen from 35 degrees above the ground.
scene::Scene squareOf(const Field& field, int size) {
    scene::Object square = objectOf(scene::Plane{{2, 2}});
    square.displacement = scene::Displacement{.scale = kScale, .repeat = vec2(2), .heights = field.heights};
    scene::Scene scene = sceneOf({square}, 1);
    scene.size = ivec2(size);
    scene.camera.type = scene::Camera::Type::Perspective;
    scene.camera.eye = {0.5f, 1.2f, 1.65f};
    scene.camera.up = {0, 1, 0};
    scene.camera.fov = 40;
    scene.view.show = scene::Aov::Depth;
    return scene;
}

struct Cast {
    DisplacementMethod method = DisplacementMethod::Quadtree;
    int searchSteps = 32, refineSteps = 8;
};
void set(scene::Scene& scene, const Cast& cast) {
    scene::Displacement& displacement = *scene.objects.front().displacement;
    displacement.method = cast.method;
    displacement.searchSteps = cast.searchSteps;
    displacement.refineSteps = cast.refineSteps;
}

class Bench {
public:
    explicit Bench(const BenchRun& run) : run_(run), renderer_(run.context) {}

    // Depths, -1 where there is nothing.
    Result<std::vector<float>> depths(scene::Scene scene, const Cast& cast) {
        set(scene, cast);
        if (Status done = renderer_.finish(scene, ++revision_, scene.size); !done) return done.error();
        const Result<Image> image = renderer_.read(scene, scene.view.show);
        if (!image) return image.error();
        std::vector<float> depths;
        for (std::size_t i = 0; i + 3 < image->pixels.size(); i += 4)
            depths.push_back(image->pixels[i + 3] > 0 ? image->pixels[i] : -1);
        return depths;
    }

    // How far apart two pictures are in heights: the mean over what the exact one shows, at most 1 a pixel.
    Result<double> error(const scene::Scene& scene, const Cast& cast, const std::vector<float>& exact) {
        const Result<std::vector<float>> found = depths(scene, cast);
        if (!found) return found.error();
        double sum = 0, count = 0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
            if (exact[i] < 0) continue;
            const double apart =
                (*found)[i] < 0 ? 1 : std::abs(double((*found)[i] - exact[i])) / double(kScale);
            sum += std::min(apart, 1.0);
            ++count;
        }
        return sum / count;
    }

    Result<double> milliseconds(scene::Scene scene, const Cast& cast) {
        set(scene, cast);
        scene::Scene nothing = scene;
        nothing.objects.front().visible = false;
        frame::Renderer with(run_.context), without(run_.context);
        const auto draw = [&](frame::Renderer& by, const scene::Scene& what) {
            return [this, &by, &what]() -> Status {
                scene::Scene moved = what; // a picture that nothing has changed would not be drawn again
                moved.camera.eye.x += 1e-5f * float(++revision_ % 64);
                if (Status done = by.finish(moved, revision_, moved.size); !done) return done;
                const Result<Image> image = by.read(moved, moved.view.show);
                return image ? Status(Done{}) : Status(image.error());
            };
        };
        Stopwatch stopwatch(run_.context, draw(with, scene), draw(without, nothing), {});
        for (;;) {
            const Result<bool> done = stopwatch.step();
            if (!done) return done.error();
            if (*done) return stopwatch.spread().median;
        }
    }

private:
    const BenchRun& run_;
    frame::Renderer renderer_;
    std::uint64_t revision_ = 0;
};

// Refinements until a pixel is within 1/256 of the height, of pixels whose interval holds the surface.
Status addRefinements(Proof& proof, Bench& bench, const Field& field, const scene::Scene& scene,
                      const std::vector<float>& exact) {
    for (const auto& [name, method] : {std::pair("interval", DisplacementMethod::Interval),
                                       std::pair("relief", DisplacementMethod::Relief)}) {
        std::vector<int> needed(exact.size(), 0);
        for (int steps = kMostRefinements; steps >= 0; --steps) {
            const auto found = bench.depths(scene, {method, 32, steps});
            if (!found) return found.error();
            for (std::size_t i = 0; i < exact.size(); ++i)
                if (needed[i] >= 0 && (exact[i] < 0 || std::abs((*found)[i] - exact[i]) > kScale / 256))
                    needed[i] = steps == kMostRefinements ? -1 : std::max(needed[i], steps + 1);
        }
        double sum = 0, count = 0, worst = 0;
        for (const int steps : needed) {
            if (steps < 0) continue;
            sum += steps;
            ++count;
            worst = std::max(worst, double(steps));
        }
        const std::string what =
            std::string(field.name) + ", " + name + ": refinements to 1/256 of the height, ";
        proof.ratios.push_back({what + "mean", sum / count, {}, false});
        proof.ratios.push_back({what + "worst", worst, {}, false});
    }
    return Done{};
}

Status addTimes(Proof& proof, Bench& bench, const Field& field, const scene::Scene& scene,
                const std::vector<float>& exact, bool quick) {
    constexpr double kEnough = 1.0 / 1024;
    std::vector<std::pair<std::string, Cast>> casts{
        {"parallax", {DisplacementMethod::Parallax}},
        {"linear, 32 steps", {DisplacementMethod::Linear, 32}},
        {"linear, 256 steps", {DisplacementMethod::Linear, 256}},
        {"quadtree", {DisplacementMethod::Quadtree}},
    };
    for (const int steps : {16, 32, 64, 128, 256})
        for (const int refinements : {4, 8, 12}) {
            if (quick && refinements == 12) continue;
            const std::string text = std::to_string(steps) + " + " + std::to_string(refinements);
            casts.push_back({"relief, " + text, {DisplacementMethod::Relief, steps, refinements}});
            casts.push_back({"interval, " + text, {DisplacementMethod::Interval, steps, refinements}});
        }
    double quadtree = 0, bestRelief = 0;
    for (const auto& [name, cast] : casts) {
        const Result<double> error = bench.error(scene, cast, exact);
        if (!error) return error.error();
        const Result<double> time = bench.milliseconds(scene, cast);
        if (!time) return time.error();
        const std::string what = std::string(field.name) + ", " + name + ": ";
        proof.ratios.push_back({what + "depth error over the height", *error, {}, false});
        proof.ratios.push_back({what + "ms", *time, {}, false});
        if (cast.method == DisplacementMethod::Quadtree) quadtree = *time;
        if (cast.method == DisplacementMethod::Relief && *error <= kEnough &&
            (bestRelief == 0 || *time < bestRelief))
            bestRelief = *time;
    }
    const std::string what =
        std::string(field.name) + ": time of quadtree over that of relief's best setting";
    if (bestRelief == 0)
        proof.ratios.push_back({what + "; none of relief's comes to 1/1024", 0, {}, false});
    else
        proof.ratios.push_back({what + " that comes to 1/1024", quadtree / bestRelief, 1.0 / 3, false});
    return Done{};
}

Result<Proof> proveRayCasts(const BenchRun& run) {
    Proof proof;
    Bench bench(run);
    for (const Field& field : fieldsOf(256)) {
        const scene::Scene scene = squareOf(field, run.quick ? 128 : 256);
        const auto exact = bench.depths(scene, {});
        if (!exact) return exact.error();
        if (Status s = addRefinements(proof, bench, field, scene, *exact); !s) return s.error();
        if (Status s = addTimes(proof, bench, field, scene, *exact, run.quick); !s) return s.error();
    }
    for (const Ratio& ratio : proof.ratios) {
        char line[160];
        std::snprintf(line, sizeof line, "%-80s %.4g\n", ratio.name.c_str(), ratio.value);
        proof.text += line;
    }
    return proof;
}

constexpr BenchPart kParts[] = {
    {.name = "displacement",
     .help = "ray casts of displaced surfaces: refinements, and time over depth error",
     .prove = proveRayCasts},
};

} // namespace

extern const TechniqueBench kBench;
const TechniqueBench kBench{kParts};

} // namespace lucent::displacement
