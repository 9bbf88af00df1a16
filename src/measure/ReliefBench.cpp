#include "measure/ReliefBench.h"

#include "frame/Renderer.h"
#include "measure/Metrics.h"
#include "relief/Relief.h"
#include "truth/RenderRelief.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <random>

namespace lucent::measure {

namespace {

constexpr int kLights = 4;
constexpr float kDepth = 0.03f; // m, of a field 1 m wide

// Lights from low to high and from all around, the same for every field and method.
std::vector<scene::Light> benchLights() {
    std::vector<scene::Light> lights;
    for (int i = 0; i < kLights; ++i) {
        const float elevation = glm::radians(15.0f + 20.0f * float(i));
        const float azimuth = glm::radians(40.0f + 97.0f * float(i));
        scene::DistantLight light;
        light.direction = -vec3(std::cos(elevation) * std::cos(azimuth),
                                std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        lights.push_back(light);
    }
    return lights;
}

scene::Scene sceneFor(const BenchField& field) {
    scene::Scene scene;
    scene::Object object;
    object.name = field.name;
    object.shape.heights = field.heights;
    object.shape.heightScale = field.heightScale;
    object.material.depth = kDepth;
    scene.size = object.shape.texels();
    scene.camera.height = object.shape.footprint().y;
    scene.camera.eye.z = 2 + field.heightScale;
    scene.view.show = scene::Aov::Illumination;
    for (const ParamTable* table : frame::techniques())
        scene.technique.emplace(std::string(table->name), Settings(*table));
    scene.objects.push_back(std::move(object));
    return scene;
}

relief::Settings& settingsOf(scene::Scene& scene) {
    return *static_cast<relief::Settings*>(scene.technique.at("relief").data());
}

double milliseconds(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

Timing summary(std::vector<double> times) {
    std::sort(times.begin(), times.end());
    return {times[times.size() / 2], times.front(), times.back()};
}

// Draws pictures and times them; the first failure stays and ends the benchmark.
class Stopwatch {
public:
    explicit Stopwatch(gl::Context& context) : renderer_(context) {}

    double picture(const scene::Scene& scene) {
        return milliseconds([&] {
            const Status done = renderer_.finish(scene, ++revision_, scene.size);
            if (!done && error_.message.empty()) error_ = done.error();
            if (done) renderer_.wait();
        });
    }
    // Time of the light pass for one light: pictures alternate with and without lights, so that whatever else
    // the machine does hits both.
    Timing perLight(scene::Scene scene, int repeats) {
        scene::Scene dark = scene;
        dark.lights.clear();
        scene.lights = benchLights();
        picture(dark), picture(scene); // compiles, uploads
        std::vector<double> times;
        for (int i = 0; i < repeats; ++i) {
            const double with = picture(scene);
            times.push_back((with - picture(dark)) / kLights);
        }
        return summary(std::move(times));
    }
    Result<Image> illumination(scene::Scene scene) {
        scene.lights = benchLights();
        picture(scene);
        if (!error_.message.empty()) return error_;
        return renderer_.read(scene, scene::Aov::Illumination);
    }
    const Error& error() const { return error_; }

private:
    frame::Renderer renderer_;
    std::uint64_t revision_ = 0;
    Error error_;
};

std::string formatted(const char* format, auto... values) {
    char line[256];
    std::snprintf(line, sizeof line, format, values...);
    return line;
}

} // namespace

std::shared_ptr<const Image> benchNoise(int size) {
    struct Wave {
        float x, y, phase, amplitude;
    };
    std::vector<Wave> waves;
    std::mt19937 random(1); // the same numbers everywhere: only its raw output is used
    const auto turn = [&] { return float(random() & 0xffff) / 65536.0f * 2 * kPi; };
    for (int octave = 0; octave < 7; ++octave) {
        for (int i = 0; i < 4; ++i) {
            const float angle = turn(), frequency = 3.0f * float(1 << octave);
            waves.push_back({frequency * std::cos(angle), frequency * std::sin(angle), turn(),
                             0.06f / float(1 << octave)});
        }
    }
    auto image = std::make_shared<Image>(size, size, 1);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            float height = 0.5f;
            for (const Wave& wave : waves)
                height += wave.amplitude *
                          std::sin((wave.x * float(x) + wave.y * float(y)) / float(size) + wave.phase);
            *image->at(x, y) = std::clamp(height, 0.0f, 1.0f);
        }
    }
    return image;
}

Status drawOnce(gl::Context& context, const BenchField& field) {
    scene::Scene scene = sceneFor(field);
    scene.lights.push_back(scene::PointLight{});
    frame::Renderer renderer(context);
    if (Status done = renderer.finish(scene, 1, scene.size); !done) return done;
    renderer.wait();
    return Done{};
}

Result<ReliefReport> benchRelief(gl::Context& context, const std::vector<BenchField>& fields, bool quick,
                                 const std::function<void(const std::string&)>& say) {
    ReliefReport report;
    report.driver = context.caps().renderer + ", " + context.caps().version;
    const int repeats = quick ? 3 : 7;
    for (const BenchField& field : fields) {
        say(field.name + ": the exact model on the CPU");
        scene::Scene scene = sceneFor(field);
        scene::Scene lit = scene;
        lit.lights = benchLights();
        const std::atomic<bool> never{false};
        const Result<Image> exact = truth::renderRelief(
            lit, lit.size, scene::Aov::Illumination, {}, [](double) {}, never);
        if (!exact) return exact.error();

        Stopwatch stopwatch(context);
        const auto measure = [&](const char* method, int steps) -> Status {
            say(field.name + ": " + method + (steps ? " " + std::to_string(steps) : ""));
            BenchPoint point{
                field.name, method, field.heights->size(), steps, stopwatch.perLight(scene, repeats), 0};
            const Result<Image> image = stopwatch.illumination(scene);
            if (!image) return image.error();
            const Result<Metrics> metrics = compare(*image, method, *exact, "truth");
            if (!metrics) return metrics.error();
            point.rmse = metrics->rmse;
            report.points.push_back(point);
            return Done{};
        };
        if (Status s = measure("hierarchy", 0); !s) return s.error();
        settingsOf(scene).method = relief::Method::March;
        for (int steps : {64, 256, 1024}) {
            settingsOf(scene).steps = steps;
            if (Status s = measure("march", steps); !s) return s.error();
        }
    }
    for (int size : {512, 1024, 2048, 4096}) {
        if (quick && size > 2048) break;
        say("cost of a texel at " + std::to_string(size));
        Stopwatch stopwatch(context);
        const scene::Scene scene = sceneFor({"noise", benchNoise(size), 0.12f});
        const Timing timing = stopwatch.perLight(scene, size > 2048 ? 3 : repeats);
        if (!stopwatch.error().message.empty()) return stopwatch.error();
        report.sizes.push_back({size, timing.median * 1e6 / (double(size) * size)});
    }
    return report;
}

std::string ReliefReport::text() const {
    std::string out = "relief on " + driver + "\n";
    const BenchPoint* exact = nullptr;
    for (const BenchPoint& point : points) {
        if (point.method == "hierarchy") exact = &point;
        const std::string name = point.method + (point.steps ? " " + std::to_string(point.steps) : "");
        out += formatted("  %-8s %4dx%-4d %-12s %9.2f ms a light (%.2f to %.2f), RMSE of d %.2e",
                         point.field.c_str(), point.size.x, point.size.y, name.c_str(), point.perLight.median,
                         point.perLight.low, point.perLight.high, point.rmse);
        if (exact && &point != exact) {
            out +=
                formatted(": hierarchy is %.1f times faster", point.perLight.median / exact->perLight.median);
            if (point.steps == 256) out += " (target 10)";
        }
        out += "\n";
    }
    for (const SizePoint& point : sizes) {
        out += formatted("  a texel at %4d^2: %7.1f ns, %.2f times that at %d^2", point.size,
                         point.nanosecondsPerTexel,
                         point.nanosecondsPerTexel / sizes.front().nanosecondsPerTexel, sizes.front().size);
        out += point.size == 4096 ? " (target 2)\n" : "\n";
    }
    return out;
}

std::string ReliefReport::json() const {
    std::string out = "{\n  \"driver\": \"" + driver + "\",\n  \"methods\": [";
    for (const BenchPoint& point : points) {
        out += &point == points.data() ? "\n" : ",\n";
        out += formatted("    {\"field\": \"%s\", \"width\": %d, \"height\": %d, \"method\": \"%s\", "
                         "\"steps\": %d, \"ms\": %.4f, \"msLow\": %.4f, "
                         "\"msHigh\": %.4f, \"rmse\": %.4e}",
                         point.field.c_str(), point.method.c_str(), point.steps, point.perLight.median,
                         point.perLight.low, point.perLight.high, point.rmse);
    }
    out += "\n  ],\n  \"sizes\": [";
    for (const SizePoint& point : sizes) {
        out += &point == sizes.data() ? "\n" : ",\n";
        out += formatted("    {\"size\": %d, \"nanosecondsPerTexel\": %.2f}", point.size,
                         point.nanosecondsPerTexel);
    }
    return out + "\n  ]\n}\n";
}

} // namespace lucent::measure
