#pragma once
/// Pictures that are drawn to be read back: where a frame must not wait for the GPU it asks now and reads
/// later.

#include "gl/Context.h"
#include "gl/Fence.h"
#include "graph/FrameGraph.h"

#include <functional>
#include <map>
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
        areThere_ = true;
    }
    /// Whether all questions of this round were answered.
    bool areThere() const { return areThere_; }
    /// Forgets what was asked.
    void clear() { asked_.clear(); }
    /// Whether the GPU has drawn all that was asked.
    bool areDrawn() const;

    /// What was drawn.
    ///
    /// @param question  the same in every round, and nobody else's
    /// @param record    adds the passes that draw it, and says where; again until it could be drawn
    /// @return          null: it is not there yet
    Result<const Image*> of(const std::string& question, graph::TexturePool& pool, gl::Context& context,
                            const std::function<Result<graph::Texture>(graph::FrameGraph&)>& record);

private:
    struct Asked {
        graph::Texture texture;
        gl::Fence drawn{};
        Image image{};
    };
    Result<bool> draw(const std::string& question, graph::TexturePool& pool,
                      const std::function<Result<graph::Texture>(graph::FrameGraph&)>& record);
    std::map<std::string, Asked> asked_;
    std::function<bool()> canDraw_;
    bool areThere_ = true;
};

} // namespace lucent::views
