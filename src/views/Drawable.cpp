#include "views/Drawable.h"

#include "views/Displaced.h"
#include "views/Fields.h"
#include "views/Meshes.h"

namespace lucent::views {

Result<Drawable::Ptr> drawableOf(const scene::Scene& scene, int number, ImageCache& images,
                                 const Waters* waters) {
    const scene::Object& object = scene.objects[std::size_t(number)];
    return object.isField()       ? DrawnField::create(object, number, images)
           : object.isDisplaced() ? DrawnDisplaced::create(object, number, images)
                                  : DrawnMesh::create(object, number, images, waters);
}

Result<Drawables> drawablesOf(const scene::Scene& scene, ImageCache& images, const Waters* waters) {
    Drawables list;
    for (int i = 0; i < int(scene.objects.size()); ++i) {
        Result<Drawable::Ptr> one = drawableOf(scene, i, images, waters);
        if (!one) return one.error();
        list.push_back(std::move(*one));
    }
    return list;
}

Drawables changingLight(const scene::Scene& scene, Drawables list) {
    return filtered(std::move(list),
                    [&](const Drawable& one) { return !scene::changesNoLight(scene, *one.object); });
}

std::vector<DrawnField> fieldsOf(const Drawables& list) {
    std::vector<DrawnField> fields;
    for (const auto& one : list)
        if (const DrawnField* field = one->field()) fields.push_back(*field);
    return fields;
}

std::vector<DrawnMesh> meshesOf(const Drawables& list) {
    std::vector<DrawnMesh> meshes;
    for (const auto& one : list)
        if (const DrawnMesh* mesh = one->mesh()) meshes.push_back(*mesh);
    return meshes;
}

Bounds boundsOfAll(const Drawables& list) {
    Bounds all;
    for (const auto& one : list)
        all.add(one->bounds());
    return all;
}

Result<Drawables> recordPose(graph::FrameGraph& graph, gl::Context& context, const Drawables& list,
                             float time, KeptTriangles* kept) {
    Drawables posed;
    std::vector<DrawnMesh*> refractive;
    for (const auto& one : list) {
        Result<Drawable::Ptr> standing = one->posed(graph, context, time, refractive);
        if (!standing) return standing.error();
        posed.push_back(std::move(*standing));
    }
    if (Status s = recordTriangles(graph, context, refractive, kept); !s) return s.error();
    return posed;
}

std::vector<Drawing> drawingsOf(gl::Context& context, graph::PassBuilder& pass, const Drawables& list,
                                ViewKind kind, const std::vector<std::string>& defines) {
    const bool inScene = kind <= ViewKind::OpticalDepth;
    std::vector<Drawing> drawings;
    for (const auto& one : list)
        drawings.push_back(
            one->drawing(context, pass, kind, inScene ? one->index : int(drawings.size()), defines));
    return drawings;
}

void recordNothing(graph::FrameGraph& graph, const char* reason, graph::TextureId target) {
    graph.addPass("views.nothing", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [](const graph::Resources&, graph::Commands&) {};
    });
}

} // namespace lucent::views
