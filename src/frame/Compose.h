#pragma once
/// Everything that is no height field: opaque objects and mirrors with the caustics on them, objects in which
/// light scatters, over the light on the fields, and all of it seen through refractive objects.

#include "frame/SurfaceKey.h"
#include "techniques/brdf/Brdf.h"
#include "techniques/caustics/Caustics.h"
#include "techniques/refract/Refract.h"
#include "techniques/subsurface/Subsurface.h"
#include "views/Surface.h"
#include "views/Water.h"

namespace lucent::frame {

/// The objects that a picture shows.
struct Drawn {
    std::vector<views::DrawnObject> fields;
    views::DrawnMeshes meshes;

    std::size_t count() const { return fields.size() + meshes.solid.size() + meshes.glass.size(); }
};
/// Every object that a picture needs, hidden ones too, as it stands.
struct Posed {
    std::vector<views::DrawnObject> fields;
    std::vector<views::PosedMesh> solid, glass;

    /// Those that the camera does not leave out.
    static std::vector<views::PosedMesh> visible(const std::vector<views::PosedMesh>& meshes);
};
/// Poses all meshes once for all passes of a graph.
Result<Posed> posedOf(graph::FrameGraph& graph, gl::Context& context, const scene::Scene& scene,
                      views::ImageCache& images, const views::Waters& waters);
Result<Drawn> drawnOf(const scene::Scene& scene, views::ImageCache& images, const views::Waters& waters);

class Compose {
public:
    Compose(gl::Context& context, graph::TexturePool& pool, views::ImageCache& images)
        : context_(context), pool_(pool), images_(images), waters_(context), caustics_(context),
          brdf_(context), subsurface_(context), refract_(context), layerCounter_(context.device()) {}

    struct Inputs {
        const scene::Scene& scene;
        const views::Eye& eye;
        const Drawn& drawn;
        const graph::Texture& surface; ///< views.surface
        const graph::Texture& shown;   ///< the light on matt objects and height fields; gets all else
        bool coarse;                   ///< a first look: few points stand for a lamp
    };

    /// The scene's water, brought to its time before anything is drawn.
    views::Waters& waters() { return waters_; }
    /// What record() needs to know of the scene before.
    Status prepare(const Inputs& in);
    /// Irradiance of caustics on each pixel of a surface image; none where no lamp throws any.
    Result<graph::TextureId> recordCaustics(graph::FrameGraph& graph, const Inputs& in, const Posed& posed,
                                            graph::TextureId surface);
    /// Adds all passes; nothing where !isNeeded().
    Status record(graph::FrameGraph& graph, const Inputs& in);
    /// Whether record() adds anything: all that is no height field, and caustics on those.
    static bool isNeeded(const scene::Scene& scene, const Drawn& drawn);
    /// Whether the picture stands in through() and not in `shown`: where something refracts, and where an
    /// environment stands behind meshes.
    static bool replaces(const scene::Scene& scene, const Drawn& drawn);
    const graph::Texture& through() const { return through_; }
    /// What became of the light that met glass and mirrors in the picture that was recorded last; nothing
    /// where no lamp makes any. Draws the maps again and reads them back.
    Result<std::optional<caustics::Energy>> energy(const Inputs& in);
    /// Whether answers are awaited that say if the picture has all surfaces of refractive objects: settle()
    /// after the next frames.
    bool unsettled() const { return unsure_ || layerCounter_.waits(); }
    /// Takes the answers that have come, and counts by reading a picture back where they do not: in a browser
    /// none comes before a frame is over.
    ///
    /// @return  whether record() is to run again
    Result<bool> settle(const Inputs& in);
    /// What is seen, or from where, has changed.
    void forget() { layerCount_ = 0; }
    /// What record() added did not run.
    void forgetRecorded() {
        layerCounter_.reset();
        triangles_.current = layers_.current = false;
    }
    void clear();

private:
    Status recordSolids(graph::FrameGraph& graph, const Inputs& in,
                        const std::vector<views::PosedMesh>& solids,
                        const std::vector<views::PosedMesh>& glass, graph::TextureId surface,
                        graph::TextureId shown);
    Result<graph::TextureId> recordMatt(graph::FrameGraph& graph, graph::TextureId shown, ivec2 size);
    Status recordThrough(graph::FrameGraph& graph, const Inputs& in,
                         const std::vector<views::PosedMesh>& solids,
                         const std::vector<views::PosedMesh>& glass, graph::TextureId surface,
                         graph::TextureId shown);
    static bool peels(const Inputs& in);
    Status countLayers(const Inputs& in);
    Result<std::vector<views::PosedMesh>> recordGlass(graph::FrameGraph& graph, const scene::Scene& scene,
                                                      const std::vector<views::DrawnMesh>& glass);
    Result<views::Layers> recordPeeled(graph::FrameGraph& graph, const Inputs& in,
                                       const std::vector<views::PosedMesh>& glass, graph::TextureId solid,
                                       int most, views::KeptLayers* kept);
    views::KeptLayers* keptLayers(const Inputs& in);
    Status checkVoxels(const Inputs& in, const views::Eye& eye, const refract::Settings& settings);
    Status recordBackground(graph::FrameGraph& graph, const Inputs& in, graph::TextureId surface,
                            graph::TextureId shown);
    Status recordInside(graph::FrameGraph& graph, const Inputs& in,
                        const std::vector<views::PosedMesh>& solids,
                        const std::vector<views::PosedMesh>& glass);
    static views::Eye closeEye(const Inputs& in);
    Status recordScattering(graph::FrameGraph& graph, const Inputs& in,
                            const std::vector<views::PosedMesh>& solids,
                            const std::vector<views::PosedMesh>& casters, graph::TextureId surface,
                            graph::TextureId matt, graph::TextureId shown);
    caustics::Settings causticSettings(const Inputs& in) const;
    subsurface::Settings scatteringSettings(const Inputs& in) const;
    Result<graph::TextureHandle> environmentMap(const scene::Scene& scene);

    gl::Context& context_;
    graph::TexturePool& pool_;
    views::ImageCache& images_;
    views::Waters waters_;
    caustics::Caustics caustics_;
    brdf::Brdf brdf_;
    subsurface::Subsurface subsurface_;
    refract::Refract refract_;
    std::optional<caustics::Plan> caustic_;      ///< nothing where no light makes any
    std::optional<subsurface::Plan> scattering_; ///< nothing where no light scatters
    graph::Texture through_;
    views::KeptTriangles triangles_;                  ///< of refractive objects,
    std::vector<views::ObjectKey> triangled_;         ///< as they stood
    std::uint64_t watersThen_ = 0;                    ///< Waters::changes()
    views::KeptLayers layers_;                        ///< of what the eye sees through,
    std::optional<SurfaceKey> layered_;               ///< as it was seen
    views::LayerCount layerCounter_;                  ///< of peeled ones
    std::vector<const views::MeshTextures*> counted_; ///< for which it knows
    bool unsure_ = false;                             ///< nothing was asked about the picture
    int unanswered_ = 0;                              ///< times that settle() found no answer
    int layerCount_ = 0;    ///< of slices: surfaces of refractive objects behind each other; 0: not known
    int voxelsChecked_ = 0; ///< with what checkVoxels() looked last; 0: it did not
};

} // namespace lucent::frame
