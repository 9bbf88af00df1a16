// Time that runs: when it does, and how far.
#include "viewer/State.h"

#include <algorithm>

namespace lucent::viewer {

namespace {

// s that one step takes at most: a machine that needs longer for a picture shows slow motion, and a viewer
// that comes back on the screen goes on where it was.
constexpr double kLongestStep = 0.25;

} // namespace

std::span<const Param> playParams() {
    static const Param params[] = {
        declare(&PlaySettings::playing,
                {.id = "playing", .label = "Play", .group = Group::View, .doc = "Lets time run."})};
    return params;
}

BoundParam bindPlaying(PlaySettings& settings, bool shown) {
    static const PlaySettings defaults;
    const Param& param = playParams().front();
    return {std::string(param.id), "", &param, &settings.playing, &defaults.playing, shown};
}

// The next moment begins when the last one has been seen. It is no step to take back.
void Viewer::State::tick(double now) {
    const double passed = std::max(0.0, now - lastDraw);
    lastDraw = now;
    if (!scene || !play.playing) return;
    due = std::min(due + passed, kLongestStep);
    if (stale || phase == Phase::Preview || due == 0) return;
    scene->view.time += float(due);
    due = 0;
    changed();
}

bool Viewer::State::togglePlaying() {
    const Control* control = find("playing");
    return control && control->bound.shown &&
           change("playing", play.playing ? "false" : "true", gesture).ok();
}

} // namespace lucent::viewer
