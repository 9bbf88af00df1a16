#pragma once
/// What left in the picture before, carried along with what moves: few points then flicker less from picture
/// to picture. In place of the dissertation's 6.5.2, which splats points of the picture before: a picture's
/// points are then those of the one before it, and change as much, one picture late.

#include "light/Samples.h"
#include "techniques/subsurface/Splatting.h"
#include "views/ObjectKey.h"

namespace lucent::subsurface {

/// All that decides whether one picture follows another.
struct Moment {
    struct Body {
        int index = 0; ///< in the scene
        views::ObjectKey key;
        std::shared_ptr<const void> painting;
        std::array<diffusion::Medium, 3> media;
        float thickness = 0; ///< m, of a slab
        bool operator==(const Body&) const = default;
    };
    ivec2 size{0};
    views::Eye eye;
    Settings settings;
    std::vector<Body> bodies;
    std::vector<views::LampPoint> lamps;
    std::shared_ptr<const void> map; ///< of the environment
    vec4 sky{0};                     ///< its rotation [degrees] and intensity
};
/// Whether light of the one moment may stand for that of the other: the same bodies and lamps in a picture of
/// the same size, turned by little, and not the very same picture.
bool follows(const Moment& now, const Moment& then);

/// Kept from picture to picture.
struct TemporalHistory {
    Moment moment;
    graph::Texture light;  ///< W/m²
    graph::Texture places; ///< subsurface/receivers.frag
    bool drawn = false;    ///< by a graph that ran
};

/// Adds the passes that mix what leaves with what left there in the picture before. What changes evenly over
/// some points' distances is taken from the new picture, so that light does not lag behind; what changes from
/// place to place is mostly taken from the old one. A picture that follows none is left as it is.
Result<Radiosity> recordSteady(graph::FrameGraph& graph, gl::Context& context, const Inputs& in,
                               const Plan::State& plan, const Radiosity& now, const Settings& settings,
                               const std::shared_ptr<TemporalHistory>& history);

} // namespace lucent::subsurface
