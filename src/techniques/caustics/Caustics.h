#pragma once
/// Light that refractive objects and mirrors throw onto opaque surfaces (image-space dissertation 2007, ch.
/// 5): rays of a light are traced through layered images of its own view, carried on to the receivers that it
/// sees, and add up in a caustic map, where the pixels of the camera look their irradiance up. Nothing is
/// precomputed.

#include "light/Samples.h"
#include "light/ShadowMap.h"
#include "views/Layers.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lucent::caustics {

enum class Intersect : int { Hybrid, FixedPoint, Newton, Secant };
enum class Deposit : int { Beam, Splat, Lines };
enum class PointMap : int { Cube, Paraboloids };
std::string_view nameOf(Intersect intersect);
std::string_view nameOf(Deposit deposit);

struct Settings {
    Intersect intersect = Intersect::Hybrid;
    Deposit deposit = Deposit::Beam;
    int grid = 128;                     ///< rays a side
    bool refine = true;                 ///< beams: rays through single pixels where no beam carries light
    int mapSize = 512;                  ///< texels a side of the caustic map, or of each of its faces
    PointMap pointMap = PointMap::Cube; ///< how the map lies about a lamp that shines all around
    int steps = 32;                     ///< looks at the receivers' image for a ray, at most
    int receiverLayers = 2;             ///< receivers behind each other on which light is found
    int wavelengths = 3;                ///< of white light in glass that disperses
    int directions = 0;                 ///< of an environment; 0: its light passes glass straight on
    bool operator==(const Settings&) const = default;
};
/// Whether the light that glass, water and mirrors throw of a scene's environment is drawn.
bool carriesEnvironment(const scene::Scene& scene);

struct Inputs {
    const scene::Scene& scene;
    const views::Eye& eye;     ///< the camera's
    views::Drawables glass;    ///< refractive objects, hidden or not
    views::Drawables solids;   ///< opaque objects and mirrors, hidden or not
    graph::TextureId surface;  ///< views.surface; none: nothing is looked up
    ivec2 size;                ///< of the camera's picture
    int samples = 1;           ///< of each of its pixels, of which this is one
    graph::TextureId solid{};  ///< record() makes it, where there are height fields
    graph::TextureId places{}; ///< views::LitView::places
    float extent = 0;          ///< and extent
};

/// What is drawn for each light sample; made once for as long as lights and objects stay where they are.
struct Plan {
    struct View {
        views::Eye eye;
        int layers = 0; ///< surfaces of refractive objects, or of mirrors, behind each other; 0: not drawn
        int border = 0; ///< pixels at each side that belong to the light's next view
    };
    /// Water under a lamp that is high above it: its light is followed from the surface on.
    struct Water {
        views::ShadowViews over; ///< on what may hide the lamp; none: nothing can
    };
    struct Light {
        views::LampPoint lamp;
        Settings settings{};          ///< coarser where the size of the sample blurs what is finer
        int viewSize = 0;             ///< pixels a side of the views of what bends light
        float within = 0;             ///< m that light goes through that, about
        std::optional<Water> water{}; ///< instead of `glass`, where that is all that refracts
        std::vector<View> glass{};    ///< that show what refracts
        std::vector<View> mirrors{};  ///< that show what mirrors
        views::ShadowViews receivers; ///< that show what receives
        views::ShadowViews
            halves{};           ///< paraboloids in which the caustic map lies; none: it lies in `receivers`
        bool hasBehind = false; ///< behind what receives light lies more that does
    };
    std::vector<Light> lights;
    std::vector<views::LampPoint> samples{}; ///< of all lights
    std::size_t planned = 0;                 ///< of these: whose views are chosen
};

/// What became of light that met something refractive or mirroring, W of each colour. Every entry is summed
/// on its own; the first is the sum of the others but for what the caustic map rounds.
struct Energy {
    dvec3 incident{0};
    dvec3 received{0};  ///< in the caustic maps
    dvec3 absorbed{0};  ///< by media, by objects that let only a share in, by mirrors
    dvec3 reflected{0}; ///< at interfaces, and not followed
    dvec3 missed{0};    ///< met no receiver that the light's view shows
    dvec3 lost{0};      ///< given up inside
    dvec3 astray{0};    ///< of `received`: laid down where no surface is, two texels or more beside one
    double looks = 0;   ///< at the receivers' image, mean over the rays that left glass
};

