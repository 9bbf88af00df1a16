#pragma once
/// What a technique does while pictures are made. The frame calls guests in the order of their list, phase by
/// phase, and knows none of them.

#include "light/Occlusion.h"
#include "light/Samples.h"
#include "views/Drawable.h"
#include "views/FieldTextures.h"
#include "views/Readings.h"
#include "views/Surroundings.h"

#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lucent::technique {

/// What all guests of a renderer share; it outlives them.
struct Store {
    gl::Context& context;
    graph::TexturePool& pool;
    views::ImageCache& images;
};

/// One picture, as far as it is the same for all its passes.
struct Picture {
    const scene::Scene& scene; ///< with the settings that this picture is made with
    const views::Waters& waters;
    const views::Eye& eye;             ///< the camera's
    ivec2 size;                        ///< pixels
    const views::Drawables& drawables; ///< all objects, those too that are hidden from the camera
    views::Readings& readings;         ///< for Guest::prepare()
    graph::TextureHandle environment;  ///< lat-long map; None without one, or where it is switched off
    const views::Surroundings* surroundings = nullptr; ///< what Guest::lookAround() asked for; null: nothing
    std::uint64_t scenery = 0; ///< another number where anything but the camera and settings is as it was not
    bool allAround = false;    ///< what is fitted to what the camera sees is fitted to all: pictures in other
                               ///< directions follow
    bool isPreview = false;    ///< its knobs are turned down, and a whole picture follows
};

/// The same while a graph of passes is recorded.
struct Passes {
    const Picture& picture;
    graph::FrameGraph& graph;
    const views::Drawables& posed; ///< all objects as they stand, hidden ones too
    graph::TextureId surface;      ///< views.surface: first hits of the camera's rays
    vec2 share{0, 1}; ///< of the light samples, those that this graph sums: from one part to another
};

/// Some of the light samples, to be added to what earlier slices summed.
struct Slice {
    const std::vector<views::LampPoint>& samples; ///< all of them
    graph::TextureId table;                       ///< views::sampleTable(samples)
    int first, end;                               ///< those of this slice
    int placed;                                   ///< samples [placed, ...) are the environment's
    views::Occlusion occlusion;                   ///< of this slice
    graph::TextureId
        flux; ///< W/m² that guests carried to each pixel with this slice (Guest::light()); or none
    /// The same in another view; null where nobody carries any.
    std::function<Result<graph::TextureId>(const views::LitView&)> fluxOn;
    graph::TextureId sum;    ///< of earlier slices; not read when first == 0
    graph::TextureId target; ///< the sum with this slice; RGBA32F
    bool baked;              ///< the environment's light on what a guest has baked comes from there
    bool clears;             ///< nobody has drawn into the target yet
};

/// Parts of a sum with their names, W of each colour, the whole first.
using Balance = std::vector<std::pair<std::string, dvec3>>;

class Guest {
public:
    virtual ~Guest() = default;

    // --- before the passes of a stage

    /// Asks for views from elsewhere, where rays leave what the camera shows.
    virtual void lookAround(const Picture&, views::Probes&) const {}

    /// Makes what record functions need: tables, counts, plans. Only where the scene needs the technique.
    /// Again for the same picture until Picture::readings are all there.
    virtual Status prepare(const Picture&) { return Done{}; }
    /// The camera or an object has moved, or another scene is drawn.
    virtual void viewChanged() {}

    /// Whether this picture's environment comes from what is worked out once for all pictures.
    virtual bool bakes(const scene::Scene&) const { return false; }
    /// Whether that is there already.
    virtual bool isBaked(const scene::Scene&) const { return false; }
    /// Whether directions of the environment are summed beside it.
    virtual bool sumsBesideBake(const scene::Scene&) const { return false; }
    /// Works on it for about so long. @return whether it is there
    virtual Result<bool> bake(const Picture&, double) { return true; }
    /// Finished part of that work, [0,1].
    virtual float bakedShare() const { return 1; }
    /// Sets a scene to that, or to the exact sum over light samples.
    virtual void setBake(scene::Scene&, bool) const {}
    /// How many directions of the environment, summed on so many pixels, cost as much.
    virtual double directionsForBake(const scene::Scene&, double /*pixels*/) const { return 0; }
    /// "transfer"
    virtual std::string_view bakeName() const { return ""; }
    /// Takes what the guest of the same technique in another renderer has worked out.
    virtual void shareBake(const Guest&) {}
    /// Takes the light that the guest of the same technique in another renderer, which is not needed any
    /// more, has carried and keeps, instead of its own.
    ///
    /// @param scenery  Picture::scenery here of what that one drew
    virtual void takeLight(Guest&, std::uint64_t /*scenery*/) {}

    /// Whether what it works out from the light samples serves all samples of a pixel, which then have the
    /// same ones.
    virtual bool keepsLight(const scene::Scene&) const { return false; }

    // --- phases

    /// Light: carries the light of Passes::share to what the camera sees by other ways than straight on.
    ///
    /// @return  RGBA32F, W/m² on each pixel of the surface; none where there is none
    virtual Result<graph::TextureId> light(const Passes&) { return graph::TextureId{}; }
    /// Whether that holds the environment's light too: what sends it on then stands in its way.
    virtual bool carriesEnvironment(const scene::Scene&) const { return false; }
    /// The same light in another view, in the graph in which light() was called.
    virtual Result<graph::TextureId> lightOn(const Passes&, const views::LitView&) {
        return graph::TextureId{};
    }
    /// Whether light samples reach anything that this technique shades in what a scene shows.
    virtual bool shades(const scene::Scene&) const { return false; }
    /// Box around what shade() lights beside the surfaces that the camera sees; empty: nothing.
    virtual views::Bounds lit(const Picture&) const { return {}; }
    /// Shade: adds a slice of the light samples to its pixels and leaves the others as they are.
    virtual Status shade(const Passes&, const Slice&) { return Done{}; }
    /// Scatter: draws, over the complete sum, what is not summed sample by sample.
    virtual Status scatter(const Passes&, graph::TextureId) { return Done{}; }
    /// Mirror: draws what mirrors show, over all that scatters light.
    virtual Status mirror(const Passes&, graph::TextureId) { return Done{}; }
    /// Through: whether the picture is what this technique makes of the finished one, or shows a quantity of
    /// its own.
    virtual bool replaces(const Picture&) const { return false; }
    virtual Status through(const Passes&, graph::TextureId /*shown*/, graph::TextureId /*target*/) {
        return Done{};
    }
    /// Array of images whose first one holds the nearest surfaces of what through() has drawn over the opaque
    /// ones (shaders/views/layer_texel.glsl), in the same graph; none where it drew none.
    virtual graph::TextureId layersOf() const { return {}; }

    // --- after a picture

    /// Whether answers are awaited that say if the picture is whole: settle() after the next frames.
    virtual bool isUnsettled() const { return false; }
    /// Takes the answers that have come. @return whether the last two phases are to run again
    virtual Result<bool> settle(const Picture&) { return false; }
    /// What was recorded last did not run.
    virtual void forgetRecorded() {}
    /// What became of the light that it carried in the finished picture; empty where it carries none. Draws
    /// again and reads back.
    virtual Result<Balance> balance(const Picture&) { return Balance{}; }
    /// What was left out of this picture and why, one line each, for `lucent explain`.
    virtual std::vector<std::string> leftOut(const Picture&) const { return {}; }
    /// Textures that stay between pictures, by label, bytes.
    virtual std::map<std::string, std::size_t> bytes() const { return {}; }
    /// Gives back what is kept between pictures.
    virtual void clear() {}
};

} // namespace lucent::technique
