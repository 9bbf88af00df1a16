#include "views/Objects.h"

#include <algorithm>
#include <iterator>

namespace lucent::views {

Result<Drawn> drawnOf(const scene::Scene& scene, ImageCache& images, const Waters& waters, bool hiddenToo) {
    Result<std::vector<DrawnObject>> fields = drawnObjects(scene, images, hiddenToo);
    if (!fields) return fields.error();
    Result<DrawnMeshes> meshes = drawnMeshes(scene, images, hiddenToo, &waters);
    if (!meshes) return meshes.error();
    return Drawn{std::move(*fields), std::move(*meshes)};
}

std::vector<PosedMesh> Posed::visible(const std::vector<PosedMesh>& meshes) {
    std::vector<PosedMesh> list;
    std::copy_if(meshes.begin(), meshes.end(), std::back_inserter(list),
                 [](const PosedMesh& mesh) { return mesh.drawn.object->visible; });
    return list;
}

Result<Posed> recordPosed(graph::FrameGraph& graph, gl::Context& context, const Drawn& all, float time,
                          KeptTriangles* kept) {
    Result<std::vector<PosedMesh>> solid = recordPose(graph, context, all.meshes.solid, time);
    if (!solid) return solid.error();
    Result<std::vector<PosedMesh>> glass = recordPose(graph, context, all.meshes.glass, time, kept);
    if (!glass) return glass.error();
    return Posed{all.fields, std::move(*solid), std::move(*glass)};
}

std::vector<DrawnMesh> changingLight(const scene::Scene& scene, std::vector<DrawnMesh> glass) {
    std::erase_if(glass, [&](const DrawnMesh& mesh) { return scene::changesNoLight(scene, *mesh.object); });
    return glass;
}

std::vector<PosedMesh> changingLight(const scene::Scene& scene, std::vector<PosedMesh> glass) {
    std::erase_if(glass,
                  [&](const PosedMesh& mesh) { return scene::changesNoLight(scene, *mesh.drawn.object); });
    return glass;
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
