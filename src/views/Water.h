#pragma once
/// Water as an image of heights that is stepped through time: a texel a crossing of its grid's lines.

#include "gl/Context.h"
#include "scene/Mesh.h"
#include "scene/Water.h"
#include "shaders/views/Blocks.h"
#include "views/Pose.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace lucent::views {

/// How far the surface may stand above or below its mean, m: where two walls mirror a crest it is four times
/// as high. Drops of the pointer are no part of it.
float waterReach(const scene::Water& water);

using scene::WaterDrop;

/// One sheet of water. Its state at a time follows from the scene and the drops alone, to the bit: steps have
/// equal lengths (scene::waterStepsPerSecond). Borders are walls that mirror waves. With Water::dropInterval
/// a drop falls after each interval, at most one a step (scene::fallingDrop).
class WaterSheet {
public:
    /// Error (Fault::Machine) when the grid is larger than this GPU's textures.
    static Result<std::unique_ptr<WaterSheet>> create(gl::Context& context, const scene::Water& water);

    bool shows(const scene::Water& water) const;
    /// What advance() would compute to be at `time` [s]: steps times cells.
    double workUntil(float time) const;
    /// Goes on to `time` [s], or begins anew where that lies behind; drops of the pointer that fell later are
    /// then forgotten.
    ///
    /// @param most  steps at once
    /// @return      whether it is there
    bool advance(float time, int most);
    void fall(const WaterDrop& drop);

    /// RG32F, shaders/views/water.glsl.
    const graph::Texture& state() const { return now_; }
    std::size_t bytes() const { return now_.desc().bytes() + next_.desc().bytes(); }
    std::uint64_t changes() const { return changes_; } ///< grows with each change of what is seen
    /// Of shaders/views/water.frag, for a mesh of so many squares.
    graph::Block block(ivec2 squares) const;

private:
    struct Fallen {
        std::int64_t step;
        WaterDrop drop;
    };
    WaterSheet(gl::Context& context, const scene::Water& water);
    void begin();
    void step();
    void draw(const gl::Program& program, const WaterDrop& drop);
    WaterBlock blockFor(const WaterDrop& drop) const;

    gl::Context& context_;
    scene::Water water_;
    ivec2 cells_;
    double seconds_;        // of a step
    std::int64_t done_ = 0; // steps
    float rest_ = 0;        // s since the last one
    graph::Texture now_, next_;
    const gl::Program *start_ = nullptr, *step_ = nullptr, *drop_ = nullptr;
    std::vector<Fallen> fallen_; // of the pointer
    std::uint64_t changes_ = 0;
};

/// All sheets of water of a scene. Who draws scenes keeps one.
class Waters {
public:
    /// What one call of advance() computes at most of each sheet: two seconds where its waves allow steps of
    /// 1/120 s.
    static constexpr int kStepsAtOnce = 240;

    explicit Waters(gl::Context& context) : context_(context) {}

    /// Brings every sheet nearer to scene.view.time. A sheet whose shape has changed begins anew.
    ///
    /// Error where the time lies more than scene::kMostWaterWork ahead of what a sheet shows; time that runs
    /// goes on without end. @return whether all of them are there; if not, what is drawn shows an earlier
    /// time, and another call goes
    ///         on
    Result<bool> advance(const scene::Scene& scene);
    /// A drop falls into an object, which advance() has met as water, at the time that it shows.
    void fall(int object, const WaterDrop& drop);
    /// The sheet of an object, or null.
    const WaterSheet* of(int object) const;
    /// Differs where what any sheet shows differs.
    std::uint64_t changes() const;
    std::size_t bytes() const;
    void clear() { sheets_.clear(); }

private:
    gl::Context& context_;
    std::map<int, std::unique_ptr<WaterSheet>> sheets_; // by the object's number in the scene
    std::uint64_t dropped_ = 0;                         // changes of sheets that are no more
};

/// Draws the vertices of an object whose sheet that is.
Result<VertexImages> recordWater(graph::FrameGraph& graph, gl::Context& context, const WaterSheet& sheet,
                                 const scene::Object& object);

} // namespace lucent::views
