#include "measure/Steps.h"

#include "base/JsonWriter.h"
#include "frame/Renderer.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace lucent::measure {

namespace {

double now() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

} // namespace

StepTimes timeSteps(gl::Context& context, const std::string& name, const scene::Scene& scene,
                    double patience) {
    StepTimes times;
    times.scene = name;
    frame::Renderer renderer(context);
    const double begin = now();
    const auto since = [&] { return now() - begin; };
    bool coarse = true;
    for (int samples = 0;;) {
        const double before = now();
        const Result<frame::Progress> progress = renderer.advance(scene, 1, scene.size, coarse);
        if (!progress) {
            times.message = progress.error().message;
            return times;
        }
        const bool isNew = progress->complete || progress->samples > samples;
        ++times.steps;
        if (const double took = now() - before; took > times.longest) {
            times.longest = took;
            times.where = std::string(coarse         ? "preview"
                                      : samples == 0 ? "light"
                                                     : "samples") +
                          " " + std::to_string(times.steps);
        }
        if (times.preview == 0 && isNew) times.preview = since();
        if (times.complete == 0 && !coarse && progress->samples > 0) times.complete = since();
        samples = progress->samples;
        if ((!coarse && progress->complete) || since() > patience) return times;
        if (coarse && progress->complete) coarse = false;
    }
}

std::string stepsText(std::span<const StepTimes> times) {
    char line[256];
    std::snprintf(line, sizeof line, "%-24s %10s %10s %10s %6s  %s\n", "ms", "longest", "preview", "complete",
                  "steps", "longest was");
    std::string text = line;
    for (const StepTimes& one : times) {
        std::snprintf(line, sizeof line, "%-24s %10.0f %10.0f %10.0f %6d  %s\n", one.scene.c_str(),
                      one.longest, one.preview, one.complete, one.steps,
                      one.message.empty() ? one.where.c_str() : one.message.c_str());
        text += line;
    }
    const auto late = std::count_if(times.begin(), times.end(),
                                    [](const StepTimes& one) { return one.longest > kLongestStep; });
    const auto slow = std::count_if(times.begin(), times.end(),
                                    [](const StepTimes& one) { return one.preview > kLongestPreview; });
    std::snprintf(line, sizeof line,
                  "%d of %zu scenes have a step over %.0f ms, %d show nothing for over %.0f ms\n", int(late),
                  times.size(), kLongestStep, int(slow), kLongestPreview);
    return text + line;
}

std::string stepsJson(std::span<const StepTimes> times) {
    JsonWriter json;
    json.beginObject().key("steps").beginArray();
    for (const StepTimes& one : times) {
        json.beginObject().key("scene").value(one.scene);
        if (!one.message.empty()) json.key("message").value(one.message);
        json.key("longest").value(one.longest).key("where").value(one.where);
        json.key("preview").value(one.preview).key("complete").value(one.complete);
        json.key("steps").value(one.steps).end();
    }
    return json.end().end().text();
}

} // namespace lucent::measure
