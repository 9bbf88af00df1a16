#pragma once
/// All points of all lights, splatted onto what the camera shows of scattering objects.

#include "techniques/subsurface/Kernel.h"
#include "techniques/subsurface/Points.h"
#include "techniques/subsurface/Subsurface.h"

namespace lucent::subsurface {

/// Points are laid out for surfaces that face the light at up to 45 degrees: their distance on one that faces
/// it, over that on these.
inline constexpr float kTilt = 0.70710678f;

/// What a kernel is made of.
struct Wanted {
    std::array<diffusion::Medium, 3> media;
    KernelWish wish;
    double width = 0; ///< m, of a light's view at most
    std::optional<int> paper =
        {}; ///< as many splats a side as the dissertation asks for, but no more than this
    bool operator==(const Wanted&) const = default;
};

/// A kernel on the GPU.
struct Profiled {
    Wanted of;
    Kernel kernel;
    std::vector<graph::Texture> tables; ///< one a band
    std::array<std::vector<diffusion::Pole>, 3> poles;
};

struct Plan::State {
    struct Object {
        int index = 0; ///< in the scene
        std::shared_ptr<const Profiled> profile;
        std::array<int, 3> layers{}; ///< along its axes; 0 where lamps light what they see
        std::array<views::Eye, 3> axes{};
        std::array<ivec2, 3> sizes{}; ///< of those views
    };
    std::vector<Object> objects;
    bool onLayers = false; ///< light is summed on layers; else lamps light what they see
};

class Entering;

/// How an object's points are laid out.
struct Layout {
    Grid grid;
    int coarser = 0; ///< levels than a band's finest that it may use

    /// Of views along the object's axes: no surface that counts there is as steep as in a lamp's.
    Layout alongAxes() const;
    int refined = 0; ///< levels that are finer than what faces a view asks for
};
Layout layoutOf(const Profiled& profile, const views::DrawnMesh& mesh, const Settings& settings,
                int maxTextureSize);

/// What leaves at each pixel.
struct Radiosity {
    graph::TextureId light;    ///< of the picture's size
    float unit = 1;            ///< W/m² that counts as 1
    graph::TextureId places{}; ///< subsurface/receivers.frag, of each pixel, where points were summed
};
/// Adds the passes that sum it. Where the GPU cannot add to 32-bit floats, each pixel gathers its light in
/// sums of some thousand points, which 16-bit floats add up: about 3 digits.
Result<Radiosity> recordRadiosity(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                                  const Plan::State& plan, const Entering& entering,
                                  const Settings& settings);

} // namespace lucent::subsurface
