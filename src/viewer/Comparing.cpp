// The picture beside its truth: when it is, how large, and what is said about it.
#include "viewer/State.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace lucent::viewer {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string general(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

} // namespace

bool Viewer::State::truthIsFresh() {
    if (!truth || !scene) return false;
    if (freshAt != revision) {
        freshAt = revision;
        fresh = samePicture(*scene, truth->scene) && !dropTime;
    }
    return fresh;
}

void Viewer::State::takeTruth(Truth newTruth) {
    truth = std::move(newTruth);
    ++truthNumber;
    freshAt = 0;
    numbers.reset();
    stale = true; // the picture is drawn at the truth's size now
    settled = false;
}

void Viewer::State::dropTruth() {
    truth.reset();
    numbers.reset();
    settled = false;
}

// Where the picture lies: all that the panel leaves; beside a truth as much of it as keeps the truth's shape.
Rect Viewer::State::picturePlace() const {
    const vec2 room = pictureSize();
    if (!comparing()) return {{0, 0}, room};
    const vec2 shape(truth->image.size());
    const vec2 size = shape * std::min(room.x / shape.x, room.y / shape.y);
    const vec2 low = (room - size) / 2.0f;
    return {low, low + size};
}

float Viewer::State::dividerPlace() const {
    const Rect place = picturePlace();
    return glm::mix(place.low.x, place.high.x, compare.divider);
}

void Viewer::State::moveDivider(float x) {
    const Rect place = picturePlace();
    const float share = std::clamp((x - place.low.x) / (place.high.x - place.low.x), 0.0f, 1.0f);
    (void)change("divider", number(std::round(share * 1000) / 1000), gesture);
}

// Compares a finished picture with the truth of the same scene; anything else has no numbers.
void Viewer::State::measurePicture() {
    if (!comparing() || phase != Phase::Done || stale || !shown || !truthIsFresh()) return;
    if (numbers && numbersOf == pictureNumber) return;
    numbers.reset();
    const Result<Image> image = renderer->read(picture, picture.view.show);
    const auto metrics =
        image ? compareWithTruth(*image, truth->image) : Result<measure::Metrics>(image.error());
    if (metrics)
        numbers = *metrics;
    else
        message = metrics.error().message;
    numbersOf = pictureNumber;
    settled = false;
}

frame::Beside Viewer::State::beside() {
    const Rect place = picturePlace();
    frame::Beside beside{.truth = truth->image, .number = truthNumber, .screen = pixels};
    beside.corner = place.low * scale;
    beside.pixelsPerTexel = (place.high.x - place.low.x) * scale / float(truth->image.width);
    beside.divider = dividerPlace() * scale;
    beside.full = float(numbers ? fullScale(numbers->p99) : 1);
    if (compare.mode == CompareMode::Truth) beside.right = frame::Beside::Right::Truth;
    if (compare.mode == CompareMode::Error)
        beside.right = numbers ? frame::Beside::Right::Error : frame::Beside::Right::Nothing;
    return beside;
}

std::string Viewer::State::compareText() {
    if (!truth) return "There is no truth of this scene yet.";
    if (!truthIsFresh())
        return "The scene has changed since its truth was made: there is nothing to compare.";
    if (!numbers && phase == Phase::Done && !stale) return "The picture cannot be measured.";
    if (!numbers) return "The picture is not finished.";
    const measure::Metrics& m = *numbers;
    const frame::Stats cost = renderer->stats();
    const std::string times = " × ", dot = " · ";
    std::string text = "RMSE " + number(m.rmse);
    if (std::isfinite(m.relRmse)) text += dot + "relative " + number(m.relRmse); // to the truth's mean
    text += dot + "max " + number(m.maximum) + dot + "bias " + number(m.bias) + "\n";
    if (!truth->noise)
        text += "the truth's own noise is not known";
    else
        text +=
            *truth->noise > 0 ? "the truth's own noise " + number(*truth->noise) : "the truth has no noise";
    text += "\n" + number(cost.milliseconds) + " ms" + dot + std::to_string(cost.passes) +
            (cost.passes == 1 ? " pass" : " passes") + dot + std::to_string(truth->image.width) + times +
            std::to_string(truth->image.height) + " pixels";
    return text;
}

void Viewer::State::compareOverlay() {
    if (!scene || compare.mode == CompareMode::Off) return;
    if (comparing()) {
        const bool isError = compare.mode == CompareMode::Error;
        const char* right = isError ? "error" : truthIsFresh() ? "truth" : "truth of an earlier scene";
        drawDivider(dividerPlace(), picturePlace(), right, grip == Grip::Divider || focus == "divider",
                    theme(dark));
    }
    const bool hasScale = compare.mode == CompareMode::Error && numbers && truthIsFresh();
    std::optional<ScaleEnds> scale;
    if (hasScale) scale = {"0", general(fullScale(numbers->p99))};
    drawNumbersCard(compareText(), scale, openSize(), theme(dark));
}

ComparisonReport Viewer::State::comparison() {
    ComparisonReport report;
    report.mode = getText(compareParams()[0], &compare.mode);
    report.divider = compare.divider;
    report.truth = !truth ? "none" : truthIsFresh() ? "fresh" : "stale";
    if (truth) {
        report.size = truth->image.size();
        report.noise = truth->noise;
    }
    if (comparing()) report.place = picturePlace();
    if (comparing() && truthIsFresh()) report.numbers = numbers;
    if (renderer) report.cost = renderer->stats();
    return report;
}

} // namespace lucent::viewer
