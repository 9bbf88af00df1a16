#include "viewer/History.h"

#include <algorithm>

namespace lucent::viewer {

namespace {
constexpr std::size_t kMostSteps = 100000; // some 100 bytes each
}

void History::record(std::uint64_t gesture, Change change) {
    steps_.resize(done_);
    if (steps_.empty() || steps_.back().gesture != gesture) {
        if (steps_.size() == kMostSteps) steps_.erase(steps_.begin());
        steps_.push_back({gesture, {}});
        done_ = steps_.size();
    }
    std::vector<Change>& changes = steps_.back().changes;
    const auto same = std::find_if(changes.begin(), changes.end(),
                                   [&](const Change& old) { return old.path == change.path; });
    if (same != changes.end()) {
        same->after = std::move(change.after);
        if (same->conversion) same->conversion->after = std::move(change.conversion->after);
    } else
        changes.push_back(std::move(change));
}

std::vector<Change> History::undo() {
    if (done_ == 0) return {};
    std::vector<Change> changes = steps_[--done_].changes;
    std::reverse(changes.begin(), changes.end());
    return changes;
}

std::vector<Change> History::redo() {
    if (done_ == steps_.size()) return {};
    // A redone step is closed: what follows is a new gesture even where numbers agree.
    steps_[done_].gesture = 0;
    return steps_[done_++].changes;
}

void History::clear() {
    steps_.clear();
    done_ = 0;
}

} // namespace lucent::viewer
