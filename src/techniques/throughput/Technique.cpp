#include "technique/Technique.h"

#include "technique/Guest.h"
#include "techniques/throughput/BakeFile.h"
#include "techniques/throughput/Throughput.h"

#include <algorithm>

namespace lucent::throughput {

namespace {

using graph::TextureId;
using scene::Aov;

const Settings& settingsOf(const scene::Scene& scene) {
    return scene.technique.at("throughput").as<Settings>();
}

class ThroughputGuest : public technique::Guest {
public:
    explicit ThroughputGuest(const technique::Store& store) : throughput_(store.context) {}

    Status prepare(const technique::Picture& picture) override {
        return throughput_.prepare(baked(picture.drawables), settingsOf(picture.scene));
    }
    bool shades(const scene::Scene& scene) const override { return need(scene) && showsLight(scene); }
    bool keepsLight(const scene::Scene& scene) const override { return shades(scene); }
    views::Bounds lit(const technique::Picture& picture) const override {
        return boundsOfAll(filtered(
            picture.drawables, [](const views::Drawable& one) { return throughput::bakes(*one.object); }));
    }
    Status shade(const technique::Passes& passes, const technique::Slice& slice) override {
        if (slice.clears) views::recordNothing(passes.graph, "before what is baked", slice.target);
        return throughput_.light(passes.graph,
                                 {.eye = passes.picture.eye,
                                  .table = slice.table,
                                  .samples = slice.samples,
                                  .first = slice.first,
                                  .end = slice.end,
                                  .shadows = slice.occlusion.shadows,
                                  .irradiance = passes.picture.scene.view.show == Aov::Irradiance,
                                  .size = passes.picture.size,
                                  .surface = passes.surface,
                                  .occlusion = &slice.occlusion,
                                  .placed = slice.placed,
                                  .mirrors = passes.picture.scene.view.show == Aov::Color,
                                  .fluxOn = slice.fluxOn},
                                 baked(passes.posed), settingsOf(passes.picture.scene));
    }
    Status scatter(const technique::Passes& passes, TextureId shown) override {
        const technique::Picture& picture = passes.picture;
        if (!showsLight(picture.scene) || replaces(picture)) return Done{};
        return throughput_.record(passes.graph,
                                  {.scene = picture.scene,
                                   .eye = picture.eye,
                                   .size = picture.size,
                                   .surface = passes.surface,
                                   .target = shown,
                                   .environment = picture.environment},
                                  baked(passes.posed), settingsOf(picture.scene));
    }
    bool replaces(const technique::Picture& picture) const override {
        return picture.scene.view.show == Aov::Atlas && need(picture.scene);
    }
    Status through(const technique::Passes& passes, TextureId, TextureId target) override {
        throughput_.recordAtlases(passes.graph, passes.picture.size, target,
                                  settingsOf(passes.picture.scene));
        return Done{};
    }
    std::map<std::string, std::size_t> bytes() const override { return throughput_.bytes(); }
    void clear() override { throughput_.clear(); }

private:
    static bool showsLight(const scene::Scene& scene) {
        const Aov show = scene.view.show;
        return show == Aov::Color || show == Aov::Radiosity || show == Aov::Irradiance || show == Aov::Atlas;
    }
    static std::vector<views::DrawnMesh> baked(views::Drawables list) {
        return meshesOf(filtered(std::move(list),
                                 [](const views::Drawable& one) { return throughput::bakes(*one.object); }));
    }

    Throughput throughput_;
};

class BakingFile : public technique::Baking {
public:
    BakingFile(const scene::Object& object, const BakeOptions& options, int threads)
        : key_(keyOf(object, options, DipoleGeometry::Planar)),
          making_(makingOf(object, options, DipoleGeometry::Planar, threads)) {}
    std::optional<Result<std::vector<std::byte>>> advance(double ms) override {
        const std::optional<Result<Bake>> made = making_.advance(ms);
        if (!made) return std::nullopt;
        if (!*made) return Result<std::vector<std::byte>>(made->error());
        return encodeBake(key_, **made);
    }
    double share() const override { return making_.share(); }

private:
    BakeKey key_;
    BakeMaking making_;
};

std::unique_ptr<technique::Baking> bakeFile(const lucent::Settings& settings, const scene::Object& object,
                                            int threads) {
    return std::make_unique<BakingFile>(object, optionsOf(settings.as<Settings>()), threads);
}

std::string missing(const lucent::Settings& settings, const scene::Object& object) {
    const BakeOptions options = optionsOf(settings.as<Settings>());
    if (isBaked(object, options)) return "";
    return textOf(keyOf(object, options, DipoleGeometry::Planar));
}

Status take(const lucent::Settings& settings, std::span<const scene::Object* const> objects,
            std::span<const std::byte> file) {
    const BakeOptions options = optionsOf(settings.as<Settings>());
    const scene::Object& first = *objects.front();
    Result<Bake> made =
        decodeBake(file, "objects." + first.name, keyOf(first, options, DipoleGeometry::Planar));
    if (!made) return made.error();
    const auto shared = std::make_shared<const Bake>(std::move(*made));
    for (const scene::Object* object : objects)
        keepBake(*object, options, shared);
    return Done{};
}

void leaveOut(scene::Object& object) { object.material.translucent().precomputed = false; }

bool anyBaked(const scene::Scene& scene) { return need(scene).has_value(); }
bool asks(const scene::Object& object) {
    return object.material.isScattering() && object.material.translucent().precomputed;
}
constexpr Aov kAovs[] = {Aov::Radiosity, Aov::Atlas};
constexpr Group kFirst[] = {Group::Mode, Group::Subsurface, Group::Light, Group::View};
const technique::NotDrawn kLimits[] = {
    {"precomputed light of what moves or has paint where light enters",
     "its factors would change; it is drawn as if not precomputed",
     [](const scene::Scene& scene) {
         return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
             return asks(object) && !scene::isPrecomputed(object);
         });
     }},
    {"objects in what precomputed surfaces mirror", "they mirror lamps and the environment past everything",
     [](const scene::Scene& scene) {
         return anyBaked(scene) && scene.objects.size() > 1 && views::hasEnvironment(scene);
     }},
    {"layers and thickness of a precomputed material", "its factors are the dipole's of a half space",
     [](const scene::Scene& scene) {
         return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
             return bakes(object) && (!object.material.translucent().layers.empty() ||
                                      object.material.translucent().thickness > 0);
         });
     }},
    {"light that scatters once inside precomputed objects", "diffusion leaves it out (2002 paper, 3)",
     anyBaked},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "throughput",
    .need = need,
    .shades = bakes,
    .acts = [](const lucent::Settings& settings,
               std::string_view id) { return acts(settings.as<Settings>(), id); },
    .aovs = kAovs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "throughput", .place = 6, .first = kFirst, .leads = anyBaked},
    .baker =
        technique::Baker{
            .takes = bakes, .bake = bakeFile, .missing = missing, .take = take, .leaveOut = leaveOut},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<ThroughputGuest>(store);
    },
};

} // namespace lucent::throughput
