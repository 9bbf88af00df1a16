#pragma once
/// An environment's light on a height field for one dot product a texel, however the environment turns.
///
/// d(texel, direction) is traced once, projected on a basis made for the field (Basis.h), and kept as a few
/// coefficients a texel. The environment becomes as many numbers. Precomputed radiance transfer (Sloan,
/// Kautz, Snyder 2002) for the relief model.

#include "graph/FrameGraph.h"
#include "techniques/relief/Basis.h"
#include "techniques/relief/Relief.h"

#include <memory>
#include <optional>
#include <vector>

namespace lucent::relief {

/// An environment as many small distant lights in world space.
struct SmallLight {
    vec3 direction; ///< unit, towards the light
    vec3 color;     ///< radiance times share of the sphere
    float weight;   ///< share in the mean of d
};

/// The transfer of one object: traced step by step, then good for any environment.
class Transfer {
public:
    /// What a transfer depends on.
    struct Key {
        std::shared_ptr<const Image> heights;
        float width, heightScale, depth; ///< depth in the object's space
        Attenuation attenuation;
        int terms;
        bool operator==(const Key&) const = default;
    };
    static Key keyOf(const scene::Object& object, const Settings& settings);

    Transfer(gl::Context& context, Key key);

    const Key& key() const { return key_; }
    bool ready() const { return phase_ == Phase::Ready; }
    /// Finished part of the work, [0,1].
    float share() const;
    /// One piece of the work, a few million rays at most; waits until the GPU has done it.
    Status step(graph::TexturePool& pool, const views::DrawnField& drawn);
    std::size_t bytes() const { return coefficients_.desc().bytes(); }

    /// Brings an environment onto the basis: what follows shows it.
    ///
    /// @param views  unit directions eye -> surface in the object's space: one, or those at kNodes x kNodes
    ///               places spread over the footprint, the top row first
    /// @param error  wanted RMSE over the mean, on texels kept back: no more terms are used than keep it; 0:
    ///               all
    void setEnvironment(const scene::Object& object, const std::vector<SmallLight>& lights,
                        const std::vector<vec3>& views, float error);
    /// Forward scatter changes with the direction to the eye: it is known at so many places along a side and
    /// interpolated between them.
    static constexpr int kNodes = 5;
    /// The environment's light on every texel (shaders/relief/gather.frag), ready to be sampled.
    Result<graph::TextureId> recordIrradiance(graph::FrameGraph& graph) const;
    /// The environment's part of the specular term by the direction of reflection (glossAt() of
    /// shaders/relief/light.frag).
    const graph::Texture& gloss() const { return gloss_; }

private:
    enum class Phase { Sample, Trace, Ready };
    ivec2 tiles() const;
    /// A small light in the object's space, with the cell that it shines from.
    struct CellLight {
        SmallLight light;
        int cell;
    };
    std::vector<CellLight> cellLights(const std::vector<SmallLight>& lights,
                                      const mat3& objectFromWorld) const;
    /// The light from each cell: colour as a material scatters it towards the eye, and share in the mean of
    /// d.
    std::vector<vec4> fluxOf(const std::vector<CellLight>& lights, const scene::Material& material,
                             vec3 view) const;
    Status run(graph::TexturePool& pool, const char* pass, const graph::Texture& target,
               const std::function<void(graph::Commands&)>& draw);
    Status sample(graph::TexturePool& pool, const views::DrawnField& drawn);
    Status trace(graph::TexturePool& pool, const views::DrawnField& drawn);
    Status project(graph::TexturePool& pool, ivec2 corner);
    void drawGloss(const scene::Material& material, const std::vector<CellLight>& lights);

    gl::Context& context_;
    Key key_;
    ivec2 grid_; ///< texels of the transfer
    Cells cells_;
    Phase phase_ = Phase::Sample;
    int row_ = 0;  ///< of the sample, or of the blocks of a tile
    int tile_ = 0; ///< being traced
    int rowsAtOnce_ = 1;
    graph::Texture directions_, sampled_, traced_, coefficients_, gloss_;
    graph::Texture nodes_; ///< light_ of several views, a row each
    Basis basis_;
    int termsUsed_ = 0;
    std::vector<vec4> light_; ///< the environment on the basis, for each view kMostTerms
};

/// Rays that making a transfer takes: what it costs, in the measure of a picture with one light.
double transferRays(ivec2 texels, int terms);

/// The environment of a scene, which must have one, as lights small enough for a transfer.
std::vector<SmallLight> smallLights(const scene::Scene& scene, const Settings& settings);

} // namespace lucent::relief
