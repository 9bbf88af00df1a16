#include "technique/Technique.h"

#include "base/Log.h"
#include "technique/Guest.h"
#include "techniques/refract/LayerView.h"
#include "techniques/refract/Refract.h"
#include "views/Meshes.h"
#include "views/Surface.h"
#include "views/SurfaceKey.h"

#include <algorithm>

namespace lucent::refract {

namespace {

using graph::TextureId;
using scene::Aov;
using technique::Passes;
using technique::Picture;

const Settings& settingsOf(const scene::Scene& scene) { return scene.technique.at("refract").as<Settings>(); }

bool showsLayer(Aov aov) {
    return aov == Aov::LayerDepth || aov == Aov::LayerNormal || aov == Aov::LayerObject;
}

// Layers have depths of their own, evenly spaced, so that glass may stand right before the eye.
views::Eye closeEye(const Picture& picture) {
    views::Eye eye = views::makeEye(picture.scene, float(picture.size.x) / float(picture.size.y), 1e-6f,
                                    picture.eye.shift);
    eye.cut = picture.eye.cut;
    eye.threshold = picture.eye.threshold;
    return eye;
}

bool peels(const Picture& picture) {
    return showsLayer(picture.scene.view.show) || settingsOf(picture.scene).layers == LayerMethod::Peel;
}

bool isClear(const scene::Object& object) {
    return object.visible && !object.isField() && object.material.isRefractive();
}

bool showsOpaque(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const scene::Object& object) { return object.visible && !isClear(object); });
}

bool overlap(const views::Bounds& a, const views::Bounds& b) {
    return glm::all(glm::lessThanEqual(a.low, b.high)) && glm::all(glm::lessThanEqual(b.low, a.high));
}

// One for clear objects that touch or lie in each other: from their common middle, without what is clear, for
// rays meet that in the layers, and without what stands in the middle, which would hide all else.
std::vector<views::Probe> probesOf(const scene::Scene& scene) {
    std::vector<views::Probe> probes;
    std::vector<views::Bounds> boxes;
    std::vector<int> clear;
    for (int i = 0; i < int(scene.objects.size()); ++i) {
        const scene::Object& object = scene.objects[std::size_t(i)];
        if (!isClear(object)) continue;
        clear.push_back(i);
        if (scene::changesNoLight(scene, object)) continue; // what is behind it is seen as without it
        views::Bounds box = views::boundsOf(object);
        views::Probe probe = views::probeFrom(scene, i);
        for (std::size_t other = boxes.size(); other-- > 0;) {
            if (!overlap(box, boxes[other])) continue;
            box.add(boxes[other]);
            probe.name = probes[other].name;
            boxes.erase(boxes.begin() + std::ptrdiff_t(other));
            probes.erase(probes.begin() + std::ptrdiff_t(other));
        }
        probe.place = box.center();
        boxes.push_back(box);
        probes.push_back(std::move(probe));
    }
    for (views::Probe& probe : probes) {
        probe.hidden = clear;
        for (int i = 0; i < int(scene.objects.size()); ++i) {
            const scene::Object& object = scene.objects[std::size_t(i)];
            const views::Bounds bounds = views::boundsOf(object);
            if (object.visible && !isClear(object) && overlap(bounds, {probe.place, probe.place}))
                probe.hidden.push_back(i);
        }
    }
    return probes;
}

class RefractGuest : public technique::Guest {
public:
    explicit RefractGuest(const technique::Store& store)
        : store_(store), refract_(store.context), counter_(store.context.device()) {}

    // Counts only for the first picture of these objects; slices are counted for each view. Nobody waits for
    // a preview's: it has as many layers as its settings allow.
    Status prepare(const Picture& picture) override {
        isUnsure_ = false;
        if (seenGlass(picture).empty() || !replaces(picture)) {
            layers_ = {};
            return Done{};
        }
        return count(picture, picture.readings);
    }
    void viewChanged() override { count_ = 0; }

