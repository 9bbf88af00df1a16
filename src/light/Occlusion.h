#pragma once
/// Visibility of light samples from what a view shows: one definition for all who shade.

#include "light/KeptShadows.h"
#include "light/Samples.h"

#include <span>
#include <string>
#include <vector>

namespace lucent::views {

/// What a view shows, and what stands in the way of light.
struct Lit {
    const Eye& eye;
    ivec2 size;
    graph::TextureId surface; ///< views.surface
    /// All that stands in the way of light, hidden or not; what is visible and opaque is lit. What lamps send
    /// through what bends light is light of caustics; light of an environment passes straight on.
    Drawables drawables;
    std::optional<light::FlatWaterBlock> water{}; ///< but for this, which bends it
    int shadowSize;                               ///< texels a side of a lamp's shadow view
    bool carriesEnvironment = false;              ///< unless caustics hold that as well
    Bounds beside{};                              ///< box around what else the shadows on meshes shall reach
    bool allAround = false;                       ///< shadows reach what the view does not show, too
    KeptShadows* kept = nullptr;                  ///< null: no picture that follows needs them
    bool keepsParts = true; ///< those of lamps with a size and of environments, too: they stay the same
};

/// The part of its way on which something may keep a light sample from places.
enum class Way : int { Straight, OverWater, BelowWater };

/// What a light sample sees of all that stands in its way.
struct Shadow {
    ShadowViews views;
    graph::TextureId map{}; ///< none: nothing does
    Way way = Way::Straight;
    light::FlatWaterBlock water{}; ///< of ways that are not
};

/// 1 - visibility of some samples at each pixel; see shaders/light/occlusion.glsl.
struct Occlusion {
    graph::TextureId texture{}; ///< none: nothing stands in the way of any
    int columns = 1;
    std::vector<std::vector<Shadow>> shadows{}; ///< of each sample, on all but height fields
    bool byWater = false; ///< samples come by way of water: USE_WATER of shaders/light/sample.glsl
    /// What shaders that read samples are made with.
    std::vector<std::string> defines() const;
};

/// Samples that one recordOcclusion() can take.
int mostSamplesAtOnce(const gl::Context& context, ivec2 size);

/// Draws a shadow view for each sample, one more for each height field that something else may shade: its
/// shadow on itself is left to its technique.
///
/// @param samples  at most mostSamplesAtOnce()
/// @return         Error (Fault::Machine) when a shadow view is larger than this GPU's textures
Result<Occlusion> recordOcclusion(graph::FrameGraph& graph, gl::Context& context, const Lit& in,
                                  std::span<const LampPoint> samples);

/// A view other than the camera's that shows meshes.
struct LitView {
    const Eye& eye;
    ivec2 size;
    graph::TextureId surface; ///< views.surface, or a layer of one object with outward normals
    /// World places of the pixels, xyz, where they do not follow from the eye: of what is unfolded. None:
    /// they do.
    graph::TextureId places{};
    float extent = 0; ///< m that a pixel of such places covers along a side
};

/// The same for another view, by the shadows that are drawn already.
///
/// @param shadows  of the samples
Result<Occlusion> recordOcclusion(graph::FrameGraph& graph, gl::Context& context, const LitView& view,
                                  std::span<const LampPoint> samples,
                                  std::span<const std::vector<Shadow>> shadows);

} // namespace lucent::views
