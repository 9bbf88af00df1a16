#pragma once
/// Light that enters scattering objects: the sum of the light samples on all of their surfaces and on what
/// the camera shows of them, slice by slice.

#include "base/Kept.h"
#include "techniques/subsurface/Splatting.h"
#include "views/ObjectKey.h"

namespace lucent::subsurface {

/// All surfaces of an object: layers behind each other along three axes.
struct LitBody {
    std::array<std::vector<LitLayer>, 3> layers;
};
/// What it depends on.
struct EnteredKey {
    std::vector<views::ObjectKey> objects{};              ///< all that stand in the light's way
    std::vector<std::shared_ptr<const void>> paintings{}; ///< of meshes
    std::vector<views::LampPoint> samples{};
    struct Body {
        float ior;
        std::array<int, 3> layers;
        std::array<ivec2, 3> sizes;
        bool operator==(const Body&) const = default;
    };
    std::vector<Body> bodies{};
    int shadowSize = 0;
    bool onLayers = false;
    bool operator==(const EnteredKey&) const = default;
};

/// Lamps without size light what they see of an object, each by a view of its own; where there are others or
/// an environment, all samples are summed on the object's layers.
class Entering {
public:
    /// Adds the passes of a slice; the first one of a stage begins anew.
    Status add(graph::FrameGraph& graph, gl::Context& context, const Arriving& in, const Plan::State& plan,
               const Settings& settings);
    /// What was recorded last did not run.
    void forget() { key_.reset(); }

    /// Of the last stage.
    const std::vector<views::LampPoint>& samples() const { return samples_; }
    bool onLayers() const { return onLayers_; }
    /// Of an object of the scene, where light lies on layers; null: it has none.
    const LitBody* of(int object) const;
    /// Where the camera shows it: what is mirrored of lamps, and what enters of methods that ask for it
    /// there.
    const Entered* seen() const { return seen_ ? &*seen_ : nullptr; }
    /// What the complete sum depends on; nothing where that may change unseen.
    const std::optional<EnteredKey>& key() const { return key_; }

private:
    Status peel(graph::FrameGraph& graph, gl::Context& context, const Arriving& in, const Plan::State& plan);
    Status addTo(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                 const Plan::State::Object& object, int axis, LitLayer& layer);
    Status addSeen(graph::FrameGraph& graph, gl::Context& context, const Arriving& in,
                   const Settings& settings);

    std::vector<views::LampPoint> samples_;
    std::map<int, LitBody> bodies_; // by the object's place in the scene
    std::optional<Entered> seen_;
    std::optional<EnteredKey> key_, wanted_; // of the sum that is complete; of the one that grows
    bool onLayers_ = false, isKept_ = false;
    Kept wholes_; // shares that leave again, by medium
};

} // namespace lucent::subsurface
