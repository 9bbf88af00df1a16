#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/brdf/Brdf.h"
#include "techniques/brdf/Reflector.h"
#include "views/Surface.h"

#include <algorithm>
#include <iterator>

namespace lucent::brdf {

namespace {

using scene::Aov;

// Matt or glossy: light samples light it.
bool isMatt(const scene::Object& object) {
    const scene::Material& material = object.material;
    if (!object.visible || object.isField()) return false;
    return material.isRelief() || material.isGlossy() || std::holds_alternative<scene::Matt>(material.kind) ||
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
bool isGlossy(const scene::Object& object) { return object.visible && object.material.isGlossy(); }
bool showsAround(const scene::Object& object) { return object.visible && showsObjects(object); }

template <class Is>
int countVisible(const scene::Scene& scene, Is is) {
    return int(std::count_if(scene.objects.begin(), scene.objects.end(),
                             [&](const scene::Object& object) { return object.visible && is(object); }));
}

Settings settingsOf(const scene::Scene& scene) {
    const auto settings = scene.technique.find("brdf");
    return settings == scene.technique.end() ? Settings{} : settings->second.as<Settings>();
}
views::Around aroundOf(const scene::Scene& scene) { return settingsOf(scene).surroundings; }

class BrdfGuest : public technique::Guest {
public:
    explicit BrdfGuest(const technique::Store& store)
        : context_(store.context), images_(store.images), brdf_(store.context) {}

    bool shades(const scene::Scene& scene) const override {
        const Aov show = scene.view.show;
        return (show == Aov::Color || show == Aov::Irradiance) &&
               std::any_of(scene.objects.begin(), scene.objects.end(), isMatt);
    }
    void viewChanged() override { brdf_.surfaceChanged(); }
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
                                           .placed = slice.placed,
                                           .occlusion = slice.occlusion,
                                           .flux = slice.flux,
                                           .sum = slice.sum,
                                           .target = slice.target,
                                           .show = picture.scene.view.show,
                                           .clears = slice.clears,
                                           .environment = picture.environment,
                                           .surroundings = picture.surroundings,
                                           .lobeDirections = settingsOf(picture.scene).lobeDirections,
                                           .table = [this](const auto& map) { return images_.image(map); }});
    }
    Status mirror(const technique::Passes& passes, graph::TextureId shown) override {
        const technique::Picture& picture = passes.picture;
        if (picture.scene.view.show != Aov::Color) return Done{};
        const views::Drawables solids = opaque(visible(passes.posed));
        const views::Drawables mirrors = filtered(solids, &views::Drawable::isMirror);
        graph::TextureId solid;
        const bool seesCamera = aroundOf(picture.scene) == views::Around::View ||
                                (picture.surroundings && picture.surroundings->hasCubes());
        if (!mirrors.empty() && seesCamera) {
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
    void lookAround(const technique::Picture& picture, views::Probes& asked) const override {
        const scene::Scene& scene = picture.scene;
        if (aroundOf(scene) != views::Around::Surroundings || countVisible(scene, isAnything) < 2) return;
        // A flat mirror has a picture of its own; what others see in it they follow from its middle.
        const bool isSeenByOthers = countVisible(scene, looks) > 1;
        for (int i = 0; i < int(scene.objects.size()); ++i) {
            const scene::Object& object = scene.objects[std::size_t(i)];
            if (showsAround(object)) addCubes(scene, i, asked);
            if (!isShownMirror(object)) continue;
            const std::vector<views::FlatMirror> sides = views::flatSides(scene, i, picture.eye);
            asked.flat.insert(asked.flat.end(), sides.begin(), sides.end());
            if (isSeenByOthers || !views::isFlat(object) || sides.size() > std::size_t(views::kMostFlat))
                addCubes(scene, i, asked);
        }
    }

private:
    static void addCubes(const scene::Scene& scene, int object, views::Probes& asked) {
        for (views::Probe& probe : views::probesFromMirror(scene, object))
            asked.cubes.push_back(std::move(probe));
    }
    gl::Context& context_;
    views::ImageCache& images_;
    Brdf brdf_;
};

bool isShinyMesh(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
        if (!object.visible || object.isField() || !object.material.isRelief()) return false;
        const scene::Relief& relief = object.material.relief();
        return relief.specularity > 0 || relief.forwardScatter > 0;
    });
}
bool hasMirror(const scene::Scene& scene) {
    return countVisible(scene, isShownMirror) + countVisible(scene, showsAround) > 0;
}
bool isAlone(const scene::Scene& scene) { return countVisible(scene, isAnything) < 2; }
bool shows(const scene::Scene& scene, views::Around around) {
    return hasMirror(scene) && !isAlone(scene) && aroundOf(scene) == around;
}
constexpr Group kFirst[] = {Group::Mode, Group::Material, Group::Light, Group::Environment, Group::View};
bool hasGloss(const scene::Scene& scene) { return countVisible(scene, isGlossy) > 0; }
constexpr double kDirections[] = {4, 8, 16, 32, 64};
constexpr technique::Knob kKnobs[] = {
    {.id = "lobeDirections",
     .coarse = 4,
     .steps = kDirections,
     .most = 64,
     .words = "directions of a lobe",
     .acts = [](const scene::Scene& scene) { return countVisible(scene, showsAround) > 0; }},
};
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
    {"what more than one object hides from the middle of a curved mirror",
     "its surroundings are drawn from there",
     [](const scene::Scene& scene) {
         const auto isCurved = [](const scene::Object& object) {
             return isShownMirror(object) && !views::isFlat(object);
         };
         return shows(scene, views::Around::Surroundings) && countVisible(scene, isCurved) > 0;
     }},
    {"objects in glossy surfaces",
     "technique.brdf.surroundings is view, which only mirrors know",
     [](const scene::Scene& scene) {
         return shows(scene, views::Around::View) && countVisible(scene, showsAround) > 0;
     },
     {},
     "surroundings",
     "surroundings"},
    {"objects in what rough surfaces mirror",
     "above a roughness of 0.5 they only stand in the way of the light",
     [](const scene::Scene& scene) {
         const auto isRough = [](const scene::Object& object) {
             return hasLobe(object.material) && !showsObjects(object);
         };
         return !isAlone(scene) && countVisible(scene, isRough) > 0;
     }},
    {"highlights of caustics", "their light comes from directions that are not known",
     [](const scene::Scene& scene) {
         const auto throws = [](const scene::Object& object) { return looks(object); };
         return countVisible(scene, isGlossy) > 0 &&
                std::any_of(scene.objects.begin(), scene.objects.end(), throws);
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
    .knobs = kKnobs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "brdf", .place = 4, .first = kFirst, .has = hasGloss},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<BrdfGuest>(store);
    },
};

} // namespace lucent::brdf
