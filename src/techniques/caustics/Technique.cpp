#include "technique/Technique.h"

#include "light/FlatWater.h"
#include "technique/Guest.h"
#include "techniques/caustics/Caustics.h"
#include "techniques/caustics/MapView.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace lucent::caustics {

namespace {

using graph::TextureId;
using scene::Aov;

constexpr int kLeastAround = 8;                          // directions of an environment in reflection probes
constexpr std::size_t kMostKept = std::size_t(96) << 20; // bytes of maps

const Settings& settingsOf(const scene::Scene& scene) {
    return scene.technique.at("caustics").as<Settings>();
}

class CausticsGuest : public technique::Guest {
public:
    explicit CausticsGuest(const technique::Store& store)
        : store_(store), caustics_(store.context, [this](const views::LampPoint& lamp) {
              return store_.images.image(lamp.picture);
          }) {}

    Status prepare(const technique::Picture& picture) override {
        const views::Drawables drawables = changingLight(picture.scene, picture.drawables);
        Key key = keyOf(picture, drawables);
        if (key_ != key) {
            clear();
            key_ = std::move(key);
        }
        if (plan_) return Done{};
        const int missing = picture.readings.missing();
        if (Status s = caustics_.plan(planning_, picture.readings, store_.pool, picture.scene,
                                      key_->receiving, drawables, key_->settings, picture.isPreview);
            !s)
            return s;
        if (picture.readings.missing() == missing) plan_ = std::exchange(planning_, {});
        return Done{};
    }

    Result<TextureId> light(const technique::Passes& passes) override {
        carried_ = {};
        lights_ = {};
        if (!plan_) return TextureId{};
        const auto count = float(plan_->lights.size());
        const auto first = std::size_t(std::ceil(passes.share.x * count)),
                   end = std::size_t(std::ceil(passes.share.y * count));
        lights_ = std::span(plan_->lights).subspan(first, end - first);
        if (lights_.empty()) return TextureId{};
        std::vector<Map> known;
        for (std::size_t i = first; i < std::min(end, kept_.size()); ++i) {
            const std::optional<Map> there = kept_[i].in(passes.graph);
            if (!there) break;
            known.push_back(*there);
        }
        const std::size_t next = first + known.size();
        Result<Carried> carried =
            caustics_.record(passes.graph, inputs(passes, passes.surface), lights_, std::move(known));
        if (!carried) return carried.error();
        carried_ = std::move(*carried);
        if (next < end && next <= kept_.size()) keepMaps(passes.graph, first, next);
        return carried_.irradiance;
    }
    Result<TextureId> lightOn(const technique::Passes& passes, const views::LitView& view) override {
        const Inputs in = inputs(passes, view.surface);
        return caustics_.lookUp(passes.graph,
                                {.scene = in.scene,
                                 .eye = view.eye,
                                 .glass = in.glass,
                                 .solids = in.solids,
                                 .surface = view.surface,
                                 .size = view.size,
                                 .places = view.places,
                                 .extent = view.extent},
                                lights_, carried_.maps);
    }

    bool carriesEnvironment(const scene::Scene& scene) const override {
        return caustics::carriesEnvironment(scene);
    }
    void takeLight(technique::Guest& from, std::uint64_t scenery) override {
        auto& other = static_cast<CausticsGuest&>(from);
        if (!other.plan_) return;
        clear();
        key_ = std::exchange(other.key_, {});
        key_->scenery = scenery;
        plan_ = std::exchange(other.plan_, {});
        kept_ = std::exchange(other.kept_, {});
    }

    bool replaces(const technique::Picture& picture) const override {
        return picture.scene.view.show == Aov::CausticMap && !visible(picture.drawables).empty();
    }
    Status through(const technique::Passes& passes, TextureId, TextureId target) override {
        const technique::Picture& picture = passes.picture;
        const int number = picture.scene.view.layer;
        if (!plan_ || number > int(plan_->lights.size())) {
            views::recordNothing(passes.graph,
                                 "no lamp has that many samples that throw light by way of glass or mirrors",
                                 target);
            return Done{};
        }
        Result<Map> map =
            caustics_.recordMap(passes.graph, inputs(passes, {}), plan_->lights[std::size_t(number - 1)]);
        return map ? recordMapView(passes.graph, store_.context, *map, target, picture.size) : map.error();
    }