    bool replaces(const Picture& picture) const override {
        if (showsLayer(picture.scene.view.show)) return !visible(picture.drawables).empty();
        return !seenGlass(picture).empty();
    }
    void lookAround(const Picture& picture, views::Probes& asked) const override {
        const scene::Scene& scene = picture.scene;
        if (settingsOf(scene).surroundings != views::Around::Surroundings || !showsOpaque(scene)) return;
        const std::vector<views::Probe> cubes = probesOf(scene);
        asked.cubes.insert(asked.cubes.end(), cubes.begin(), cubes.end());
    }
    Status through(const Passes& passes, TextureId shown, TextureId target) override {
        const Picture& picture = passes.picture;
        drawn_ = {};
        if (showsLayer(picture.scene.view.show)) return recordLayer(passes, target);
        const Settings& settings = settingsOf(picture.scene);
        if (Status s = check(settings); !s) return s;
        const views::Eye eye = closeEye(picture);
        if (settings.layers == LayerMethod::Voxels)
            if (Status s = checkVoxels(picture, eye, settings); !s) return s;
        const views::Drawables seen = visible(passes.posed), solids = opaque(seen), glass = refractive(seen);
        TextureId solid;
        if (!solids.empty()) {
            solid =
                passes.graph.create("views.solid", {.size = picture.size, .format = graph::Format::RGBA32F});
            if (Status s = views::recordSolid(passes.graph, store_.context, eye, solids, passes.surface,
                                              solid, picture.size);
                !s)
                return s;
        }
        Result<views::Layers> layers =
            settings.layers == LayerMethod::Peel
                ? recordPeeled(passes, glass, solid, settings.maxLayers, keptLayers(picture))
                : views::recordLayers(passes.graph, store_.context, eye, glass, picture.size, 1, solid);
        if (!layers) return layers.error();
        drawn_ = layers->images;
        return refract_.record(
            passes.graph,
            {.eye = eye,
             .glass = glass,
             .layers = *layers,
             .opaque = solid ? shown : TextureId{},
             .solid = solid,
             .environment = picture.environment,
             .light = views::hasEnvironment(picture.scene) ? &*picture.scene.environment : nullptr,
             .target = target,
             .show = picture.scene.view.show,
             .count = count_,
             .surroundings = picture.surroundings},
            picture.size, settings);
    }

    TextureId layersOf() const override { return drawn_; }

    bool isUnsettled() const override { return isUnsure_ || counter_.waits(); }
    // In a browser no answer comes before a frame is over.
    Result<bool> settle(const Picture& picture) override {
        constexpr int kPatience = 8; // frames
        if (counter_.poll()) return true;
        if (!counter_.waits()) return isUnsure_;
        if (++unanswered_ < kPatience) return false;
        const int drawn = counter_.drawn();
        counter_.reset();
        views::Readings now; // waits, after so long
        if (Status s = count(picture, now); !s) return s.error();
        isUnsure_ = false;
        return counter_.drawn() > drawn;
    }
    void forgetRecorded() override {
        counter_.withdraw();
        layers_.current = false;
    }
    std::vector<std::string> leftOut(const Picture& picture) const override {
        if (!seenGlass(picture).empty()) return {};
        return {"refract: no object that is seen lets light through"};
    }
    void clear() override {
        voxelsChecked_.reset();
        counter_.reset();
        counted_.clear();
        layers_ = {};
        isUnsure_ = false;
        count_ = 0;
    }

private:
    static views::Drawables seenGlass(const Picture& picture) {
        return refractive(visible(picture.drawables));
    }
    Status count(const Picture& picture, views::Readings& readings) {
        const views::Drawables glass = seenGlass(picture);
        std::vector<const views::MeshTextures*> meshes;
        for (const views::DrawnMesh& mesh : meshesOf(glass))
            meshes.push_back(mesh.textures);
        if (meshes != counted_) counter_.reset();
        counted_ = std::move(meshes);
        counter_.poll();
        if (peels(picture) ? counter_.known() || picture.isPreview : count_ > 0) return Done{};
        Result<int> count =
            views::countLayers(readings, "refract", store_.pool, store_.context, closeEye(picture), glass,
                               picture.scene.view.time, picture.size);
        if (!count) return count.error();
        if (!readings.areThere()) return Done{};
        count_ = std::max(1, *count);
        counter_.start(count_);
        return Done{};
    }

    // As many layers as there were, and a question about what is behind them. Those that are kept are asked
    // about once.
    Result<views::Layers> recordPeeled(const Passes& passes, const views::Drawables& glass, TextureId solid,
                                       int most, views::KeptLayers* kept) {
        const int count = counter_.known() ? std::min(counter_.drawn(), most) : most;
        const bool stands = kept && kept->current && kept->count == count;
        const bool asks = !stands && counter_.known() && count == counter_.drawn();
        isUnsure_ = asks && counter_.waits();
        unanswered_ = 0;
        Result<views::Layers> layers = views::recordLayers(
            passes.graph, store_.context, closeEye(passes.picture), glass, passes.picture.size, count, solid,
            asks ? counter_.ask() : views::LayerQueries{}, kept);
        if (kept && isUnsure_) kept->current = false; // to be drawn and asked about again
        return layers;
    }

    // Layers stay while all surfaces do and the eye does: light and materials may change.
    views::KeptLayers* keptLayers(const Picture& picture) {
        views::SurfaceKey key =
            views::surfaceKey(picture.scene, picture.eye, picture.size, picture.waters.changes());
        if (layered_ != key) layers_.current = false;
        layered_ = std::move(key);
        return &layers_;
    }

