// Work on the picture, and the way to the screen.
#include "viewer/State.h"

#include <algorithm>
#include <utility>

namespace lucent::viewer {

namespace {

// s: ten a second, with what a page does between them; and what a quarter of the pixels takes
constexpr double kSlowPreview = 0.085, kFastPreview = 0.021;
constexpr int kMostDownscale = 12;
// Pixels that a preview has along its shorter side: one that is reprojected between pictures, and one that is
// not.
constexpr int kLeastSide = 96, kLeastAlone = 40;
constexpr double kLong = 1, kLongLeft = 2; // s: that are past, and left, before time left is told

} // namespace

// A picture of the scene as it is now.
void Viewer::State::begin() {
    picture = *scene;
    missingBake.reset();
    leaveOutMissing(picture);
    applyMatt(mode, picture);
    applyLayer(paintSettings, painting(), picture);
    picture.camera = seenCamera();
    if (dropTime && picture.view.time < *dropTime) dropTime.reset(); // the water begins anew
    ++pictureNumber;
    pictureContent = content;
    failure.clear();
    stale = stopping = false;
    drawingProgress.reset();
    phase = Phase::Preview;
    isTypical = true;
    downscale = std::min(downscale, mostDownscale());
    phaseBegan = secondsNow();
}

int Viewer::State::mostDownscale() const {
    const int least = movedCamera() ? kLeastSide : kLeastAlone;
    return std::clamp(std::min(picturePixels.x, picturePixels.y) / least, 1, kMostDownscale);
}

// Previews have fewer pixels until ten fit into a second.
void Viewer::State::learnDownscale(double took) {
    const int before = downscale;
    // A few that were late are no reason; the first of a size also makes what it is drawn into.
    previewTook = previewTook > 0 ? glm::mix(previewTook, took, 0.25) : took / 2;
    if (previewTook > kSlowPreview)
        downscale *= 2;
    else if (std::max(previewTook, took) < kFastPreview)
        downscale /= 2;
    downscale = std::clamp(downscale, 1, mostDownscale());
    if (downscale == before) return;
    previewTook = 0;
    settled = false; // it is told
}

// How long what is done now will take, going by what it has taken.
void Viewer::State::estimate(const frame::Progress& progress) {
    // Less foretells nothing. Samples of the pixels take as long as each other.
    const float leastShare = progress.task == frame::Task::Samples ? 0.01f : 0.05f;
    drawingProgress.reset();
    const double now = secondsNow(), past = now - phaseBegan;
    if (work.task != progress.task || progress.share < work.share || work.began < phaseBegan)
        work = {.task = progress.task, .began = now, .first = {}, .share = progress.share, .grown = now};
    if (progress.share > work.share) {
        if (!work.first) { // what is made once comes before the first part
            work.first = progress.share;
            work.began = now;
        }
        work.share = progress.share;
        work.grown = now;
    }
    if (past < kLong || progress.complete || play.playing) return;
    const float done = work.share - work.first.value_or(work.share);
    std::optional<double> left;
    if (done > leastShare) {
        const double perDone = (1 - work.share) / done, since = now - work.grown;
        left = std::max((work.grown - work.began) * perDone - since, since * perDone);
    }
    if (past + left.value_or(0) > kLongLeft) drawingProgress = {nameOf(progress.task), progress.share, left};
}

// Works on the picture. A preview is always finished before the next begins, so that a slow machine shows
// something while a hand moves. @return true when there is something new to present
bool Viewer::State::advance() {
    if (!scene) return false;
    const ivec2 size = glm::max(ivec2(glm::round(pictureSize() * scale)), ivec2(1));
    if (size != picturePixels) {
        picturePixels = size;
        shown = false;
        stale = true;
        phase = Phase::Done;
    }
    if (stale && phase != Phase::Preview) begin();
    if (stopping && canPresent()) phase = Phase::Done;
    if (phase == Phase::Done || rests()) return false;
    if (!renderer) renderer = std::make_unique<frame::Renderer>(*context);
    renderer->setDefaultError(defaultError());
    const bool isPreview = phase == Phase::Preview;
    const Result<frame::Progress> progress =
        renderer->advance(picture, pictureNumber, size, isPreview, isPreview ? downscale : 1);
    if (!progress) {
        phase = Phase::Done;
        message = failure = progress.error().message;
        settled = false;
        return false;
    }
    if (!isPreview) estimate(*progress);
    isTypical &= !progress->drawsProbes;
    const bool better = phase != Phase::Smooth || progress->samples > samples;
    samples = progress->samples;
    if (!progress->complete && (isPreview || !better)) return false;
    if (!progress->complete && samples == 0) // light grows
        return std::exchange(stage, progress->stage) != progress->stage;
    if (isPreview) {
        const bool whole = samples > 0 && downscale == 1; // nothing was coarse
        phase = whole ? Phase::Smooth : Phase::Refine;
        if (isTypical) learnDownscale(secondsNow() - phaseBegan);
        phaseBegan = secondsNow();
        stage = 0;
    } else {
        phase = progress->complete ? Phase::Done : Phase::Smooth;
    }
    shown = true;
    shownContent = pictureContent;
    const bool isFirst = std::exchange(shownScene, sceneNumber) != sceneNumber; // whose figures come now
    if (showStats || isFirst) settled = false;
    return true;
}

// The camera as it is now, where nothing else is as it was when what is shown was drawn.
std::optional<scene::Camera> Viewer::State::movedCamera() const {
    if (!shown || shownContent != content || play.playing) return std::nullopt;
    return seenCamera();
}

Status Viewer::State::paint() {
    imguiHost->clear(pixels.x, pixels.y);
    if (scene && shown) {
        const std::optional<frame::Beside> other = beside();
        const std::optional<scene::Camera> moved = movedCamera();
        const scene::Camera* from = moved ? &*moved : nullptr;
        Status presented =
            other ? renderer->present(picture, *other, from) : renderer->present(picture, from);
        if (!presented) return presented;
    }
    return imguiHost->draw(*ImGui::GetDrawData(), fonts().atlas, pixels.x, pixels.y);
}

} // namespace lucent::viewer
