#pragma once
/// What views draw: all that a scene holds, in one list. Each kind of thing draws itself; no view knows which
/// one it draws.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Scene.h"
#include "views/Eye.h"
#include "views/Textured.h"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lucent::views {

class ImageCache;
class Waters;
struct DrawnDisplaced;
struct DrawnField;
struct DrawnMesh;
struct KeptTriangles;

/// Kinds of views, by what they keep of surfaces. All but the first four show refractive objects only, and
/// number them; Textured is for objects with textures, OpticalDepth for those that are blended.
enum class ViewKind { Surface, Shadow, Textured, OpticalDepth, Peel, Count, VoxelBounds, VoxelSlice };

/// Draws something into a view of `size` pixels, which stands at the corner of draw.region, while a pass
/// runs.
///
/// @param draw  how, and what else is bound
using Drawing =
    std::function<void(const graph::Resources&, graph::Commands&, const Eye&, ivec2 size, graph::Draw draw)>;

/// Something that views draw. It refers to the scene and to textures that outlive the frame.
struct Drawable {
    using Ptr = std::shared_ptr<const Drawable>;
    Drawable(const scene::Object& of, int at) : object(&of), index(at) {}
    virtual ~Drawable() = default;

    const scene::Object* object;
    int index;                          ///< in the scene
    std::optional<Textured> textured{}; ///< what textures it shows

    bool isVisible() const { return object->visible; } ///< to the camera
    bool isRefractive() const { return object->material.isRefractive(); }
    bool isBlended() const { return mesh() && textured && textured->isBlended; } ///< in part
    bool isMirror() const { return object->material.isMirror(); }
    bool isTraced() const { return isRefractive() || isMirror(); } ///< rays go over its triangles
    Bounds bounds() const { return boundsOf(*object); }            ///< at any time

    /// For who shades one kind of things alone; null: it is another.
    virtual const DrawnField* field() const { return nullptr; }
    virtual const DrawnMesh* mesh() const { return nullptr; }
    virtual const DrawnDisplaced* displaced() const { return nullptr; }

    /// The same as it stands at `time` [s].
    ///
    /// @param refractive  what isTraced() and is to be put into images of triangles joins it
    virtual Result<Ptr> posed(graph::FrameGraph& graph, gl::Context& context, float time,
                              std::vector<DrawnMesh*>& traced) const = 0;
    /// Declares what a pass reads to draw it.
    ///
    /// @param number   by which shaders call it
    /// @param defines  switches of the view's shaders
    virtual Drawing drawing(gl::Context& context, graph::PassBuilder& pass, ViewKind kind, int number,
                            std::vector<std::string> defines) const = 0;
    /// Whether views show where rays leave it: what rays are cast at themselves shows only where they come
    /// in.
    virtual bool hasBack() const { return true; }
    /// Whether it draws only the nearest of its points on a ray: alone it needs no depth test.
    virtual bool drawsNearest() const { return false; }
    /// Draws a quantity of its pixels of a surface image (a switch of views/geometry.frag), where these do
    /// not hold depth and normal; the image is bound by who asks.
    virtual std::optional<graph::Draw> geometry(gl::Context&, const Eye&, const char* /*quantity*/) const {
        return std::nullopt;
    }
};

/// In the order of the scene.
using Drawables = std::vector<Drawable::Ptr>;

/// All objects of a scene, those that the camera does not see as well. They refer to it.
///
/// @param waters  the scene's, advanced to the time that is drawn; null: water lies still
Result<Drawables> drawablesOf(const scene::Scene& scene, ImageCache& images, const Waters* waters = nullptr);
/// One of them: what it needs on the GPU comes there, once.
Result<Drawable::Ptr> drawableOf(const scene::Scene& scene, int number, ImageCache& images,
                                 const Waters* waters = nullptr);

/// Those of which something is so.
template <class Is>
Drawables filtered(Drawables list, Is is) {
    std::erase_if(list, [&](const auto& one) { return !std::invoke(is, *one); });
    return list;
}
inline Drawables visible(Drawables list) { return filtered(std::move(list), &Drawable::isVisible); }
inline Drawables refractive(Drawables list) { return filtered(std::move(list), &Drawable::isRefractive); }
/// Mirrors among them.
inline Drawables opaque(Drawables list) {
    return filtered(std::move(list), std::not_fn(&Drawable::isRefractive));
}
/// Without refractive objects that light passes as if they were not there (scene::changesNoLight()).
Drawables changingLight(const scene::Scene& scene, Drawables list);

/// Those of one kind alone.
std::vector<DrawnField> fieldsOf(const Drawables& list);
std::vector<DrawnMesh> meshesOf(const Drawables& list);

/// The box around all of them in world space, at any time.
Bounds boundsOfAll(const Drawables& list);

/// Moves the vertices of what moves, for all views of the frame alike, and puts the triangles of all that is
/// traced into images. The graph must run before this is called for another time: rigs are on the GPU in
/// one pose.
///
/// @param kept  of recordTriangles()
Result<Drawables> recordPose(graph::FrameGraph& graph, gl::Context& context, const Drawables& list,
                             float time, KeptTriangles* kept = nullptr);

/// Declares what a pass reads to draw all of them. Views of refractive objects number these by their places
/// in the list, others by those in the scene.
std::vector<Drawing> drawingsOf(gl::Context& context, graph::PassBuilder& pass, const Drawables& list,
                                ViewKind kind, const std::vector<std::string>& defines = {});

/// Adds a pass that leaves an image empty.
void recordNothing(graph::FrameGraph& graph, const char* reason, graph::TextureId target);

} // namespace lucent::views
