// The picture beside another one: what stands there, where, and what is said about both.
#include "viewer/State.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace lucent::viewer {

namespace {

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

std::string duration(double milliseconds) {
    return milliseconds < 1000 ? number(milliseconds) + " ms" : number(milliseconds / 1000) + " s";
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
    freshAt = 0;
    measured = {};
    drawing = nullptr;
    ++besideNumber;
    shownHash = 0;
    settled = false;
}

void Viewer::State::dropTruth() {
    truth.reset();
    dropSides();
}

// Where the other picture lies: all of the picture, or what of it the truth shows.
Rect Viewer::State::besidePlace() const {
    const vec2 room = pictureSize();
    if (drawsRight(compare.mode)) return {{0, 0}, room};
    const vec2 shape(truth->image.size());
    const vec2 size = shape * std::min(room.x / shape.x, room.y / shape.y);
    const vec2 low = (room - size) / 2.0f;
    return {low, low + size};
}

float Viewer::State::dividerPlace() const {
    const Rect place = besidePlace();
    return glm::mix(place.low.x, place.high.x, compare.divider);
}

void Viewer::State::moveDivider(float x) {
    const Rect place = besidePlace();
    const float share = std::clamp((x - place.low.x) / (place.high.x - place.low.x), 0.0f, 1.0f);
    (void)change("divider", number(std::round(share * 1000) / 1000), gesture);
}

// Null: there is none yet. An error that is not known yet leaves the truth in its place.
const Image* Viewer::State::besideImage() {
    if (drawsRight(compare.mode)) return other.image.size() == picturePixels ? &other.image : nullptr;
    const bool isError = compare.mode == CompareMode::Error && truthIsFresh() && measured[0].numbers;
    return isError ? &error : &truth->image;
}

std::optional<frame::Beside> Viewer::State::beside() {
    const Image* image = divided() ? besideImage() : nullptr;
    if (!image) return std::nullopt;
    if (image != std::exchange(besideShown, image)) ++besideNumber;
    const Rect place = besidePlace();
    frame::Beside beside{.image = *image, .number = besideNumber, .isError = image == &error};
    beside.corner = place.low * scale;
    beside.pixelsPerTexel = (place.high.x - place.low.x) * scale / float(image->width);
    beside.divider = dividerPlace() * scale;
    if (beside.isError) beside.full = float(fullScale(measured[0].numbers->p99));
    return beside;
}

std::string Viewer::State::besideName() {
    if (drawsRight(compare.mode))
        return besideImage() && other.of == pictureNumber ? differenceText(true) : "being drawn";
    if (!truthIsFresh()) return "truth of an earlier scene";
    return besideImage() == &error ? "error" : "truth";
}

// What the settings or materials of one side are where they differ from those of the other: "Method march".
std::string Viewer::State::differenceText(bool ofRight) const {
    std::string text;
    for (const Control& control : controls) {
        const std::string& path = control.bound.path;
        if (!path.starts_with(kBeside) || !isOfRight(compare.mode, path.substr(kBeside.size()))) continue;
        const Control* left = find(path.substr(kBeside.size()));
        if (!left) continue;
        const auto valueOf = [](const Control& of) { return getText(*of.bound.param, of.bound.data); };
        if (valueOf(control) == valueOf(*left)) continue;
        const bool isOfOne = compare.mode == CompareMode::Materials && scene->objects.size() > 1;
        text += (text.empty() ? "" : ", ") + (isOfOne ? ownerOf(left->bound) + ": " : "") +
                std::string(control.bound.param->label) + " " + valueOf(ofRight ? control : *left);
    }
    if (!text.empty()) return text;
    return compare.mode == CompareMode::Materials ? "the same materials" : "the same methods";
}

// Of both sides where their materials are compared.
std::vector<Figure> Viewer::State::allFigures() const {
    constexpr double kMs = 30; // a picture waits for them
    std::vector<Figure> all = figuresOf(*scene, kMs);
    if (compare.mode != CompareMode::Materials) return all;
    scene::Scene other = withMaterialsOf(*scene, *right);
    for (scene::Object& object : other.objects)
        object.name = besideOwner(object.name);
    for (Figure& figure : figuresOf(other, kMs)) {
        figure.place = Group::Mode; // as the controls of that side
        all.push_back(std::move(figure));
    }
    return all;
}

std::string Viewer::State::numbersText(const measure::Metrics& m) const {
    const std::string dot = " · ";
    std::string text = "RMSE " + number(m.rmse);
    if (m.flip) return text + dot + "FLIP " + number(*m.flip);
    if (std::isfinite(m.relRmse)) text += dot + "relative " + number(m.relRmse); // to the truth's mean
    return text + dot + "max " + number(m.maximum) + "\nbias " +
           number(m.bias); // lines would break at its point
}

std::string Viewer::State::compareText() {
    std::string text;
    const auto add = [&](const std::string& line) { text += (text.empty() ? "" : "\n") + line; };
    const auto addSide = [&](const std::string& name, const Side& side) {
        const bool isKnown = truth && truthIsFresh() && side.of == pictureNumber && side.numbers;
        add(name + (isKnown ? ": " + numbersText(*side.numbers) : ""));
    };
    if (drawsRight(compare.mode)) {
        const std::string left = differenceText(false), right = differenceText(true);
        addSide("left: " + left, measured[0]);
        addSide("right: " + right + (left == right ? ", until you choose others" : ""), measured[1]);
    }
    if (!truth) return add("There is no truth of this scene yet."), text;
    if (!truthIsFresh()) return add("The scene has changed since its truth was made."), text;
    const measure::Metrics* numbers = measured[0].numbers ? &*measured[0].numbers : nullptr;
    if (measured[0].of != pictureNumber) return add("The error is being measured."), text;
    if (!numbers) return add("The picture cannot be measured."), text;
    if (!drawsRight(compare.mode)) add(numbersText(*numbers));
    if (!truth->noise)
        add("the truth's own noise is not known");
    else
        add(*truth->noise > 0 ? "the truth's own noise " + number(*truth->noise) : "the truth has no noise");
    const frame::Stats cost = renderer->stats();
    const ivec2 size = truth->image.size();
    add("measured at " + std::to_string(size.x) + " × " + std::to_string(size.y) + " pixels · picture " +
        duration(cost.milliseconds) + ", " + std::to_string(cost.passes) +
        (cost.passes == 1 ? " pass" : " passes"));
    return text;
}

void Viewer::State::compareOverlay() {
    if (!scene || compare.mode == CompareMode::Off) return;
    const bool isDrawn = drawsRight(compare.mode);
    if (divided()) {
        const Rect place = besidePlace();
        const float x = dividerPlace();
        drawDivider(x, place, {isDrawn ? differenceText(false) : "image", besideName()},
                    grip == Grip::Divider || focus == "divider", theme(dark));
        if (!isDrawn && !truthIsFresh())
            drawNotice("This truth shows the scene as it was before you changed it. Compute it again.",
                       {{x, place.low.y}, place.high}, theme(dark));
    }
    std::optional<ScaleEnds> scale;
    if (divided() && besideImage() == &error && !isDrawn)
        scale = {"0", general(fullScale(measured[0].numbers->p99))};
    cardTop = drawNumbersCard(compareText(), scale, openSize(), theme(dark));
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
    if (divided()) report.place = besidePlace();
    report.scale = scale;
    const bool isMeasured = divided() && truthIsFresh() && measured[0].of == pictureNumber;
    if (isMeasured) report.numbers = measured[0].numbers;
    if (scene && drawsRight(compare.mode)) {
        report.left = differenceText(false);
        report.right = differenceText(true);
        if (isMeasured && measured[1].of == pictureNumber) report.rightNumbers = measured[1].numbers;
    }
    if (renderer) report.cost = renderer->stats();
    return report;
}

} // namespace lucent::viewer
