#include "techniques/caustics/Caustics.h"

#include "techniques/caustics/LightPasses.h"
#include "views/Glass.h"
#include "views/Surface.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucent::caustics {

namespace {

constexpr std::string_view kIntersects[] = {"hybrid", "fixed-point", "newton", "secant"};
constexpr std::string_view kDeposits[] = {"beam", "splat", "lines"};
constexpr std::string_view kPointMaps[] = {"cube", "paraboloids"};

} // namespace

std::string_view nameOf(Intersect intersect) { return kIntersects[std::size_t(intersect)]; }
std::string_view nameOf(Deposit deposit) { return kDeposits[std::size_t(deposit)]; }

const ParamTable& Caustics::params() {
    static const Param list[] = {
        declare(
            &Settings::intersect,
            {.id = "intersect",
             .label = "Intersection",
             .group = Group::Caustics,
             .doc =
                 "How the place is found where a ray intersects a receiver: within a bracket that secants or "
                 "halving shrink; by the dissertation's fixed point; by Newton's method; by secants.",
             .choices = kIntersects}),
        declare(&Settings::deposit,
                {.id = "deposit",
                 .label = "Deposit",
                 .group = Group::Caustics,
                 .doc = "What light leaves on receivers: the triangles between rays, with flux over area; "
                        "the dissertation's Gaussian points; or rays as lines that intersect what the "
                        "picture shows, "
                        "whose light is gathered there.",
                 .choices = kDeposits}),
        declare(&Settings::grid, {.id = "grid",
                                  .label = "Rays a side",
                                  .min = 2,
                                  .max = 1024,
                                  .low = 32,
                                  .high = 512,
                                  .logarithmic = true,
                                  .group = Group::Caustics,
                                  .doc = "Rays along a side of what a light sees of refractive objects and "
                                         "mirrors. More draw finer lines of light."}),
        declare(&Settings::refine,
                {.id = "refine",
                 .label = "Adaptive refinement",
                 .group = Group::Caustics,
                 .doc =
                     "Where neighbouring rays part, as at outlines, light is traced by single pixels of the "
                     "lamp's view rather than by cells of the grid of rays. Of beams, and of lamps without "
                     "size."}),
        declare(&Settings::mapSize, {.id = "mapSize",
                                     .label = "Caustic map",
                                     .unit = "texels",
                                     .min = 16,
                                     .max = 4096,
                                     .low = 128,
                                     .high = 2048,
                                     .logarithmic = true,
                                     .group = Group::Caustics,
                                     .doc = "Texels along a side of the image in which light adds up. More "
                                            "are sharper, and need more rays."}),
        declare(&Settings::pointMap,
                {.id = "pointMap",
                 .label = "Map of a point light",
                 .group = Group::Caustics,
                 .doc =
                     "How the image in which light adds up lies about a lamp with receivers all around: as "
                     "up to six faces of a cube; or as two paraboloids, coarser in a third of the memory.",
                 .choices = kPointMaps}),
        declare(&Settings::steps, {.id = "steps",
                                   .label = "Steps",
                                   .min = 1,
                                   .max = 256,
                                   .low = 1,
                                   .high = 64,
                                   .logarithmic = true,
                                   .group = Group::Caustics,
                                   .doc = "How often, at most, the receivers' image is looked up to find "
                                          "where a ray meets them. Too few put light beside its place."}),
        declare(&Settings::receiverLayers,
                {.id = "receiverLayers",
                 .label = "Receiver layers",
                 .min = 1,
                 .max = 2,
                 .group = Group::Caustics,
                 .doc =
                     "2: light that passes an edge of what the lamp sees first, as under a table, falls on "
                     "what lies behind. Of the hybrid intersection; where nothing lies behind, it costs "
                     "nothing."}),
        declare(&Settings::wavelengths,
                {.id = "wavelengths",
                 .label = "Wavelengths",
                 .min = 3,
                 .max = 64,
                 .low = 3,
                 .high = 32,
                 .group = Group::Caustics,
                 .doc = "Kinds of light that glass with dispersion bends differently: 3 stand for red, green "
                        "and blue, more for as many parts of the spectrum, whose colours then run into each "
                        "other as in a rainbow."}),
        declare(&Settings::directions,
                {.id = "environmentDirections",
                 .label = "Directions of the environment",
                 .min = 0,
                 .max = 1024,
                 .low = 0,
                 .high = 64,
                 .group = Group::Caustics,
                 .doc =
                     "How many directions, more of them where the map is bright, stand for the environment "
                     "whose light glass, water and mirrors throw, each blurred by how much of the map it "
                     "stands for; 0: it passes glass straight on, and water as if that lay still."}),
    };
    static const ParamTable table = tableOf<Settings>("caustics", list, "Caustics");
    return table;
}

bool carriesEnvironment(const scene::Scene& scene) {
    const auto settings = scene.technique.find("caustics");
    return views::hasEnvironment(scene) && settings != scene.technique.end() &&
           settings->second.as<Settings>().directions > 0;
}

std::optional<std::string> Caustics::need(const scene::Scene& scene) {
    return scene.lights.empty() && !carriesEnvironment(scene) ? std::nullopt : thrown(scene);
}

std::optional<std::string> Caustics::thrown(const scene::Scene& scene) {
    const auto find = [&](auto wanted) -> const scene::Object* {
        const auto found = std::find_if(scene.objects.begin(), scene.objects.end(),
                                        [&](const auto& one) { return wanted(one); });
        return found == scene.objects.end() ? nullptr : &*found;
    };
    const auto bendsLight = [](const scene::Object& one) {
        return !one.isField() && (one.material.isRefractive() || one.material.isMirror());
    };
    const scene::Object* bends = find(bendsLight);
    const scene::Object* receives = find([&](const scene::Object& one) { return !bendsLight(one); });
    if (!bends || !receives) return std::nullopt;
    return "object \"" + bends->name + "\" casts a caustic on \"" + receives->name + "\"";
}