/// What one point of a light leaves on what it sees.
struct Map {
    graph::TextureId flux;   ///< 1: what the light leaves on a texel undisturbed, in its brightest colour.
                             ///< Above what lies on the receivers that it sees: on those behind, if any
    graph::TextureId depths; ///< R32F: of the receivers that it sees; 1e30 where there is none
    ivec2 size{0};           ///< of the latter
    graph::TextureId behind; ///< R32F: of the receivers behind those; none where there are none
};

/// What record() carried, for as long as its graph is recorded.
struct Carried {
    graph::TextureId irradiance; ///< RGBA32F, W/m² on each pixel of the picture; none where there is none
    std::vector<Map> maps{};     ///< of the lights; empty where light is gathered in the picture alone
};

/// Not drawn: light that glass reflects outside, light by way of a mirror and then glass, what displaced
/// mirrors mirror twice, or mirrors that a light sample sees in no view of them or, past glass, in several;
/// what falls on receivers that the lamp sees past two or more others, or on sides turned away from it, and
/// what lamps inside of glass send out of it.
class Caustics {
public:
    static const ParamTable& params();
    /// Whether something bends or mirrors light and something else receives it.
    static bool bends(const scene::Scene& scene) { return thrown(scene).has_value(); }
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Caustics(gl::Context& context, views::PictureOf pictureOf = {})
        : context_(context), pictureOf_(std::move(pictureOf)) {}

    /// Around what receives light of all that may.
    ///
    /// @param eye  the camera's: what it does not show receives nothing; null: it shows all
    static views::Bounds receiving(const views::Eye* eye, const views::Drawables& drawables,
                                   const Settings& settings);

    /// Chooses the views of each light sample and counts their layers.
    ///
    /// @param plan       empty: begins; else goes on with the same arguments
    /// @param readings   not all there: the plan is not whole yet
    /// @param receiving  receiving()
    /// @param drawables  all that bends light or receives it
    /// @param isPreview  asks nothing: a few layers, and nothing behind what each light sees
    /// @return  Error (Fault::Machine) for more than views::kMostGlass refractive objects or images larger
    ///          than the GPU's textures
    Status plan(Plan& plan, views::Readings& readings, graph::TexturePool& pool, const scene::Scene& scene,
                const views::Bounds& receiving, const views::Drawables& drawables, const Settings& settings,
                bool isPreview = false) const;

    /// Adds the passes that give each pixel of opaque objects and height fields the irradiance of caustics.
    ///
    /// @param lights  of a plan: whose light is carried
    /// @param known   maps of the first of them, which are looked up; others are made
    Result<Carried> record(graph::FrameGraph& graph, const Inputs& in, std::span<const Plan::Light> lights,
                           std::vector<Map> known = {}) const;

    /// Adds the passes that look the same light up in another view, which shows meshes.
    ///
    /// @param in    of record(), with that view's eye, surface and size
    /// @param maps  of record() with the same lights
    Result<graph::TextureId> lookUp(graph::FrameGraph& graph, const Inputs& in,
                                    std::span<const Plan::Light> lights, const std::vector<Map>& maps) const;

    /// Adds the passes of one light alone, up to its map. `in.surface` must be none.
    Result<Map> recordMap(graph::FrameGraph& graph, const Inputs& in, const Plan::Light& light) const;

    /// Runs the same passes and sums what they carry. Reads pictures back.
    Result<Energy> measure(graph::TexturePool& pool, const scene::Scene& scene, const views::Eye& eye,
                           const views::Drawables& drawables, const Plan& plan) const;

private:
    static std::optional<std::string> thrown(const scene::Scene& scene);
    Status checkLimits(const views::Drawables& glass, const views::Drawables& mirrors,
                       const Settings& settings) const;
    gl::Context& context_;
    views::PictureOf pictureOf_;
};

} // namespace lucent::caustics
