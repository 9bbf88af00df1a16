#pragma once
/// Numbers that are drawn to be read back: where a frame must not wait for the GPU it asks now and reads
/// later.

#include "gl/Context.h"
#include "gl/Fence.h"
#include "graph/FrameGraph.h"

#include <functional>
#include <map>
#include <optional>
#include <string>

namespace lucent::views {

/// Whoever asks does so again until all answers are there.
class Readings {
public:
    /// Begins a round of questions.
    ///
    /// @param canDraw  whether drawing now waits for nothing; null: every answer is waited for, as it is
    /// before the first round
    void restart(std::function<bool()> canDraw) {
        canDraw_ = std::move(canDraw);
        missing_ = 0;
    }
    /// How many questions of this round were not answered.
    int missing() const { return missing_; }
    bool areThere() const { return missing_ == 0; }
    /// Forgets what was asked.
    void clear() { asked_.clear(); }
    /// Whether the GPU has drawn all that was asked.
    bool areDrawn() const;

    /// The greatest red of a picture, at least 0.
    ///
    /// @param question  the same in every round, and nobody else's
    /// @param record    adds the passes that draw it, and says where; again until it could be drawn
    /// @return          nothing: it is not there yet
    Result<std::optional<float>>
    most(const std::string& question, graph::TexturePool& pool, gl::Context& context,
         const std::function<Result<graph::TextureId>(graph::FrameGraph&)>& record);

private:
    struct Asked {
        graph::Texture maxima;
        gl::Fence drawn{};
        std::optional<float> answer{};
    };
    Result<bool> draw(const std::string& question, graph::TexturePool& pool, gl::Context& context,
                      const std::function<Result<graph::TextureId>(graph::FrameGraph&)>& record);
    std::map<std::string, Asked> asked_;
    std::function<bool()> canDraw_;
    int missing_ = 0;
};

} // namespace lucent::views
