#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/brdf/Brdf.h"
#include "views/Surface.h"

#include <algorithm>
#include <iterator>

namespace lucent::brdf {

namespace {

using scene::Aov;

bool isMatt(const scene::Object& object) {
    const scene::Material& material = object.material;
    if (!object.visible || object.isField()) return false;
    return material.isRelief() || std::holds_alternative<scene::Matt>(material.kind) ||
           views::isPainted(object);
}

bool isShownMirror(const scene::Object& object) {
    return object.visible && !object.isField() && object.material.isMirror();
}
// From which rays leave for what the camera does not see.
bool looks(const scene::Object& object) {
    return !object.isField() && (object.material.isMirror() || object.material.isRefractive());
}
bool isAnything(const scene::Object&) { return true; }

template <class Is>
int countVisible(const scene::Scene& scene, Is is) {
    return int(std::count_if(scene.objects.begin(), scene.objects.end(),
                             [&](const scene::Object& object) { return object.visible && is(object); }));
}

views::Around aroundOf(const scene::Scene& scene) {
    const auto settings = scene.technique.find("brdf");
    return settings == scene.technique.end() ? Settings{}.surroundings
                                             : settings->second.as<Settings>().surroundings;
}

class BrdfGuest : public technique::Guest {
public:
    explicit BrdfGuest(const technique::Store& store) : context_(store.context), brdf_(store.context) {}

    bool shades(const scene::Scene& scene) const override {
        const Aov show = scene.view.show;
        return (show == Aov::Color || show == Aov::Irradiance) &&
               std::any_of(scene.objects.begin(), scene.objects.end(), isMatt);
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        const technique::Picture& picture = passes.picture;
        const auto isMattHere = [](const views::Drawable& one) { return isMatt(*one.object); };
        return brdf_.record(passes.graph, {.scene = picture.scene,
                                           .eye = picture.eye,
                                           .size = picture.size,
                                           .solids = filtered(passes.posed, isMattHere),
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
        const views::Drawables solids = opaque(visible(passes.posed));
        const views::Drawables mirrors = filtered(solids, &views::Drawable::isMirror);
        graph::TextureId solid;
        if (!mirrors.empty() && aroundOf(picture.scene) == views::Around::View) {
            solid =
                passes.graph.create("brdf.solid", {.size = picture.size, .format = graph::Format::RGBA32F});
            if (Status s = views::recordSolid(passes.graph, context_, picture.eye, solids, passes.surface,
                                              solid, picture.size);
                !s)
                return s;
        }
        return brdf_.recordMirrors(passes.graph, {.scene = picture.scene,
                                                  .eye = picture.eye,
                                                  .size = picture.size,
                                                  .mirrors = mirrors,
                                                  .surface = passes.surface,
                                                  .environment = picture.environment,
                                                  .surroundings = picture.surroundings,
                                                  .solid = solid,
                                                  .target = shown});
    }
    void lookAround(const technique::Picture& picture, views::Outlooks& asked) const override {
        const scene::Scene& scene = picture.scene;
        if (aroundOf(scene) != views::Around::Surroundings || countVisible(scene, isAnything) < 2) return;
        // A flat mirror has a picture of its own; what others see in it they follow from its middle.
        const bool isSeenByOthers = countVisible(scene, looks) > 1;
        for (int i = 0; i < int(scene.objects.size()); ++i) {
            const scene::Object& object = scene.objects[std::size_t(i)];
            if (!isShownMirror(object)) continue;
            const std::vector<views::FlatMirror> sides = views::flatSides(scene, i, picture.eye);
            asked.flat.insert(asked.flat.end(), sides.begin(), sides.end());
            if (isSeenByOthers || !views::isFlat(object) || sides.size() > std::size_t(views::kMostFlat))
                for (views::Outlook& outlook : views::outlooksFromMirror(scene, i))
                    asked.cubes.push_back(std::move(outlook));
        }
    }

private:
    gl::Context& context_;
    Brdf brdf_;
};

bool isShinyMesh(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
        if (!object.visible || object.isField() || !object.material.isRelief()) return false;
        const scene::Relief& relief = object.material.relief();
        return relief.specularity > 0 || relief.forwardScatter > 0;
    });
}
bool hasMirror(const scene::Scene& scene) { return countVisible(scene, isShownMirror) > 0; }
bool isAlone(const scene::Scene& scene) { return countVisible(scene, isAnything) < 2; }
bool shows(const scene::Scene& scene, views::Around around) {
    return hasMirror(scene) && !isAlone(scene) && aroundOf(scene) == around;
}
const technique::NotDrawn kLimits[] = {
    {"objects in mirrors",
     "technique.brdf.surroundings is environment",
     [](const scene::Scene& scene) { return shows(scene, views::Around::Environment); },
     {},
     "surroundings",
     "surroundings"},
    {"objects in mirrors that the camera does not see, that scatter light, or that are mirrors or clear",
     "technique.brdf.surroundings is view",
     [](const scene::Scene& scene) { return shows(scene, views::Around::View); },
     {},
     "surroundings",
     "surroundings"},
    {"mirrors by way of two mirrors", "the third one shows the environment",
     [](const scene::Scene& scene) {
         return shows(scene, views::Around::Surroundings) && countVisible(scene, isShownMirror) > 1;
     }},
    {"what is hidden from the middle of a curved mirror", "its surroundings are drawn from there",
     [](const scene::Scene& scene) {
         const auto isCurved = [](const scene::Object& object) {
             return isShownMirror(object) && !views::isFlat(object);
         };
         return shows(scene, views::Around::Surroundings) && countVisible(scene, isCurved) > 0;
     }},
    {"highlight and forward scattering of a relief material on other shapes than height fields",
     "without heights of its own a surface is drawn as the model's matt part", isShinyMesh},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "brdf",
    .need = Brdf::need,
    .shades = Brdf::shades,
    .limits = kLimits,
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<BrdfGuest>(store);
    },
};

} // namespace lucent::brdf