    Status recordLayer(const Passes& passes, TextureId target) {
        const scene::View& view = passes.picture.scene.view;
        const views::Drawables glass = refractive(visible(passes.posed));
        if (glass.empty()) {
            views::recordNothing(passes.graph, "nothing that is seen refracts", target);
            return Done{};
        }
        Result<views::Layers> layers = recordPeeled(passes, glass, {}, views::kMostLayers, nullptr);
        if (!layers) return layers.error();
        return recordLayerView(passes.graph, store_.context, *layers, view.layer, view.show, target);
    }

    // Says when surfaces lie too close for the slices. It reads a picture back, so it looks again only when
    // the number of layers has changed, or the slices.
    Status checkVoxels(const Picture& picture, const views::Eye& eye, const Settings& settings) {
        const Checked key{count_, settings.slices, settings.bounds};
        if (voxelsChecked_ == key) return Done{};
        Result<views::VoxelCount> count =
            views::countVoxels(store_.pool, store_.context, eye, seenGlass(picture), picture.scene.view.time,
                               picture.size, voxelSettings(settings));
        if (!count) return count.error();
        if (count->sharing > 0)
            warnOnce("refract: refractive surfaces lie closer than a slice of depth: " +
                     std::to_string(count->sharing) + " of " + std::to_string(count->surfaces) +
                     " in all pixels share slices with others; rays take them as lying in one place");
        voxelsChecked_ = key;
        return Done{};
    }

    /// With what checkVoxels() looked last.
    struct Checked {
        int count;
        Slices slices;
        Extent bounds;
        bool operator==(const Checked&) const = default;
    };
    technique::Store store_;
    Refract refract_;
    views::KeptLayers layers_;                        ///< of what the eye sees through,
    std::optional<views::SurfaceKey> layered_;        ///< as it was seen
    TextureId drawn_;                                 ///< their images in the graph of the last through()
    views::LayerCount counter_;                       ///< of peeled ones
    std::vector<const views::MeshTextures*> counted_; ///< for which it knows
    bool isUnsure_ = false;                           ///< nothing was asked about the picture
    int unanswered_ = 0;                              ///< times that settle() found no answer
    int count_ = 0; ///< surfaces of refractive objects behind each other; 0: not known
    std::optional<Checked> voxelsChecked_;
};

constexpr Aov kAovs[] = {Aov::Direction,  Aov::Layers,      Aov::Lost,
                         Aov::LayerDepth, Aov::LayerNormal, Aov::LayerObject};
constexpr Group kFirst[] = {Group::Mode, Group::Refraction, Group::View, Group::Environment};
constexpr double kLayers[] = {2, 4, 8, 16, views::kMostLayers};
constexpr technique::Knob kKnobs[] = {
    {.id = "maxLayers",
     .coarse = 4,
     .coarsest = 2,
     .steps = kLayers,
     .most = views::kMostLayers,
     .bends = true,
     .words = "layers"},
};

bool refracts(const scene::Scene& scene) { return Refract::need(scene).has_value(); }
bool showsAround(const scene::Scene& scene, views::Around around) {
    return refracts(scene) && showsOpaque(scene) && settingsOf(scene).surroundings == around;
}
const technique::NotDrawn kLimits[] = {
    {"objects through glass",
     "technique.refract.surroundings is environment",
     [](const scene::Scene& scene) { return showsAround(scene, views::Around::Environment); },
     {},
     "surroundings",
     "surroundings"},
    {"through glass, objects that the camera does not see",
     "technique.refract.surroundings is view",
     [](const scene::Scene& scene) { return showsAround(scene, views::Around::View); },
     {},
     "surroundings",
     "surroundings"},
    {"through glass, what is hidden from the camera, and from the middle of the glass by more than one "
     "object",
     "its surroundings are drawn from there",
     [](const scene::Scene& scene) { return showsAround(scene, views::Around::Surroundings); }},
};

} // namespace

extern const technique::Technique kTechnique;
const technique::Technique kTechnique{
    .name = "refract",
    .need = Refract::need,
    .shades = [](const scene::Object& object) { return object.material.isRefractive(); },
    .acts = [](const lucent::Settings& settings,
               std::string_view id) { return acts(settings.as<Settings>(), id); },
    .aovs = kAovs,
    .knobs = kKnobs,
    .limits = kLimits,
    .mode = technique::Mode{.name = "refraction", .place = 1, .first = kFirst, .leads = refracts},
    .make = [](const technique::Store& store) -> std::unique_ptr<technique::Guest> {
        return std::make_unique<RefractGuest>(store);
    },
};

} // namespace lucent::refract
