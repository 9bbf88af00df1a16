// Where the light of a caustic map went.
#include "viewer/State.h"

#include <cmath>
#include <cstdio>

namespace lucent::viewer {

namespace {

double sum(dvec3 watts) { return watts.r + watts.g + watts.b; }

std::string share(const char* name, dvec3 part, dvec3 whole) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %.1f %%", name, 100 * sum(part) / sum(whole));
    return text;
}

} // namespace

// Counts the light of a finished caustic map. While time runs there is none: counting takes longer than
// drawing.
void Viewer::State::measureEnergy() {
    const bool counts = scene && picture.view.show == scene::Aov::CausticMap && shown && !play.playing;
    if (!counts || phase != Phase::Done || stale) {
        if (energy && (!counts || stale)) settled = false;
        if (!counts || stale) energy.reset();
        return;
    }
    if (energyOf == pictureNumber) return;
    energyOf = pictureNumber;
    auto found = renderer->energy(picture);
    if (found)
        energy = *found;
    else
        message = found.error().message;
    settled = false;
}

std::string Viewer::State::energyText() const {
    const std::string unit = "1: as bright as without glass and mirrors";
    if (play.playing) return unit + "\nits light is counted when time stands still";
    if (!energy || sum(energy->met) == 0) return unit;
    char met[64];
    std::snprintf(met, sizeof met, "%.3g W", sum(energy->met) / 3);
    const dvec3 all = energy->met;
    const std::string dot = " · ";
    return unit + "\nof " + met + " that met glass or mirrors\n" +
           share("on receivers", energy->received, all) + dot + share("absorbed", energy->absorbed, all) +
           dot + share("reflected", energy->reflected, all) + "\n" + share("missed", energy->missed, all) +
           dot + share("lost", energy->lost, all);
}

void Viewer::State::energyOverlay() {
    if (!scene || scene->view.show != scene::Aov::CausticMap || compare.mode != CompareMode::Off) return;
    drawNumbersCard(energyText(), ScaleEnds{"1/16", "64"}, openSize(), theme(dark));
}

} // namespace lucent::viewer
