#pragma once
/// Everything that is no height field: opaque objects and mirrors with the caustics on them, over the light
/// on the fields, and all of it seen through refractive objects.

#include "brdf/Brdf.h"
#include "caustics/Caustics.h"
#include "refract/Refract.h"
#include "views/Surface.h"
#include "views/Water.h"

namespace lucent::frame {

/// The objects that a picture shows.
struct Drawn {
    std::vector<views::DrawnObject> fields;
    views::DrawnMeshes meshes;

    std::size_t count() const { return fields.size() + meshes.solid.size() + meshes.glass.size(); }
};
Result<Drawn> drawnOf(const scene::Scene& scene, views::ImageCache& images, const views::Waters& waters);

class Compose {
public:
    Compose(gl::Context& context, graph::TexturePool& pool, views::ImageCache& images)
        : context_(context), pool_(pool), images_(images), waters_(context), caustics_(context),
          brdf_(context), refract_(context) {}

    struct Inputs {
        const scene::Scene& scene;
        const views::Eye& eye;
        const Drawn& drawn;
        const graph::Texture& surface; ///< views.surface
        const graph::Texture& shown;   ///< the light on the height fields; gets that on the other objects
        bool coarse;                   ///< a first look: few points stand for a lamp
    };

    /// The scene's water, brought to its time before anything is drawn.
    views::Waters& waters() { return waters_; }
    /// What record() needs to know of the scene before.
    Status prepare(const Inputs& in);
    /// Adds all passes; nothing for a scene of height fields.
    Status record(graph::FrameGraph& graph, const Inputs& in);
    /// Whether the picture stands in through() and not in `shown`: where something refracts, and where an
    /// environment stands behind meshes.
    static bool replaces(const scene::Scene& scene, const Drawn& drawn);
    const graph::Texture& through() const { return through_; }
    /// What is seen, or from where, has changed.
    void forget() { layerCount_ = 0; }
    void clear();

private:
    Status recordSolids(graph::FrameGraph& graph, const Inputs& in,
                        const std::vector<views::PosedMesh>& solids,
                        const std::vector<views::PosedMesh>& glass, graph::TextureId surface,
                        graph::TextureId shown);
    Status recordThrough(graph::FrameGraph& graph, const Inputs& in,
                         const std::vector<views::PosedMesh>& solids,
                         const std::vector<views::PosedMesh>& glass, graph::TextureId surface,
                         graph::TextureId shown);
    Status recordBackground(graph::FrameGraph& graph, const Inputs& in, graph::TextureId surface,
                            graph::TextureId shown);
    static views::Eye closeEye(const Inputs& in);
    caustics::Settings causticSettings(const Inputs& in) const;
    Result<graph::TextureHandle> environmentMap(const scene::Scene& scene);

    gl::Context& context_;
    graph::TexturePool& pool_;
    views::ImageCache& images_;
    views::Waters waters_;
    caustics::Caustics caustics_;
    brdf::Brdf brdf_;
    refract::Refract refract_;
    std::optional<caustics::Plan> caustic_; ///< nothing where no light makes any
    graph::Texture through_;
    int layerCount_ = 0; ///< surfaces of refractive objects behind each other; 0: not known
};

} // namespace lucent::frame
