#pragma once
/// The planner and its caches: from a scene to a picture, doing only what this scene needs.

#include "base/Image.h"
#include "base/Param.h"
#include "base/Result.h"
#include "gl/Context.h"
#include "scene/Scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace lucent::frame {

/// Parameter tables of all techniques, for the loader, `lucent list` and the documentation.
std::span<const ParamTable* const> techniques();

/// How far the picture is: many lights are summed over several slices of work.
struct Progress {
    bool complete = false;
    float fraction = 0; ///< of the light that the picture will have, [0,1]
};

/// What the last complete picture cost.
struct Stats {
    int passes = 0;          ///< passes since the picture began
    int draws = 0;           ///< draw calls since the picture began
    int lights = 0;          ///< lights summed (an environment counts its samples)
    std::size_t bytes = 0;   ///< GPU memory of textures
    double milliseconds = 0; ///< from the first slice to the finished last one
};

/// Draws one scene again and again. One per viewer; the context and its programs are shared.
class Renderer {
public:
    explicit Renderer(gl::Context& context);
    ~Renderer();

    /// Does one slice of work (a few tens of milliseconds on a software renderer) on the picture of `scene`.
    ///
    /// @param revision  changes whenever the scene changed; the picture then starts again
    /// @param size      of the picture in pixels, > 0
    /// @param coarse    a first look while something is dragged: few environment samples
    /// @return          Error (Fault::Machine) when the GPU cannot, naming the missing capability
    Result<Progress> advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size,
                             bool coarse = false);

    /// Draws the picture so far, tone-mapped, into the default framebuffer (premultiplied alpha).
    Status present(const scene::Scene& scene);

    /// Runs advance() until complete.
    Status finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size);

    /// Returns when the GPU has finished the picture.
    void wait();

    /// Linear values of an AOV, 4 channels; the fourth is coverage. Color without tone mapping. Draws the
    /// picture again when it does not show that AOV.
    Result<Image> read(const scene::Scene& scene, scene::Aov aov);
    /// The tone-mapped picture (exposure, sRGB), 4 channels in [0,1], straight alpha: what PNG files hold.
    Result<Image> readDisplay(const scene::Scene& scene);

    Stats stats() const;
    /// Every pass with its reason, size, format and bytes, and what was left out and why.
    Result<std::string> explain(const scene::Scene& scene, ivec2 size);
    /// Gives all GPU memory back; the next advance() builds it again.
    void release();

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent::frame
