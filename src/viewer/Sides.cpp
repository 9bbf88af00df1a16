// What is drawn for a comparison alone, once the picture is finished: the right side of Methods and of
// Materials, and what is measured, at the truth's size.
#include "viewer/State.h"

namespace lucent::viewer {

// What is still to be drawn; null while the picture itself is, or where nothing is.
Viewer::State::Side* Viewer::State::nextSide() {
    if (!divided() || phase != Phase::Done || stale || !shown || play.playing) return nullptr;
    if (drawsRight(compare.mode) && other.of != pictureNumber) return &other;
    if (!truthIsFresh()) return nullptr;
    if (measured[0].of != pictureNumber) return &measured[0];
    const bool isOther = compare.mode == CompareMode::Methods; // of the same truth
    return isOther && measured[1].of != pictureNumber ? &measured[1] : nullptr;
}

scene::Scene Viewer::State::sceneOf(const Side& side) {
    scene::Scene drawn = &side == &measured[0]                    ? picture
                         : compare.mode == CompareMode::Materials ? withMaterialsOf(picture, *right)
                                                                  : withSettingsOf(picture, *right);
    leaveOutMissing(drawn);
    if (&side != &other) drawn.camera = scene->camera; // as the truth sees it
    return drawn;
}

// One slice of work.
void Viewer::State::drawSides() {
    Side* next = nextSide();
    if (!next) {
        if (compare.mode == CompareMode::Off) sides.reset();
        return;
    }
    if (!sides) sides = std::make_unique<frame::Renderer>(*context);
    if (drawing != next) ++sideNumber;
    drawing = next;
    sides->setDefaultError(defaultError());
    const scene::Scene drawn = sceneOf(*next);
    const ivec2 size = next == &other ? picturePixels : truth->image.size();
    const Result<frame::Progress> progress = sides->advance(drawn, sideNumber, size);
    if (progress && !progress->complete) return;
    const Result<Image> image =
        progress ? sides->read(drawn, drawn.view.show) : Result<Image>(progress.error());
    if (!image) message = image.error().message;
    *next = {image ? *image : Image(), pictureNumber, {}};
    drawing = nullptr;
    ++besideNumber;
    shownHash = 0; // what is beside the picture has changed
    settled = false;
    if (image && next != &other) finishSide(*next);
}

// Measures it.
void Viewer::State::finishSide(Side& side) {
    takeCoverage(truth->image, side.image);
    Result<measure::Metrics> numbers = compareWithTruth(side.image, truth->image);
    if (!numbers) {
        message = numbers.error().message;
        return;
    }
    const bool isMethods = compare.mode == CompareMode::Methods;
    if (isMethods && picture.view.show == scene::Aov::Color)
        numbers->flip = visibleError(side.image, truth->image, picture.view.exposure);
    side.numbers = *numbers;
    if (&side == &measured[0]) error = differenceOf(side.image, truth->image);
}

void Viewer::State::dropSides() {
    other = {};
    measured = {};
    drawing = nullptr;
    ++besideNumber;
    settled = false;
}

} // namespace lucent::viewer
