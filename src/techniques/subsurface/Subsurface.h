#pragma once
/// Light that enters objects, is scattered inside and leaves them around (image-space dissertation 2007, ch.
/// 6): points of the surface that a light sees are splatted, in the camera's view, onto all that they reach
/// of their object. Nothing is precomputed but tables of the material.

#include "diffusion/Profile.h"
#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "scene/Scene.h"
#include "views/ObjectKey.h"
#include "views/Readings.h"
#include "views/Surface.h"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::subsurface {

enum class Method : int { Multires, Splat, Diffusion, Lambert };
enum class DipoleGeometry : int { Planar, Offset };
enum class Splats : int { Bound, Paper };
enum class Exit : int { Whole, Paper };
enum class BlurEnergy : int { Kept, Paper };
using scene::PaintLayer;

struct Settings {
    Method method = Method::Multires;
    diffusion::Shape profile = diffusion::Shape::Dipole;
    DipoleGeometry dipoleGeometry = DipoleGeometry::Planar;
    float epsilon = 0.01f; ///< error of the integral over the surface
    Splats splats = Splats::Bound;
    int mostSplats = 256; ///< a side of a light's view
    Exit exit = Exit::Whole;
    BlurEnergy blurEnergy = BlurEnergy::Kept; ///< of light where M_d is painted
    int cells = 48;                           ///< along the longest side of a body, of diffusion
    bool temporal = false;                    ///< light is mixed with that of the picture before
    bool operator==(const Settings&) const = default;
};

/// Whether an object is drawn by this technique.
bool scatters(const scene::Object& object);

/// Whether a parameter changes anything beside these choices.
bool acts(const Settings& settings, std::string_view id);

struct Inputs {
    const scene::Scene& scene;
    const views::Eye& eye;
    std::vector<views::DrawnMesh> solids; ///< visible ones that scatter
    views::Drawables casters;             ///< all that stands in the light's way, hidden or not
    graph::TextureId surface;             ///< views.surface
    graph::TextureHandle environment;     ///< lat-long map of scene.environment; None without one
    graph::TextureId target;              ///< RGBA32F
    bool radiosity = false;               ///< shows what leaves, W/m², not radiance
    bool irradiance = false;              ///< shows what arrives, W/m²
    ivec2 size{0};
    graph::TextureId matt{}; ///< painted objects as if they were opaque (brdf), RGBA32F; not for radiosity
    views::PictureOf pictureOf{};
};

/// Some of the light samples, on their way to scattering objects.
struct Arriving {
    const scene::Scene& scene;
    const views::Eye& eye;
    ivec2 size{0};
    std::vector<views::DrawnMesh> solids;         ///< visible ones that scatter
    views::Drawables casters;                     ///< see views::Lit::drawables
    graph::TextureId surface;                     ///< views.surface
    const std::vector<views::LampPoint>& samples; ///< all of them
    graph::TextureId table;                       ///< views::sampleTable(samples)
    int first, end;                               ///< those that are added
    int placed;                                   ///< [placed, ...) are the environment's
    const views::Occlusion& occlusion;            ///< of those, shadows included
    graph::TextureId flux{};                      ///< technique::Slice::flux
    /// technique::Slice::fluxOn
    std::function<Result<graph::TextureId>(const views::LitView&)> fluxOn{};
    bool radiosity = false, irradiance = false; ///< as in Inputs
};

class Entering;
struct Profiled;
struct TemporalHistory;
class Volumes;

/// Profiles of the scene's materials as textures, and what is drawn for its environment. Made once for as
/// long as objects and settings stay.
class Plan {
public:
    struct State;
    Plan();
    Plan(Plan&&) noexcept;
    Plan& operator=(Plan&&) noexcept;
    ~Plan();

private:
    friend class Subsurface;
    std::unique_ptr<State> state_;
};

/// Radiance B F_t / (pi mean F_t), and what the surface mirrors of lamps and environment. B, what leaves, is
/// the sum over points of R_d(distance) times the flux that entered: of the light samples, with the
/// visibility that they have for all who shade, and of caustics, of which as much enters as of light that
/// falls straight in.
///
/// Painted objects (scene/Painting.h): light that enters at x_i leaves by t M_i M_d² R_d(M_d r) of x_i, and
/// what is seen at x_o is t M_o times that radiance and 1 - t of the matt one. Of points that cannot stand as
/// close as the largest M_d asks for, M_d counts as less.
///
/// Not drawn: light that scatters once (ch. 6 leaves it out), light that
/// scattering objects send each other, and from lamps inside of them; what stands in the way of the
/// environment that the surface mirrors.
class Subsurface {
public:
    static const ParamTable& params();
    /// Why the scene needs this technique; nothing when it does not.
    static std::optional<std::string> need(const scene::Scene& scene);

    explicit Subsurface(gl::Context& context) : context_(context) {}

    /// Makes the tables, and counts the layers of objects where an environment shines, but of those that have
    /// only moved or turned since.
    ///
    /// @param readings   not all there: the plan is of no use yet
    /// @param meshes     visible ones that scatter
    /// @param isPreview  it does not warn of what the settings cannot draw
    Result<Plan> plan(views::Readings& readings, graph::TexturePool& pool, const scene::Scene& scene,
                      const std::vector<views::DrawnMesh>& meshes, const Settings& settings,
                      bool isPreview = false);

    /// Adds the passes that sum a slice of the light samples; the first one begins anew.
    Status light(graph::FrameGraph& graph, const Arriving& in, const Plan& plan, const Settings& settings);
    /// What was recorded last did not run.
    void forgetRecorded();

    /// Adds the passes that draw, by the light that is summed, the pixels of scattering objects into the
    /// target and leave the others as they are; a: 1.
    ///
    /// @return  Error (Fault::Machine) for images larger than the GPU's textures
    Status record(graph::FrameGraph& graph, const Inputs& in, const Plan& plan,
                  const Settings& settings) const;
    /// Gives back what is kept between pictures.
    void clear();

private:
    // How many surfaces of an object lie behind each other along three axes, and what that depends on.
    struct Counted {
        views::ObjectKey key;
        std::array<ivec2, 3> sizes{};
        std::array<int, 3> layers{};
    };
    Result<std::array<int, 3>> countLayers(views::Readings& readings, graph::TexturePool& pool,
                                           const views::DrawnMesh& mesh, float time,
                                           const std::array<views::Eye, 3>& axes,
                                           const std::array<ivec2, 3>& sizes, bool turns);

    gl::Context& context_;
    std::shared_ptr<Entering> entering_;                    // made by light()
    std::map<int, Counted> counted_;                        // by the object's place in the scene
    std::vector<std::shared_ptr<const Profiled>> profiles_; // of the last plan
    std::shared_ptr<Volumes> volumes_;                      // null for methods that solve nothing
    std::shared_ptr<TemporalHistory> history_; // null where no picture keeps any of the one before
};

} // namespace lucent::subsurface