Result<Carried> Caustics::record(graph::FrameGraph& graph, const Inputs& in,
                                 std::span<const Plan::Light> lights, std::vector<Map> known) const {
    Carried carried{.irradiance = {}, .maps = std::move(known)};
    const std::size_t made = carried.maps.size();
    Targets targets(graph);
    Inputs all = in;
    const bool hasFields = std::any_of(in.solids.begin(), in.solids.end(),
                                       [](const auto& one) { return one->field() != nullptr; });
    if (hasFields && !lights.empty()) {
        all.solid = graph.create("caustics.shown", {.size = in.size, .format = graph::Format::RGBA32F});
        if (Status s = views::recordSolid(graph, context_, in.eye, in.solids, in.surface, all.solid, in.size);
            !s)
            return s.error();
    }
    for (std::size_t i = 0; i < lights.size(); ++i) {
        LightPasses passes(graph, context_, targets, all, lights[i], pictureOf_);
        Status s =
            i < made ? passes.lookUp(carried.maps[i], carried.irradiance) : passes.record(carried.irradiance);
        if (!s) return s.error();
        if (i >= made && lights[i].settings.deposit != Deposit::Lines) carried.maps.push_back(passes.map());
    }
    return carried;
}

Result<graph::TextureId> Caustics::lookUp(graph::FrameGraph& graph, const Inputs& in,
                                          std::span<const Plan::Light> lights,
                                          const std::vector<Map>& maps) const {
    graph::TextureId sum;
    Targets targets(graph);
    for (std::size_t i = 0; i < maps.size(); ++i)
        if (Status s = LightPasses(graph, context_, targets, in, lights[i], pictureOf_).lookUp(maps[i], sum);
            !s)
            return s.error();
    return sum;
}

Result<Map> Caustics::recordMap(graph::FrameGraph& graph, const Inputs& in, const Plan::Light& light) const {
    graph::TextureId none;
    Targets targets(graph);
    LightPasses passes(graph, context_, targets, in, light, pictureOf_);
    if (Status s = passes.record(none); !s) return s.error();
    return passes.map();
}

namespace {

// Sums the textures of one measured light.
class Ledger {
public:
    Ledger(gl::Device& device, const Targets& targets) : device_(device), targets_(targets) {}

    dvec3 sum(std::string_view label) {
        dvec3 total(0);
        each(label, [&](const Image& image) {
            for (std::size_t i = 0; i < image.pixels.size(); i += 4)
                total += dvec3(image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]);
        });
        return total;
    }
    void each(std::string_view label, const std::function<void(const Image&)>& visit) {
        for (const graph::Texture& texture : targets_.kept())
            if (texture.label() == label) visit(device_.read(texture.handle()));
    }
    std::vector<Image> all(std::string_view label) {
        std::vector<Image> list;
        each(label, [&](const Image& image) { list.push_back(image); });
        return list;
    }

private:
    gl::Device& device_;
    const Targets& targets_;
};

} // namespace

Result<Energy> Caustics::measure(graph::TexturePool& pool, const scene::Scene& scene, const views::Eye& eye,
                                 const views::Drawables& drawables, const Plan& plan) const {
    Energy energy;
    double rays = 0;
    for (const Plan::Light& light : plan.lights) {
        graph::FrameGraph graph;
        Result<views::Drawables> posed = views::recordPose(graph, context_, drawables, scene.view.time);
        if (!posed) return posed.error();
        const Inputs in{scene, eye, refractive(*posed), opaque(*posed), {}, {}};
        Targets targets(graph, &context_.device());
        graph::TextureId none;
        LightPasses passes(graph, context_, targets, in, light, pictureOf_);
        if (Status s = passes.record(none); !s) return s.error();
        if (Status s = graph.compile(); !s) return s.error();
        graph.execute(pool);
        Ledger ledger(context_.device(), targets);
        energy.incident += ledger.sum("caustics.incident");
        energy.absorbed += ledger.sum("caustics.absorbed");
        energy.reflected += ledger.sum("caustics.reflected");
        energy.lost += ledger.sum("caustics.lost");
        energy.received += double(passes.unit()) * ledger.sum("caustics.map");
        const std::vector<Image> flux = ledger.all("caustics.flux"), landing = ledger.all("caustics.landing"),
                                 effort = ledger.all("caustics.effort"),
                                 met = ledger.all("caustics.incident");
        for (std::size_t image = 0; image < flux.size(); ++image)
            for (std::size_t i = 0; i < flux[image].pixels.size(); i += 4) {
                const float* f = &flux[image].pixels[i];
                const dvec3 carried = double(met[image].pixels[i + 3]) * dvec3(f[0], f[1], f[2]);
                const bool landed = landing[image].pixels[i + 3] > 0;
                const bool isAstray = std::abs(effort[image].pixels[i + 1]) > 2;
                if (!landed) energy.missed += carried;
                if (landed && isAstray) energy.astray += carried;
                energy.looks += double(effort[image].pixels[i]);
                if (f[3] > 0) ++rays;
            }
    }
    if (std::string error = context_.takeError(); !error.empty()) return Error{error, Fault::Machine};
    if (rays > 0) energy.looks /= rays;
    return energy;
}

} // namespace lucent::caustics
