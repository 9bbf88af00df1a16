#include "technique/Technique.h"

#include "scene/Mesh.h"
#include "technique/Guest.h"
#include "techniques/displacement/Counting.h"

#include <algorithm>

namespace lucent::displacement {

namespace {

using scene::Aov;

bool isShown(const scene::Object& object) { return object.visible && object.isDisplaced(); }

std::optional<std::string> need(const scene::Scene& scene) {
    const auto found = std::find_if(scene.objects.begin(), scene.objects.end(), isShown);
    if (found == scene.objects.end()) return std::nullopt;
    return "heights displace object \"" + found->name + "\"";
}

// Views draw the surfaces themselves; what is left are pictures of how they do.
class DisplacementGuest : public technique::Guest {
public:
    explicit DisplacementGuest(const technique::Store& store) : context_(store.context) {}

    bool shades(const scene::Scene& scene) const override {
        return scene.view.show == Aov::Iterations &&
               std::any_of(scene.objects.begin(), scene.objects.end(), isShown);
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        return recordIterations(passes, context_, slice.target, slice.clears);
    }
    bool replaces(const technique::Picture& picture) const override {
        return picture.scene.view.show == Aov::Misses && need(picture.scene);
    }
    Status through(const technique::Passes& passes, graph::TextureId, graph::TextureId target) override {
        return recordMisses(passes, context_, target);
    }

private:
    gl::Context& context_;
};

bool hasHoles(const scene::Object& object) {
    const scene::Textures* textures = isShown(object) ? texturesOf(object) : nullptr;
    return textures && textures->hasHoles();
}

bool misses(const scene::Object& object) {
    return isShown(object) && object.displacement->method != scene::DisplacementMethod::Quadtree;
}

template <bool (*is)(const scene::Object&)>
bool any(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), is);
}

const technique::NotDrawn kLimits[] = {
    {"holes that textures cut into displaced meshes", "rays look for heights alone", any<hasHoles>},
    {"heights that are thinner than a search step",
     "displacement.method is not quadtree, the one that misses none", any<misses>},
};

constexpr Aov kAovs[] = {Aov::Misses};
constexpr Group kFirst[] = {Group::Mode, Group::Displacement, Group::Light, Group::Material, Group::View};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "displacement",
    .need = need,
    .aovs = kAovs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "displacement", .place = 5, .first = kFirst, .leads = any<isShown>},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<DisplacementGuest>(store);
    },
};

} // namespace lucent::displacement