    Result<technique::Balance> balance(const technique::Picture& picture) override {
        if (!plan_) return technique::Balance{};
        Result<Energy> energy = caustics_.measure(store_.pool, picture.scene, picture.eye,
                                                  changingLight(picture.scene, picture.drawables), *plan_);
        if (!energy) return energy.error();
        return technique::Balance{{"incident", energy->incident}, {"received", energy->received},
                                  {"absorbed", energy->absorbed}, {"reflected", energy->reflected},
                                  {"missed", energy->missed},     {"lost", energy->lost}};
    }

    std::map<std::string, std::size_t> bytes() const override {
        return kept_.empty() ? std::map<std::string, std::size_t>{}
                             : std::map<std::string, std::size_t>{{"caustic maps", keptBytes()}};
    }
    void clear() override {
        plan_.reset();
        planning_ = {};
        key_.reset();
        giveMaps();
    }

private:
    // What a plan and its maps depend on.
    struct Key {
        std::uint64_t scenery;
        Settings settings;
        views::Bounds receiving;
        int lampSamples;
        bool isPreview;
        bool operator==(const Key&) const = default;
    };
    static Key keyOf(const technique::Picture& picture, const views::Drawables& drawables) {
        Settings settings = settingsOf(picture.scene);
        if (picture.allAround) // small pictures
            settings.directions =
                std::min(settings.directions, std::max(kLeastAround, settings.directions / 4));
        views::Eye eye = picture.eye;
        eye.shift = vec2(0); // the same for all samples of a pixel
        return {picture.scenery, settings,
                Caustics::receiving(picture.allAround ? nullptr : &eye, drawables, settings),
                views::samplingOf(picture.scene).lamp, picture.isPreview};
    }

    // A map that stays between pictures; its textures are there when its graph has run.
    struct KeptMap {
        std::vector<std::shared_ptr<graph::Texture>> textures; // flux, depths, and those behind if any
        ivec2 size;

        std::optional<Map> in(graph::FrameGraph& graph) const {
            std::vector<TextureId> ids;
            for (const auto& texture : textures) {
                if (!*texture) return std::nullopt;
                ids.push_back(graph.import(texture->handle(), texture->desc(), texture->label()));
            }
            return Map{ids[0], ids[1], size, ids.size() > 2 ? ids[2] : TextureId{}};
        }
    };
    // @param first  light of the first map that was carried
    // @param next   first light whose map was not kept, in order
    void keepMaps(graph::FrameGraph& graph, std::size_t first, std::size_t next) {
        giveMaps(next);
        std::size_t left = kMostKept - std::min(kMostKept, keptBytes());
        for (const Map& map :
             std::span(carried_.maps).subspan(std::min(next - first, carried_.maps.size()))) {
            std::size_t bytes = 0;
            for (const TextureId id : {map.flux, map.depths, map.behind})
                if (id) bytes += graph.descOf(id).bytes();
            if (bytes > left) return;
            left -= bytes;
            KeptMap& kept = kept_.emplace_back(KeptMap{{}, map.size});
            for (const TextureId id : {map.flux, map.depths, map.behind}) {
                if (!id) continue;
                kept.textures.push_back(std::make_shared<graph::Texture>());
                graph.handOver(id, kept.textures.back());
            }
        }
    }
    void giveMaps(std::size_t from = 0) {
        for (std::size_t i = from; i < kept_.size(); ++i)
            for (const auto& texture : kept_[i].textures)
                if (*texture) store_.pool.give(std::move(*texture));
        kept_.resize(std::min(from, kept_.size()));
    }
    std::size_t keptBytes() const {
        std::size_t sum = 0;
        for (const KeptMap& map : kept_)
            for (const auto& texture : map.textures)
                sum += texture->desc().bytes();
        return sum;
    }

    static Inputs inputs(const technique::Passes& passes, TextureId surface) {
        const scene::Scene& scene = passes.picture.scene;
        const bool isMean = scene.view.show == Aov::Color;
        return {.scene = scene,
                .eye = passes.picture.eye,
                .glass = refractive(changingLight(scene, passes.posed)),
                .solids = opaque(passes.posed),
                .surface = surface,
                .size = passes.picture.size,
                .samples = isMean ? views::samplingOf(scene).pixelSamples : 1};
    }

