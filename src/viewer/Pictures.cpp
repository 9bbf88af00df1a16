// Work on the picture, and the way to the screen.
#include "viewer/State.h"

#include <algorithm>

namespace lucent::viewer {

// Works on the picture. A quick look is always finished before the next begins, so that a slow machine shows
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
    if (stale && phase != Phase::Look) {
        picture = *scene;
        applyMatt(mode, picture);
        applyLayer(paintSettings, painting(), picture);
        picture.camera = seenCamera();
        if (dropTime && picture.view.time < *dropTime) dropTime.reset(); // the water begins anew
        ++pictureNumber;
        failure.clear();
        stale = false;
        phase = Phase::Look;
    }
    if (phase == Phase::Done || rests()) return false;
    if (!renderer) renderer = std::make_unique<frame::Renderer>(*context);
    const Result<frame::Progress> progress =
        renderer->advance(picture, pictureNumber, size, phase == Phase::Look);
    if (!progress) {
        phase = Phase::Done;
        message = failure = progress.error().message;
        settled = false;
        return false;
    }
    const bool better = phase != Phase::Smooth || progress->samples > samples;
    samples = progress->samples;
    if (!progress->complete && (phase == Phase::Look || !better)) return false;
    if (!progress->complete && samples == 0) return true; // light grows
    if (phase == Phase::Look)
        phase = samples > 0 ? Phase::Smooth : Phase::Refine; // nothing was coarse
    else
        phase = progress->complete ? Phase::Done : Phase::Smooth;
    shown = true;
    if (showStats) settled = false;
    return true;
}

Status Viewer::State::paint() {
    imguiHost->clear(pixels.x, pixels.y);
    if (scene && shown) {
        const std::optional<frame::Beside> other = beside();
        Status presented = other ? renderer->present(picture, *other) : renderer->present(picture);
        if (!presented) return presented;
    }
    return imguiHost->draw(*ImGui::GetDrawData(), fonts().atlas, pixels.x, pixels.y);
}

} // namespace lucent::viewer
