// Where the light of a quantity went that a technique shows of its own.
#include "viewer/State.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lucent::viewer {

namespace {

double sum(dvec3 watts) { return watts.r + watts.g + watts.b; }

std::string share(const std::string& name, dvec3 part, dvec3 whole) {
    char text[64];
    std::snprintf(text, sizeof text, "%s %.1f %%", name.c_str(), 100 * sum(part) / sum(whole));
    return text;
}

// Who owns a quantity; "" where it is no technique's own.
std::string_view ownerOf(scene::Aov aov) {
    for (const technique::Technique* one : technique::all())
        if (std::find(one->aovs.begin(), one->aovs.end(), aov) != one->aovs.end()) return one->name;
    return "";
}

} // namespace

// Counts the light of a finished caustic map. While time runs there is none: counting takes longer than
// drawing.
void Viewer::State::measureEnergy() {
    const bool counts = scene && picture.view.show == scene::Aov::CausticMap && shown && !play.playing;
    if (!counts || phase != Phase::Done || stale) {
        if (!balance.empty() && (!counts || stale)) settled = false;
        if (!counts || stale) balance.clear();
        return;
    }
    if (energyOf == pictureNumber) return;
    energyOf = pictureNumber;
    auto found = renderer->balance(picture, ownerOf(picture.view.show));
    if (found)
        balance = *found;
    else
        message = found.error().message;
    settled = false;
}

std::string Viewer::State::energyText() const {
    const std::string unit = "1: as bright as without glass and mirrors";
    if (play.playing) return unit + "\nits light is counted when time stands still";
    if (balance.empty() || sum(balance.front().second) == 0) return unit;
    const dvec3 all = balance.front().second;
    char incident[64];
    std::snprintf(incident, sizeof incident, "%.3g W", sum(all) / 3);
    std::string text = unit + "\nof " + incident + " incident on glass and mirrors";
    for (std::size_t i = 1; i < balance.size(); ++i) {
        const std::string name = balance[i].first == "received" ? "on receivers" : balance[i].first;
        text += (i % 3 == 1 ? "\n" : " · ") + share(name, balance[i].second, all);
    }
    return text;
}

void Viewer::State::energyOverlay() {
    if (!scene || scene->view.show != scene::Aov::CausticMap || compare.mode != CompareMode::Off) return;
    cardTop = drawNumbersCard(energyText(), ScaleEnds{"1/16", "64"}, openSize(), theme(dark));
}

} // namespace lucent::viewer
