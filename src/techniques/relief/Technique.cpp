#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/relief/Relief.h"
#include "techniques/relief/Transfers.h"

#include <algorithm>
#include <limits>

namespace lucent::relief {

namespace {

using scene::Aov;

// A transfer may take this part of the wanted error on the texels it was tried on: between texels, on half
// floats and for a finite number of directions it errs a little more.
constexpr float kTransferShare = 0.8f;
// A transfer that keeps less is rare, and finding that out costs more than directions do: lucent bench
// environment.
constexpr float kTransferReach = 0.005f;

const Settings& settingsOf(const scene::Scene& scene) { return scene.technique.at("relief").as<Settings>(); }

// Light itself, which may be found in several ways, not how one of them finds it.
bool showsLight(const scene::Scene& scene) {
    return scene.view.show == Aov::Color || scene.view.show == Aov::Illumination;
}

// Only an eye that looks straight down on every field sees no side wall.
bool seesWalls(const scene::Scene& scene) {
    if (scene.camera.type == scene::Camera::Type::Perspective) return true;
    const vec3 forward = glm::normalize(scene.camera.target - scene.camera.eye);
    return std::any_of(scene.objects.begin(), scene.objects.end(), [&](const scene::Object& object) {
        const vec3 down = rotationFromDegrees(object.transform.rotate) * vec3(0, 0, -1);
        return object.visible && object.isField() && glm::length(forward - down) > 1e-6f;
    });
}

// A transfer holds what one field keeps of all directions, not what other objects do.
bool standsAlone(const scene::Scene& scene) {
    return scene.objects.size() == 1 && scene.objects.front().isField();
}

class ReliefGuest : public technique::Guest {
public:
    explicit ReliefGuest(const technique::Store& store)
        : pool_(store.pool), relief_(store.context), transfers_(std::make_shared<Transfers>(store.context)) {}

    // The environment, once for all pictures of a field.

    bool bakes(const scene::Scene& scene) const override {
        return settingsOf(scene).method == Method::Transfer && views::hasEnvironment(scene) &&
               showsLight(scene) && standsAlone(scene);
    }
    bool isBaked(const scene::Scene& scene) const override {
        return transfers_->ready(scene, settingsOf(scene));
    }
    // Walls have no texels.
    bool sumsBesideBake(const scene::Scene& scene) const override { return seesWalls(scene); }
    Result<bool> bake(const technique::Picture& picture, double milliseconds) override {
        const Settings& settings = settingsOf(picture.scene);
        const std::vector<views::DrawnField> fields = fieldsOf(visible(picture.drawables));
        const Result<bool> ready = transfers_->make(pool_, fields, settings, milliseconds);
        if (ready && *ready)
            transfers_->light(picture.scene, picture.eye, fields, settings,
                              kTransferShare * picture.scene.quality.maxError);
        return ready;
    }
    float bakedShare() const override { return transfers_->share(); }
    void setBake(scene::Scene& scene, bool baked) const override {
        auto& settings = *static_cast<Settings*>(scene.technique.at("relief").data());
        settings.method = baked ? Method::Transfer : Method::Hierarchy;
        if (baked) settings.terms = kMostTerms;
    }
    double directionsForBake(const scene::Scene& scene, double pixels) const override {
        if (scene.quality.maxError < kTransferReach) return std::numeric_limits<double>::infinity();
        double rays = 0;
        for (const scene::Object& object : scene.objects)
            if (object.visible && object.isField()) rays += transferRays(object.field().texels(), kMostTerms);
        return rays / pixels;
    }
    std::string_view bakeName() const override { return "transfer"; }
    void shareBake(const Guest& of) override { transfers_ = static_cast<const ReliefGuest&>(of).transfers_; }

    // Every light sample, through the solid.

    bool shades(const scene::Scene& scene) const override {
        return std::any_of(scene.objects.begin(), scene.objects.end(),
                           [](const scene::Object& object) { return object.visible && object.isField(); });
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        const technique::Picture& picture = passes.picture;
        const std::vector<views::DrawnField> fields = fieldsOf(visible(picture.drawables));
        std::vector<Transferred> transferred;
        if (slice.baked && slice.first == 0) {
            Result<std::vector<Transferred>> recorded = transfers_->record(passes.graph);
            if (!recorded) return recorded.error();
            transferred = std::move(*recorded);
        } else if (slice.baked) {
            transferred.resize(fields.size()); // later slices add light to walls only
        }
        return relief_.record(passes.graph,
                              {.eye = picture.eye,
                               .objects = fields,
                               .scene = picture.scene,
                               .lights = slice.samples,
                               .surface = passes.surface,
                               .sum = slice.sum,
                               .target = slice.target,
                               .lightTable = slice.table,
                               .first = slice.first,
                               .end = slice.end,
                               .placed = slice.placed,
                               .transferred = std::move(transferred),
                               .show = picture.scene.view.show,
                               .occlusion = slice.occlusion,
                               .flux = slice.flux,
                               .size = picture.size,
                               .clears = slice.clears},
                              settingsOf(picture.scene));
    }

    std::vector<std::string> leftOut(const technique::Picture& picture) const override {
        const std::vector<views::DrawnField> fields = fieldsOf(visible(picture.drawables));
        if (fields.empty() || std::any_of(fields.begin(), fields.end(), [](const views::DrawnField& one) {
                return one.alpha != graph::TextureHandle::None;
            }))
            return {};
        return {"alpha: no object has an alpha image"};
    }
    std::map<std::string, std::size_t> bytes() const override {
        if (transfers_->bytes() == 0) return {};
        return {{"relief.coefficients, the transfers of all objects", transfers_->bytes()}};
    }
    void clear() override { transfers_->clear(); }

private:
    graph::TexturePool& pool_;
    Relief relief_;
    std::shared_ptr<Transfers> transfers_;
};

constexpr Aov kAovs[] = {Aov::Illumination, Aov::Visibility, Aov::Iterations};
constexpr Group kFirst[] = {Group::Mode};

bool hasMeshes(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const scene::Object& object) { return !object.isField(); });
}
const technique::NotDrawn kLimits[] = {
    {"light from one surface to another", "surfaces are lit by lamps and the environment only",
     [](const scene::Scene& scene) { return Relief::need(scene) && hasMeshes(scene); }},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "relief",
    .need = Relief::need,
    .shades = [](const scene::Object& object) { return object.isField(); },
    .aovs = kAovs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "relief", .place = 0, .first = kFirst},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<ReliefGuest>(store);
    },
};

} // namespace lucent::relief
