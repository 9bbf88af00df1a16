#pragma once
/// The transfers of all visible height fields of a scene: made piece by piece, then lit by any environment.

#include "techniques/relief/Transfer.h"
#include "views/Eye.h"

namespace lucent::relief {

class Transfers {
public:
    explicit Transfers(gl::Context& context) : context_(context) {}

    /// Whether every transfer is there that the scene needs.
    bool ready(const scene::Scene& scene, const Settings& settings) const;
    /// Works on what is missing for about `milliseconds`. @return whether all are ready
    Result<bool> make(graph::TexturePool& pool, const std::vector<views::DrawnField>& objects,
                      const Settings& settings, double milliseconds);
    /// Finished part of the work, [0,1].
    float share() const;
    /// Brings the scene's environment onto the transfers, which must be ready.
    ///
    /// @param error  wanted RMSE over the mean on the texels of a transfer: no more terms are used than keep
    ///               it; 0: all
    void light(const scene::Scene& scene, const views::Eye& eye,
               const std::vector<views::DrawnField>& objects, const Settings& settings, float error);
    /// Adds what the light pass needs to a graph, one for each object.
    Result<std::vector<Transferred>> record(graph::FrameGraph& graph) const;

    std::size_t bytes() const;
    void clear() { transfers_.clear(); }

private:
    gl::Context& context_;
    std::vector<std::unique_ptr<Transfer>> transfers_;
};

} // namespace lucent::relief
