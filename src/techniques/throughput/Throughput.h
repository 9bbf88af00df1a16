#pragma once
/// Precomputed throughput on the GPU (translucent-objects-2002): the illumination map of an object's atlas,
/// its vertices' irradiance, the product with their factors, and what texels leave around them.

#include "base/Param.h"
#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "scene/Scene.h"
#include "techniques/throughput/BakeTextures.h"
#include "views/Meshes.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::throughput {

enum class Fresnel : int { Exact, Schlick };
enum class Part : int { Whole, Local, Global, Illumination };

struct Settings {
    Local local = Local::Live;
    Global global = Global::Hierarchical;
    Blend blend = Blend::Fitted;
    int side = 512; ///< texels of the atlas
    float epsilon = FactorOptions{}.epsilon;
    float threshold = FactorOptions{}.threshold;
    Fresnel fresnel = Fresnel::Exact;
    Part part = Part::Whole;
    bool operator==(const Settings&) const = default;
};

const ParamTable& params();
BakeOptions optionsOf(const Settings& settings);
/// Whether a parameter changes anything beside these choices.
bool acts(const Settings& settings, std::string_view id);

/// Whether an object is drawn by this technique.
bool bakes(const scene::Object& object);
std::optional<std::string> need(const scene::Scene& scene);

/// What was baked of an object: that of its file, or what is baked now, for a few seconds, and kept with the
/// object. Distances count by themselves (DipoleGeometry::Planar).
Result<std::shared_ptr<const Bake>> bakeOf(const scene::Object& object, const BakeOptions& options);
/// Whether bakeOf() has nothing to work out.
bool isBaked(const scene::Object& object, const BakeOptions& options);
/// Keeps a bake with an object and its copies, as bakeOf() finds it.
void keepBake(const scene::Object& object, const BakeOptions& options, std::shared_ptr<const Bake> made);

/// The light of an object, whose bake others may have too.
struct Body {
    std::shared_ptr<const BakeTextures> baked;
    graph::Texture entered[2]; ///< sum of light samples, and the one before it, in turns
    int now = 0;
};

/// Some of the light samples on their way to the objects.
struct Arriving {
    const views::Eye& eye;
    graph::TextureId table; ///< views::sampleTable()
    std::span<const views::LampPoint> samples;
    int first, end;                                      ///< those that are added
    std::span<const std::vector<views::Shadow>> shadows; ///< of these
    bool irradiance = false;                             ///< all that arrives counts
    ivec2 size{0};                                       ///< of the picture, which shows
    graph::TextureId surface{};                          ///< these, and whose pixels
    const views::Occlusion* occlusion = nullptr;         ///< keeps the samples from
    int placed = 0;       ///< [0, placed) are lamps', of which surfaces show a mirror image
    bool mirrors = false; ///< if this is so
    /// technique::Slice::fluxOn
    std::function<Result<graph::TextureId>(const views::LitView&)> fluxOn{};
};

struct Shown {
    const scene::Scene& scene;
    const views::Eye& eye;
    ivec2 size;
    graph::TextureId surface, target;
    graph::TextureHandle environment; ///< lat-long map; None without one
};

class Throughput {
public:
    explicit Throughput(gl::Context& context) : context_(context) {}

    /// Puts the bakes of objects onto the GPU, and gives back those of others.
    ///
    /// @return  Error naming the object: files that do not fit, meshes that cannot be baked, and
    ///          (Fault::Machine) factors that no texture of this GPU holds
    Status prepare(const std::vector<views::DrawnMesh>& meshes, const Settings& settings);
    Status light(graph::FrameGraph& graph, const Arriving& in, const std::vector<views::DrawnMesh>& meshes,
                 const Settings& settings);
    Status record(graph::FrameGraph& graph, const Shown& in, const std::vector<views::DrawnMesh>& meshes,
                  const Settings& settings);
    /// The atlases themselves, in squares beside each other over the whole target.
    void recordAtlases(graph::FrameGraph& graph, ivec2 size, graph::TextureId target,
                       const Settings& settings);
    std::map<std::string, std::size_t> bytes() const;
    void clear() {
        bodies_.clear();
        for (graph::Texture& texture : mirrored_)
            texture = graph::Texture();
        mirrors_ = false;
    }

private:
    /// Those of a body that there was, or new ones.
    Result<std::shared_ptr<const BakeTextures>> texturesOf(const std::shared_ptr<const Bake>& bake,
                                                           const std::map<int, Body>& before);
    Status addTo(graph::FrameGraph& graph, const Arriving& in, const views::DrawnMesh& mesh, Body& body,
                 const Settings& settings);
    void mirror(graph::FrameGraph& graph, const Arriving& in, const std::vector<views::DrawnMesh>& meshes);
    graph::TextureId multiply(graph::FrameGraph& graph, const Matrix& matrix, graph::TextureId vector,
                              graph::TextureId sum, const char* reason);
    graph::TextureId carried(graph::FrameGraph& graph, const Body& body);
    graph::TextureId spread(graph::FrameGraph& graph, const Body& body, const Settings& settings);
    graph::TextureId spreadSeen(graph::FrameGraph& graph, const Shown& in, const views::DrawnMesh& mesh,
                                const Body& body, const Settings& settings);
    /// An image of its atlas there; or where that is none, what spread_seen.frag reads.
    ///
    /// @param vertices  carried(), for that
    std::vector<graph::TextureId> seen(graph::FrameGraph& graph, const Shown& in,
                                       const views::DrawnMesh& mesh, const BakeTextures& baked,
                                       graph::TextureId image, graph::TextureId vertices);
    graph::TextureId lightOf(graph::FrameGraph& graph, const Body& body, bool isIrradiance,
                             const Settings& settings);

    gl::Context& context_;
    std::map<int, Body> bodies_; ///< by the object's place in the scene
    graph::Texture mirrored_[2]; ///< by all of them, of lamps; the sum and the one before it, in turns
    int mirroredNow_ = 0;
    bool mirrors_ = false; ///< there is such a sum
};

} // namespace lucent::throughput
