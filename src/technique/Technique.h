#pragma once
/// What there is to know of a technique. The list of those that are built in is made by CMake
/// (LUCENT_TECHNIQUES): adding one is its folders and its name there.

#include "base/Param.h"
#include "scene/Painting.h"
#include "scene/Scene.h"
#include "truth/Model.h"

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::technique {

class Guest;
struct Store;

/// Work that is done once for an object, in slices of time.
class Baking {
public:
    virtual ~Baking() = default;
    /// Works on for about so long. @return the file once all is done, or why there is none
    virtual std::optional<Result<std::vector<std::byte>>> advance(double ms) = 0;
    virtual double share() const = 0; ///< of the work that is done, [0,1]
};

/// Work that a technique does once for an object, into files that scenes name (scene::Object::bake).
struct Baker {
    bool (*takes)(const scene::Object&); ///< whether it bakes such an object
    /// @param threads  0: as many as the machine has; the file does not depend on it
    std::unique_ptr<Baking> (*bake)(const Settings&, const scene::Object&, int threads);
    /// What is to be worked out before the object is drawn, as text that tells it from other work; empty
    /// where it is there.
    std::string (*missing)(const Settings&, const scene::Object&);
    /// Keeps what bake() made with objects that miss the same, and their copies. Error where it was made of
    /// something else.
    Status (*take)(const Settings&, std::span<const scene::Object* const> objects,
                   std::span<const std::byte> file);
    /// Makes the object one that is drawn without.
    void (*leaveOut)(scene::Object&);
};

/// A parameter that trades error for time: previews turn it down, and quality.maxError chooses its value.
struct Knob {
    std::string_view id;                ///< in the technique's table
    double coarse;                      ///< of a preview, unless the scene's own is cheaper
    double coarsest = coarse;           ///< of a preview with few pixels
    bool costsLess = false;             ///< greater values cost less
    std::span<const double> steps = {}; ///< cheapest first; empty: only previews turn it
    double most = 0;         ///< each step is held against finer ones up to this, and the last may be chosen;
                             ///< 0: each against the next, and the last is never chosen
    bool showsOnFew = false; ///< its error is the same on a few hundred pixels of the picture
    bool bends = false;      ///< refracted rays must keep their directions too
    std::string_view words = "";                     ///< "rays a side"
    std::string_view tied = "";                      ///< another parameter, which is
    double factor = 1;                               ///< so many times this one
    std::string_view placing = "";                   ///< another parameter, whose choices are tried each,
    std::span<const std::string_view> placings = {}; ///< and words for them; the last is the nearest
    bool (*acts)(const scene::Scene&) = nullptr;     ///< null: wherever the technique is needed
};

/// A knob and the table of parameters in which its own lies.
struct KnobOf {
    std::string_view table;
    const Knob* knob;
};

/// What a technique leaves out of a picture.
struct NotDrawn {
    std::string_view what; ///< "light that a mirror throws by way of another mirror"
    std::string_view why;
    bool (*applies)(const scene::Scene&);
    std::optional<scene::PaintMap> map = {};   ///< which a person painted in vain
    std::string_view setting = "", value = {}; ///< of the technique's own, by which it is drawn; "": none
};

/// What a person works on, as the page sorts it.
struct Mode {
    std::string_view name;
    int place;                    ///< among the others, from the left
    std::span<const Group> first; ///< groups of sliders that stand first
    /// Whether a scene begins with it, before all that stand left of it.
    bool (*leads)(const scene::Scene&) = nullptr;
    /// Whether a scene has it; null: wherever the technique is needed.
    bool (*has)(const scene::Scene&) = nullptr;
};

/// What can be said of a technique without a GPU: all that an exact solution asks.
struct Declared {
    std::string_view name;
    const ParamTable* (*params)();
    /// Parameters that belong to the model and not to how it is drawn,
    std::span<const std::string_view> model = {};
    /// and what they say to an exact solution; null: nothing.
    void (*describe)(const Settings&, truth::Model&) = nullptr;
};

struct Technique {
    std::string_view name;
    /// Why the scene needs it; nothing when it does not.
    std::optional<std::string> (*need)(const scene::Scene&);
    /// Whether it is what shows the surface of an object; null: of none.
    bool (*shades)(const scene::Object&) = nullptr;
    /// Whether a parameter changes anything beside the others; null: all do.
    bool (*acts)(const Settings&, std::string_view id) = nullptr;
    std::span<const scene::Aov> aovs = {}; ///< quantities that only it has
    std::span<const Knob> knobs = {};
    std::span<const NotDrawn> limits = {};
    std::optional<Mode> mode = {};
    std::optional<Baker> baker = {};
    std::unique_ptr<Guest> (*make)(const Store&);
};

/// All techniques that are built in, in the order in which they are called.
std::span<const Technique* const> all();
/// Of those among them that have parameters.
std::span<const Declared* const> declared();
/// By name; null where it is not built in.
const Technique* find(std::string_view name);
/// Why a scene needs a technique, by name; nothing when it does not.
std::optional<std::string> need(const scene::Scene& scene, std::string_view technique);

/// Tables of parameters of all techniques and of light samples, for the loader, `lucent list` and the
/// documentation.
std::span<const ParamTable* const> tables();
/// Gives a scene that is made in code every setting as it is by default, but one sample a pixel: what is
/// measured is what the middles of pixels show.
void addSettings(scene::Scene& scene);
/// Whether a parameter of a technique's table, or of light samples, changes anything in a scene.
bool acts(const scene::Scene& scene, std::string_view table, std::string_view id);
/// The model that a scene is drawn by.
truth::Model modelOf(const scene::Scene& scene);
/// The same scene with every setting as it is by default that does not belong to the model.
scene::Scene withDefaults(scene::Scene scene);
/// Knobs that change a picture of a scene: of its light samples, then of the techniques that it needs.
std::vector<KnobOf> knobs(const scene::Scene& scene);
/// Whether one of the techniques shows the surface of an object.
bool isShaded(const scene::Object& object, std::span<const Technique* const> techniques = all());
/// What a scene asks for and none of the techniques draws, one line each.
///
/// @param map  only what concerns this painted map
std::vector<std::string> notDrawn(const scene::Scene& scene, std::optional<scene::PaintMap> map = {},
                                  std::span<const Technique* const> techniques = all());
/// Gives a scene the settings by which all is drawn of what it asks for and some setting draws.
void drawAll(scene::Scene& scene);

} // namespace lucent::technique
