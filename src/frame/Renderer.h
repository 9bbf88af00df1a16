#pragma once
/// The planner and its caches: from a scene to a picture, doing only what this scene needs.

#include "base/Image.h"
#include "base/Param.h"
#include "base/Result.h"
#include "gl/Context.h"
#include "scene/Scene.h"
#include "technique/Guest.h"
#include "views/Water.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace lucent::frame {

class Budget;

/// What is done for a picture: its settings are chosen, what rays meet that leave it is drawn, then the first
/// of each pixel's samples, whose lights are summed over several slices of work, then the others. Few lights
/// are summed before what rays meet is drawn.
enum class Task { Settings, Surroundings, Picture, Samples };
/// "Choosing settings"
std::string_view nameOf(Task task);

/// How far the picture is.
struct Progress {
    bool complete = false;
    int samples = 0; ///< of the pixels, whose mean is shown; 0: no more than a preview
    int stage = 0;   ///< grows whenever what is shown becomes better
    Task task = Task::Settings;
    float share = 0;          ///< of the task's work that is done, about, [0,1]
    bool drawsProbes = false; ///< reflection probes, which pictures after it keep: these take less time
};

/// What the last complete picture cost.
struct Stats {
    int passes = 0;          ///< passes since the picture began
    int draws = 0;           ///< draw calls since the picture began
    int lights = 0;          ///< lights summed (an environment counts its samples)
    std::size_t bytes = 0;   ///< GPU memory of textures
    double milliseconds = 0; ///< from the first slice to the finished last one
    std::string settings;    ///< what quality.maxError chose, for people; "" without it
    /// By table: what the picture was made with, chosen or the scene's own.
    std::map<std::string, Settings> technique;
    double predicted = 0;        ///< RMSE over the mean that was predicted for it
    double planMilliseconds = 0; ///< of them, for choosing
};

/// Ends of the false colours in which a caustic map is shown, 1: what the light leaves undisturbed.
inline constexpr float kMapDarkest = 1.0f / 16, kMapBrightest = 64;

/// Another picture, right of a divider in place of the one that is drawn: its truth, its error, or the same
/// scene drawn otherwise. Places are pixels of the drawn one from its top left corner.
struct Beside {
    const Image& image;       ///< linear, 4 channels, of the quantity that is shown; the fourth is coverage,
                              ///< below 0 where it is not known
    std::uint64_t number = 0; ///< changes when the image does, > 0
    bool isError = false;     ///< its values are differences
    float full = 1;           ///< then: what gets the last colour of measure::heatMap(), > 0
    vec2 corner{0};           ///< its upper left one
    float pixelsPerTexel = 1; ///< how large one of its pixels is; nothing is smoothed
    float divider = 0;        ///< from the left side
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
    /// @param coarse    a preview while something is dragged: few environment samples
    /// @param downscale    of a coarse one: how many pixels of the picture share one that is drawn, along
    /// each
    ///                  side; >= 1
    /// @return          Error (Fault::Machine) when the GPU cannot, naming the missing capability
    Result<Progress> advance(const scene::Scene& scene, std::uint64_t revision, ivec2 size,
                             bool coarse = false, int downscale = 1);

    /// Error of pictures whose scene asks for none (quality.maxError), [0,1); 0: in full. They take no more
    /// samples than the scene has. Counts from the next picture on.
    void setDefaultError(float error);

    /// Whether present() shows a picture: none that is being drawn into.
    bool canPresent() const;
    /// Draws the picture so far, tone-mapped, into the default framebuffer (premultiplied alpha); one that
    /// was drawn smaller is smoothed.
    ///
    /// @param from  a camera that has moved since, while nothing else has: until its own picture is drawn,
    /// the
    ///              last one is reprojected to it by the depths of what is seen; null: as it was drawn
    Status present(const scene::Scene& scene, const scene::Camera* from = nullptr);
    /// The same with another picture beside it.
    Status present(const scene::Scene& scene, const Beside& beside, const scene::Camera* from = nullptr);

    /// Runs advance() until complete.
    Status finish(const scene::Scene& scene, std::uint64_t revision, ivec2 size);

    /// Whether present() showed a reprojection last.
    bool isReprojected() const;

    /// A drop falls into the water that an object is, at the moment that was drawn last; the picture must
    /// then be drawn anew, with another revision. @return false where no water has been drawn
    bool drop(int object, const views::WaterDrop& drop);

    /// Returns when the GPU has finished the picture.
    void wait();

    /// Linear values of an AOV, 4 channels; the fourth is coverage. Color without tone mapping, the mean over
    /// each pixel where technique.sampling.pixelSamples is above 1; every other AOV is what the pixel's
    /// middle shows. Draws the picture again when it does not show that AOV.
    Result<Image> read(const scene::Scene& scene, scene::Aov aov);
    /// The tone-mapped picture (exposure, sRGB), 4 channels in [0,1], straight alpha: what PNG files hold.
    Result<Image> readDisplay(const scene::Scene& scene);

    /// What became of the light that a technique carried in the finished picture; empty where it carries
    /// none. Draws it again and reads it back.
    Result<technique::Balance> balance(const scene::Scene& scene, std::string_view technique);

    Stats stats() const;
    /// Every pass with its reason, size, format and bytes, and what was left out and why.
    Result<std::string> explain(const scene::Scene& scene, ivec2 size);
    /// Gives all GPU memory back; the next advance() builds it again.
    void release();

private:
    friend class Budget;
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent::frame
