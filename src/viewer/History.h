#pragma once
/// What was changed, so that it can be taken back.

#include "scene/Scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lucent::viewer {

/// What an object's kind of material takes with it: all materials before and after.
struct Conversion {
    std::vector<scene::Material> before, after;
};

/// What an environment that is opened takes with it.
struct Lighting {
    std::optional<scene::Environment> environment;
    float exposure;
};
struct Relighting {
    Lighting before, after;
};

/// One parameter's value before and after.
struct Change {
    std::string path, before, after;
    std::optional<Conversion> conversion = {}; ///< then in place of the values
    std::optional<Relighting> relighting = {}; ///< or this
};

/// Undo and redo. Changes of one gesture (a drag, a burst of typing) are one step; the oldest steps are
/// forgotten.
class History {
public:
    /// @param gesture  changes with the same number as the newest step join it
    void record(std::uint64_t gesture, Change change);
    /// The changes to take back, last one first; empty when there are none.
    std::vector<Change> undo();
    /// The changes to make again, in order; empty when there are none.
    std::vector<Change> redo();
    void clear();
    bool canUndo() const { return done_ > 0; }
    bool canRedo() const { return done_ < steps_.size(); }

private:
    struct Step {
        std::uint64_t gesture;
        std::vector<Change> changes;
    };
    std::vector<Step> steps_;
    std::size_t done_ = 0; ///< steps_[done_...] were undone
};

} // namespace lucent::viewer
