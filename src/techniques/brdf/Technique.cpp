#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/brdf/Brdf.h"

#include <algorithm>
#include <iterator>

namespace lucent::brdf {

namespace {

using scene::Aov;

bool isMatt(const scene::Object& object) {
    const scene::Material& material = object.material;
    return object.visible && !object.isField() && !material.isRefractive() && !material.isMirror() &&
           (!material.isScattering() || views::isPainted(object));
}

class BrdfGuest : public technique::Guest {
public:
    explicit BrdfGuest(const technique::Store& store) : brdf_(store.context) {}

    bool shades(const scene::Scene& scene) const override {
        const Aov show = scene.view.show;
        return (show == Aov::Color || show == Aov::Irradiance) &&
               std::any_of(scene.objects.begin(), scene.objects.end(), isMatt);
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        const technique::Picture& picture = passes.picture;
        std::vector<views::PosedMesh> matt = views::Posed::visible(passes.posed.solid);
        std::erase_if(matt, [](const views::PosedMesh& mesh) { return !isMatt(*mesh.drawn.object); });
        return brdf_.record(passes.graph, {.scene = picture.scene,
                                           .eye = picture.eye,
                                           .size = picture.size,
                                           .solids = matt,
                                           .surface = passes.surface,
                                           .lightTable = slice.table,
                                           .first = slice.first,
                                           .end = slice.end,
                                           .occlusion = slice.occlusion,
                                           .flux = slice.flux,
                                           .sum = slice.sum,
                                           .target = slice.target,
                                           .show = picture.scene.view.show,
                                           .clears = slice.clears});
    }
    Status scatter(const technique::Passes& passes, graph::TextureId shown) override {
        const technique::Picture& picture = passes.picture;
        if (picture.scene.view.show != Aov::Color) return Done{};
        std::vector<views::PosedMesh> mirrors = views::Posed::visible(passes.posed.solid);
        std::erase_if(mirrors,
                      [](const views::PosedMesh& mesh) { return !mesh.drawn.object->material.isMirror(); });
        return brdf_.recordMirrors(passes.graph, {.scene = picture.scene,
                                                  .eye = picture.eye,
                                                  .size = picture.size,
                                                  .mirrors = mirrors,
                                                  .surface = passes.surface,
                                                  .environment = picture.environment,
                                                  .target = shown});
    }

private:
    Brdf brdf_;
};

bool hasMirror(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
        return object.visible && !object.isField() && object.material.isMirror();
    });
}
const technique::NotDrawn kLimits[] = {
    {"other objects in mirrors", "mirrors show the environment only",
     [](const scene::Scene& scene) { return hasMirror(scene) && scene.objects.size() > 1; }},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "brdf",
    .need = Brdf::need,
    .limits = kLimits,
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<BrdfGuest>(store);
    },
};

} // namespace lucent::brdf
