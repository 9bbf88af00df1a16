#pragma once
/// Brushes in a person's hands: what they are set to, where they touch, and what the strokes leave on the
/// scene.

#include "base/Param.h"
#include "scene/Atlas.h"
#include "scene/Canvas.h"
#include "scene/Scene.h"
#include "viewer/Interaction.h"
#include "viewer/Panel.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lucent::viewer {

/// What an object looks like where nobody has painted yet, once its first stroke is painted by hand.
enum class Unpainted : int { Kept, Opaque };

/// The brush in hand. Part of the view, not of the scene: no undo step, not in a scene file. It begins with a
/// colour, so that the first stroke is seen on any material.
struct PaintSettings {
    scene::Brush brush{.map = scene::PaintMap::Glow};
    scene::PaintLayer layer = scene::PaintLayer::None; ///< shown in place of light
    float translucency = 1, blur = 2;                  ///< values of the brushes that take a number
    vec3 color{1, 0.3f, 0.15f};                        ///< of the others,
    float brightness = 1;                              ///< times this
    Unpainted unpainted = Unpainted::Kept;
};
/// The brush that a person begins with: an eighth as wide as the first object that can be painted.
PaintSettings brushFor(const scene::Scene& scene);

/// "paint.brush", "paint.radius" and so on; the values of other brushes are not shown. Shown while a person
/// paints.
///
/// @param defaults  to which reset goes back; outlives what is bound
std::vector<BoundParam> bindPaint(PaintSettings& settings, const PaintSettings& defaults, bool shown);
/// The scene as it is drawn while a layer of paint is looked at.
void applyLayer(const PaintSettings& settings, bool shown, scene::Scene& scene);
/// The brush with the value that it aims at.
scene::Brush brushOf(const PaintSettings& settings);

/// What is done at once with a whole object: "paint.fill" with the brush, "paint.clearTranslucency" and so on
/// in the order of scene::PaintMap.
std::span<const Action> paintActions();

/// A stroke over all of an object.
scene::Stroke everywhere(const scene::Brush& brush);
/// The first stroke on an object whose rest becomes opaque: only what a brush makes translucent scatters.
scene::Stroke opaqueStart();

/// In front of an object's name: path of how many strokes are on it, among what was changed.
inline const std::string kStrokesOn = "strokes on ";

/// Objects that can be painted: their material scatters.
bool isPaintable(const scene::Object& object);

/// A place on a painted object, as its mesh is at rest.
struct PaintPlace {
    int object = 0;                 ///< in the scene
    vec3 place{0}, normal{0, 0, 1}; ///< object's space
    vec3 seenAt{0};                 ///< world, where it is now
};
/// Finds what pixels show while neither the camera nor the scene changes. What moves stands as it does at the
/// scene's time; waves are left out.
class Picking {
public:
    Picking(const scene::Scene& scene, const Lens& lens, vec2 size);
    /// Nothing where the pixel shows nothing that can be painted.
    std::optional<PaintPlace> at(vec2 pixel) const;

private:
    struct Target {
        int object;
        bool paintable;
        std::shared_ptr<const scene::Mesh> rest;
        std::vector<vec3> places; // world
    };
    struct Triangle {
        std::uint32_t target, first; // of its corners
    };
    void enter(const Target& target, std::uint32_t number);

    Lens lens_;
    glm::ivec2 tiles_;
    std::vector<Target> targets_;
    std::vector<std::vector<Triangle>> inTile_;
};

/// The canvases of a scene's objects.
class Painter {
public:
    /// Another scene: nothing of the old one is kept.
    void clear();

    /// Strokes that are done on an object since it was loaded, without one that is open.
    int count(const scene::Object& object) const;
    /// Makes what the first stroke on an object needs, piece by piece until `isOver`: a page is not kept.
    ///
    /// @return whether it is there
    bool prepare(const scene::Object& object, const std::function<bool()>& isOver);
    /// A stroke begins. @return Error where the object does not fit into an atlas
    ///
    /// @param unpainted  what is done with the rest of an object without paint
    Status begin(scene::Object& object, const scene::Brush& brush, Unpainted unpainted);
    void dab(scene::Object& object, const scene::Dab& dab);
    void end(scene::Object& object);
    /// Whole strokes.
    Status add(scene::Object& object, std::span<const scene::Stroke> strokes);
    /// Takes strokes back, or does them again, until so many are done.
    void go(scene::Object& object, int count);

private:
    struct Easel {
        std::shared_ptr<const scene::Painting> first; ///< what was there when it was loaded
        std::shared_ptr<const scene::Mesh> mesh;
        float scale; ///< of the object for which its radii are
        scene::Canvas canvas;
    };
    struct Preparing {
        std::pair<std::shared_ptr<const scene::Mesh>, int> source{}; ///< mesh and texels a side
        std::unique_ptr<scene::AtlasMaking> atlas{};
        std::unique_ptr<scene::PaintSurfaceMaking> surface{};
        bool isDone = false; ///< or cannot be done
    };
    Result<Easel*> easelOf(scene::Object& object);
    static scene::Brush asOfEasel(scene::Brush brush, const scene::Object& object, const Easel& easel);
    static void show(scene::Object& object, const Easel& easel);
    std::map<std::string, Easel> easels_;        // by the object's name,
    std::map<std::string, Preparing> preparing_; // as these
};

} // namespace lucent::viewer