    technique::Store store_;
    Caustics caustics_;
    std::optional<Plan> plan_;
    Plan planning_;                       // until it is whole
    std::optional<Key> key_;              // of both
    std::vector<KeptMap> kept_;           // of the plan's first lights
    std::span<const Plan::Light> lights_; // that the graph carries which is recorded
    Carried carried_;                     // by it
};

constexpr Aov kAovs[] = {Aov::CausticMap};
constexpr Group kFirst[] = {Group::Mode, Group::Caustics, Group::Light, Group::View};
constexpr double kGrids[] = {32, 64, 128, 256, 512};
constexpr technique::Knob kKnobs[] = {
    {.id = "grid",
     .coarse = 64,
     .coarsest = 32,
     .steps = kGrids,
     .words = "rays a side",
     .tied = "mapSize",
     .factor = 4},
    {.id = "refine", .coarse = 0},
    {.id = "environmentDirections", .coarse = 0, .acts = carriesEnvironment},
};

bool throwsLight(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
        return object.material.isMirror() || std::holds_alternative<scene::Water>(object.shape);
    });
}
template <class Is>
bool any(const scene::Scene& scene, Is is) {
    return !scene.lights.empty() &&
           std::any_of(scene.objects.begin(), scene.objects.end(), [is](const scene::Object& object) {
               return !object.isField() && is(object.material);
           });
}
bool hasGlass(const scene::Scene& scene) {
    return any(scene, [](const scene::Material& material) { return material.isRefractive(); });
}
bool hasMirror(const scene::Scene& scene) {
    return any(scene, [](const scene::Material& material) { return material.isMirror(); });
}
bool hasDisplacedMirror(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
        return object.material.isMirror() && object.isDisplaced();
    });
}
bool scatters(const scene::Scene& scene) {
    return any(scene, [](const scene::Material& material) { return material.isScattering(); });
}
bool leavesEnvironment(const scene::Scene& scene) {
    return views::hasEnvironment(scene) && !carriesEnvironment(scene) && Caustics::bends(scene);
}
bool bendsBesideWater(const scene::Scene& scene) {
    const auto bending =
        std::count_if(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
            return !object.isField() && (object.material.isRefractive() || object.material.isMirror());
        });
    return bending > (views::flatWater(scene) ? 1 : 0);
}
const technique::NotDrawn kLimits[] = {
    {"caustics by reflection on glass and water", "their light is followed through, not back", hasGlass},
    {"caustics by way of a mirror and then glass, or of displaced mirrors twice",
     "light that a mirror sends goes on past them",
     [](const scene::Scene& scene) {
         return hasMirror(scene) && (hasGlass(scene) || hasDisplacedMirror(scene));
     }},
    {"caustics of the environment",
     "environmentDirections is 0: its light passes glass straight on, at most as much as falls beneath it is "
     "misplaced",
     [](const scene::Scene& scene) { return leavesEnvironment(scene) && bendsBesideWater(scene); },
     {},
     "environmentDirections",
     "32"},
    {"caustics of the environment by waves",
     "environmentDirections is 0: its light comes through the water as if that lay still",
     [](const scene::Scene& scene) { return leavesEnvironment(scene) && views::flatWater(scene); },
     {},
     "environmentDirections",
     "32"},
    {"caustics beyond blended meshes inside glass or behind it",
     "those inside weaken no light, and a beam ends where any of its rays meets one behind",
     [](const scene::Scene& scene) {
         return Caustics::need(scene) &&
                std::any_of(scene.objects.begin(), scene.objects.end(), [](const scene::Object& object) {
                    const scene::Textures* textures = scene::texturesOf(object);
                    return textures && textures->isBlended();
                });
     }},
    {"caustics on objects that scatter light",
     "deposit lines gathers light in the picture alone",
     [](const scene::Scene& scene) {
         return Caustics::need(scene) && scatters(scene) && settingsOf(scene).deposit == Deposit::Lines;
     },
     {},
     "deposit",
     "beam"},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "caustics",
    .need = Caustics::need,
    .aovs = kAovs,
    .knobs = kKnobs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "caustics", .place = 2, .first = kFirst, .leads = throwsLight},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<CausticsGuest>(store);
    },
};

} // namespace lucent::caustics
