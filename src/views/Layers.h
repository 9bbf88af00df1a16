#pragma once
/// Layered images of a view: all surfaces of refractive objects behind each other, nearest first.

#include "gl/Query.h"
#include "views/Drawable.h"
#include "views/Readings.h"
#include "views/Triangles.h"

#include <algorithm>

namespace lucent::views {

/// More are not drawn.
inline constexpr int kMostLayers = 32;

/// One view's layers, ready to be traced (shaders/views/layers.glsl).
struct Layers {
    graph::TextureId images;  ///< RGBA32F array, shaders/views/layer_texel.glsl
    graph::TextureId blocks;  ///< RGBA32F array, shaders/views/blocks.frag
    graph::TextureId depth;   ///< depth buffer of the nearest surfaces, 1 where there is none
    TriangleImages triangles; ///< that the texels lead to
    int count = 0;
};

/// Images that outlive the frame, so that the layers of a view that stands still are drawn once.
struct KeptLayers {
    graph::Texture images, blocks, depth;
    int count = 0;        ///< layers that were drawn
    bool current = false; ///< they are still as they were: who keeps them says so
};

/// How many surfaces lie behind each other at most in any pixel, by drawing all of them once. At most
/// kMostLayers; more are named in a warning.
///
/// @param question  of Readings::of()
/// @return          1 while the answer is not there
Result<int> countLayers(Readings& readings, const std::string& question, graph::TexturePool& pool,
                        gl::Context& context, const Eye& eye, const Drawables& glass, float time, ivec2 size);

/// Asks what the layers of a frame leave out; null: nobody asks.
struct LayerQueries {
    graph::Query* last = nullptr;   ///< whether the last layer holds anything
    graph::Query* behind = nullptr; ///< whether there are surfaces behind it
};

/// How many layers to draw, frame after frame, without waiting for the GPU: as many as there were, and
/// queries on the last one and on what is behind it, whose answers come in later frames. A layer that appears
/// is drawn a frame late.
class LayerCount {
public:
    explicit LayerCount(const gl::Device& device) : last_(device), behind_(device) {}

    /// Forgets the scene and what was asked; what countLayers() finds is known next.
    void reset() { known_ = asked_ = 0; }
    bool known() const { return known_ > 0; }
    void start(int counted) {
        known_ = std::max(1, counted);
        asked_ = 0;
    }

    /// What was asked last has not run: nobody answers.
    void withdraw() { asked_ = 0; }

    /// Layers to draw.
    int drawn() const { return std::max(1, known_); }
    /// For the frame that draws drawn() layers; empty while an answer is still on its way, so that frames
    /// faster than answers do not put them off for ever.
    LayerQueries ask();
    /// Takes the answers that have come.
    ///
    /// @return  whether there was something behind the last layer: the picture lacks surfaces and is to be
    /// drawn again
    bool poll();
    /// Whether answers are still on their way: poll() again after the next frame, drawn or not.
    bool waits() const { return asked_ > 0; }

private:
    gl::Query last_, behind_;
    int known_ = 0; // surfaces behind each other
    int asked_ = 0; // layers of the frame that was asked about; 0: none
};

/// Draws `count` layers, one a pass.
///
/// @param glass  refractive objects; a texel's is the place in this list
/// @param solid  opaque surfaces (views::recordSolid), to be traced with the layers as one more; or none
/// @param kept   where they stay, and are only drawn where they are not current or another number is wanted;
///               null: images of this frame
Result<Layers> recordLayers(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                            const Drawables& glass, ivec2 size, int count, graph::TextureId solid,
                            const LayerQueries& queries = {}, KeptLayers* kept = nullptr);

/// What shaders/views/layers.glsl samples.
void sampleLayers(graph::PassBuilder& pass, const Layers& layers);
std::vector<graph::Binding> layerBindings(const graph::Resources& resources, const Layers& layers);

} // namespace lucent::views
