// Views from mirrors and refractive objects: what rays meet that leave what the camera shows. Pictures like
// the camera's, drawn by another state: cubes once for a scene, flat mirrors' pictures with each view.
#include "frame/RendererState.h"

#include "light/Samples.h"
#include "light/ShadowMap.h"
#include "scene/Load.h"
#include "views/Surface.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <utility>

namespace lucent::frame {

using graph::Format;
using graph::TextureDesc;
using graph::TextureId;

namespace {

constexpr int kFaces = 6;
constexpr int kLeastFace = 32, kMostFace = 512; // pixels a side,
constexpr int kPreviewFace = 64;                // and where there are previews alone
constexpr int kLeastDirections = 16;            // of an environment: a quarter, for six faces
constexpr const char* kCoarseKey = " coarse";   // of what is drawn for previews
constexpr float kLeastFlat = 1.0f / 4096;       // of the picture: what covers less is seen by the cube

// A face shows a quarter of a turn: as many pixels as the picture has along its longer side hold twice the
// detail of a ball that fills it. Many cubes together take no more memory than two of the largest.
int faceSize(ivec2 picture, std::size_t cubes) {
    const float most =
        float(kMostFace) * std::sqrt(std::min(1.0f, 2 / float(std::max<std::size_t>(1, cubes))));
    return std::clamp(std::max(picture.x, picture.y), kLeastFace, int(most));
}

bool isEmpty(const views::Bounds& bounds) { return bounds.low.x > bounds.high.x; }

// Whether any corner of a box lies before a mirror.
bool reachesBefore(const views::FlatMirror& mirror, const views::Bounds& bounds) {
    const vec3 farthest = glm::mix(bounds.low, bounds.high, glm::step(vec3(0), mirror.normal));
    const float slack = 1e-4f * bounds.radius();
    return glm::dot(farthest - mirror.place, mirror.normal) > slack;
}

void hide(scene::Scene& scene, const std::vector<int>& objects) {
    for (const int object : objects)
        scene.objects[std::size_t(object)].visible = false;
}

// The others cast their shadows still.
void hideBehind(scene::Scene& scene, const views::FlatMirror& mirror) {
    scene.objects[std::size_t(mirror.object)].visible = false;
    for (scene::Object& object : scene.objects)
        if (!reachesBefore(mirror, views::boundsOf(object))) object.visible = false;
}

// Bits of the faces of a cube view in which anything may be seen, and in which an object may hide another one
// (views::Surroundings::faces). Through refractive objects what is behind them is seen.
int facesWithAnything(scene::Scene scene, const views::Probe& cube) {
    hide(scene, cube.hidden);
    int faces = 0;
    for (int face = 0; face < kFaces; ++face) {
        scene.camera = views::cameraOf(cube, face);
        const views::Eye eye = views::makeEye(scene, 1);
        int seen = 0, clear = 0;
        for (const scene::Object& object : scene.objects) {
            if (!object.visible || isEmpty(views::seenBy(eye, views::boundsOf(object)))) continue;
            ++seen;
            clear += object.material.isRefractive();
        }
        if (seen > 0) faces |= 1 << face;
        if (seen > 1 && clear == 0) faces |= 1 << (kFaces + face);
    }
    return faces;
}

const gl::Program* keepingProgram(gl::Context& context, bool isCube) {
    return context.program("views/around",
                           isCube ? std::vector<std::string>{"WITH_SOLID"} : std::vector<std::string>{});
}

bool showsAnything(const scene::Scene& scene) {
    return std::any_of(scene.objects.begin(), scene.objects.end(),
                       [](const scene::Object& object) { return object.visible; });
}

} // namespace

Renderer::State::SceneKey Renderer::State::sceneryKey(scene::Scene scene) const {
    scene.technique.clear();
    scene.quality = {};
    return sceneKey(std::move(scene));
}

Renderer::State::SceneKey Renderer::State::sceneKey(scene::Scene scene) const {
    SceneKey key{scene.view.matt ? " matt" : "", views::objectKeys(scene), {}, waters.changes()};
    scene.camera = {};
    scene.size = ivec2(1);
    scene.view = {};
    scene.title = scene.caption = "";
    key.text = scene::toJson(scene) + key.text;
    for (const scene::Object& object : scene.objects) {
        for (const auto& map : object.material.maps())
            key.maps.push_back(map);
        key.maps.push_back(object.painting);
    }
    for (const auto& map : scene::lightPictures(scene))
        key.maps.push_back(map);
    return key;
}

// What is to be drawn before the picture of a stage. A preview keeps the cubes that there are.
Status Renderer::State::survey(const Moment& moment) {
    surveyed = true;
    asides.clear();
    asideScene.reset();
    const bool isColor = moment.scene.view.show == scene::Aov::Color;
    if (given || (keepsCubes && !isColor)) return Done{};
    views::Probes asked;
    const technique::Picture picture = pictureOf(moment);
    if (isColor)
        for (const technique::Guest* guest : needed(moment.scene))
            guest->lookAround(picture, asked);
    surroundings.bounds = {};
    for (const scene::Object& object : moment.scene.objects)
        if (object.visible) surroundings.bounds.add(views::boundsOf(object));
    surveyCubes(moment, std::move(asked.cubes));
    surveyFlat(moment, std::move(asked.flat));
    beyondFlat = surroundings;
    beyondFlat.flat.clear();
    beyondFlat.further = 0; // a flat mirror was the first
    if (surroundings.cubes.empty() && surroundings.flat.empty()) elsewhere.reset();
    asidesAsked = asides.size();
    asideShare = 0;
    if (asides.empty()) return Done{};
    for (const Aside& aside : asides) // they are made while the first is drawn
        keepingProgram(context, aside.cube >= 0);
    if (!elsewhere) elsewhere = std::make_unique<State>(context, &supplies);
    return Done{};
}

void Renderer::State::surveyCubes(const Moment& moment, std::vector<views::Probe> asked) {
    probesLeft = asked.size() - std::min(asked.size(), std::size_t(views::kMostCubes));
    asked.resize(asked.size() - probesLeft);
    const bool moved = asked != surroundings.cubes;
    if (moved) {
        surroundings.cubes = asked;
        surroundings.faces.assign(asked.size(), 0);
        facesShown.assign(asked.size(), 0);
        cubesFor.reset();
    }
    // A preview has the picture's cubes. What plays or is dragged before there are any has small ones,
    // without what others hide, unless they would move with it.
    const bool isSmall = isCoarse() && !cubesFor && !isNew && !moved;
    const bool draws = !asked.empty() && (!isCoarse() || isSmall);
    if (draws) {
        SceneKey key = keepsCubes ? sceneryKey(moment.scene) : sceneKey(moment.scene);
        if (isSmall) key.text += kCoarseKey;
        if (cubesFor != key) {
            cubesFor = std::move(key);
            surroundings.faces.assign(asked.size(), 0);
            const int which = isSmall ? (1 << kFaces) - 1 : ~0;
            for (std::size_t cube = 0; cube < asked.size(); ++cube)
                facesShown[cube] = facesWithAnything(moment.scene, asked[cube]) & which;
        }
    }
    const int full = faceSize(screen, asked.size());
    int side = full;
    if (isSmall)
        side = std::min(full, kPreviewFace);
    else if (!draws && aroundRadiance)
        side = aroundRadiance.desc().size.x;
    makeCubes(side);
    // A preview with fewer pixels shows less of them.
    const float finer = float(side) / float(full) * float(screen.x) / float(size.x);
    surroundings.texelsALook = views::kTexelsALook * std::max(1.0f, finer);
    if (!draws) return;
    for (std::size_t cube = 0; cube < asked.size(); ++cube)
        for (int face = 0; face < 2 * kFaces; ++face)
            if (((facesShown[cube] & ~surroundings.faces[cube]) >> face) & 1)
                asides.push_back({.cube = int(cube), .face = face % kFaces, .second = face >= kFaces});
}

// With so many pixels a side.
void Renderer::State::makeCubes(int side) {
    const int count = int(surroundings.cubes.size());
    const bool hides =
        std::any_of(facesShown.begin(), facesShown.end(), [](int faces) { return faces >> kFaces; });
    TextureDesc desc{
        .size = ivec2(side), .format = Format::RGBA16F, .layers = kFaces * count * (hides ? 2 : 1)};
    if (aroundRadiance && (count == 0 || aroundRadiance.desc() != desc)) {
        surroundings.faces.assign(surroundings.cubes.size(), 0);
        aroundRadiance = graph::Texture();
        aroundSolid = graph::Texture();
    }
    if (count > 0 && !aroundRadiance) {
        aroundRadiance = graph::Texture(context.device(), desc, "frame.aroundRadiance");
        desc.format = Format::RGBA32F;
        aroundSolid = graph::Texture(context.device(), desc, "frame.aroundSolid");
    }
    surroundings.radiance = aroundRadiance.handle();
    surroundings.solid = aroundSolid.handle();
}

void Renderer::State::surveyFlat(const Moment& moment, std::vector<views::FlatMirror> asked) {
    std::erase_if(asked, [&](const views::FlatMirror& mirror) {
        if (mirror.share < kLeastFlat) return true;
        const scene::Object& object = moment.scene.objects[std::size_t(mirror.object)];
        if (isEmpty(views::seenBy(moment.eye, views::boundsOf(object)))) return true;
        scene::Scene seen = moment.scene;
        hideBehind(seen, mirror);
        return !showsAnything(seen);
    });
    std::stable_sort(asked.begin(), asked.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    asked.resize(std::min(asked.size(), std::size_t(views::kMostFlat)));
    surroundings.flat = std::move(asked);
    if (surroundings.flat.empty()) {
        flatPictures = graph::Texture();
        flatFor.reset();
    } else {
        // An array, even for one.
        const TextureDesc desc{
            .size = size, .format = Format::RGBA16F, .layers = std::max(2, int(surroundings.flat.size()))};
        if (!flatPictures || flatPictures.desc() != desc) {
            flatPictures = graph::Texture(context.device(), desc, "frame.flatMirrors");
            flatFor.reset();
        }
        std::pair<SceneKey, mat4> key{sceneKey(moment.scene), moment.eye.clipFromWorld};
        if (isCoarse()) key.first.text += kCoarseKey;
        if (flatFor != key) flatDrawn = 0;
        flatFor = std::move(key);
        for (int i = 0; i < int(surroundings.flat.size()); ++i) // after the cubes: the last is drawn first
            if (((flatDrawn >> i) & 1) == 0) asides.insert(asides.begin(), {.flat = i});
    }
    surroundings.mirrored = flatPictures.handle();
}

scene::Scene Renderer::State::sceneFor(const Moment& moment, const Aside& aside) const {
    scene::Scene scene = moment.scene;
    scene.quality.maxError = 0;
    views::samplingOf(scene).pixelSamples = 1;
    if (aside.flat >= 0) {
        const views::FlatMirror& mirror = surroundings.flat[std::size_t(aside.flat)];
        hideBehind(scene, mirror);
        scene.camera = views::mirrored(scene.camera, mirror);
        views::samplingOf(scene).directions = directionsOfSample(moment.scene);
    } else {
        const views::Probe& cube = surroundings.cubes[std::size_t(aside.cube)];
        hide(scene, cube.hidden);
        scene.camera = views::cameraOf(cube, aside.face);
        views::Sampling& sampling = views::samplingOf(scene);
        sampling.directions =
            std::min(sampling.directions, std::max(kLeastDirections, sampling.directions / 4));
    }
    return scene;
}

// Draws for a slice of time. @return whether all that the stage's picture needs is there
Result<bool> Renderer::State::lookAround(const Moment& moment) {
    if (!surveyed)
        if (Status done = survey(moment); !done) return done.error();
    if (asides.empty()) return true;
    static const views::Surroundings kNothing;
    const Aside aside = asides.back();
    const bool isFlat = aside.flat >= 0;
    if (!asideScene) {
        asideScene = std::make_unique<scene::Scene>(sceneFor(moment, aside));
        ++asideRevision;
    }
    elsewhere->cut = vec4(0, 0, 0, 1);
    elsewhere->shift = vec2(0);
    elsewhere->threshold = moment.eye.threshold;
    elsewhere->second = aside.second;
    elsewhere->lightOf = {0, 1};
    if (isFlat) {
        elsewhere->shift = moment.eye.shift * vec2(-1, 1);
        if (variesLight(moment.scene)) elsewhere->lightOf = {sample, pixelSamples(moment.scene)};
        const views::FlatMirror& mirror = surroundings.flat[std::size_t(aside.flat)];
        elsewhere->cut = vec4(mirror.normal, -glm::dot(mirror.normal, mirror.place));
    }
    elsewhere->allAround = !isFlat;
    elsewhere->given = isFlat ? &beyondFlat : &kNothing;
    const Effort effort = isCoarse() ? Effort::Coarse : atOnce ? Effort::Final : Effort::Unseen;
    Result<Progress> progress =
        elsewhere->advance(*asideScene, asideRevision, isFlat ? size : aroundRadiance.desc().size, effort);
    asideShare = progress && !progress->complete ? progress->share : 0;
    if (progress && progress->complete) {
        if (Status kept = keepAside(*asideScene, aside); !kept) progress = kept.error();
        asideScene.reset();
        asides.pop_back();
    }
    if (!progress) {
        cubesFor.reset();
        flatFor.reset();
        return progress.error();
    }
    return asides.empty();
}

// The picture, and of a cube's also what it shows: refractive objects by their outside.
Status Renderer::State::keepAside(const scene::Scene& scene, const Aside& aside) {
    State& from = *elsewhere;
    passes += from.passes;
    const bool isCube = aside.cube >= 0;
    const TextureDesc desc{.size = from.size, .format = Format::RGBA32F};
    const graph::Texture linear(context.device(), desc, "frame.aside");
    Result<Moment> moment = from.momentOf(scene);
    if (!moment) return moment.error();
    const gl::Program* program = keepingProgram(context, isCube);
    Status kept = from.runGraph([&](graph::FrameGraph& graph) -> Status {
        const TextureId picture = import(graph, linear);
        if (Status s = from.recordDisplay(graph, scene, picture, true); !s) return s;
        TextureId surface, solid;
        if (isCube) {
            Result<views::Drawables> posed =
                views::recordPose(graph, context, moment->drawables, scene.view.time);
            if (!posed) return posed.error();
            const views::Drawables seen = visible(*posed);
            surface = graph.create("frame.asideSurface", desc);
            solid = graph.create("frame.asideSolid", desc);
            Status s = views::recordSurface(graph, context, moment->eye, seen, surface, from.size);
            if (s) s = views::recordSolid(graph, context, moment->eye, seen, surface, solid, from.size);
            if (!s) return s;
        }
        const TextureId radiances = import(graph, isCube ? aroundRadiance : flatPictures);
        const TextureId solids = isCube ? import(graph, aroundSolid) : TextureId{};
        const int cube = aside.cube + (aside.second ? int(surroundings.cubes.size()) : 0);
        const int layer = isCube ? kFaces * cube + aside.face : aside.flat;
        graph.addPass("views.around", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.reason("what reflection probes see");
            pass.sample(picture);
            pass.write(radiances, layer);
            if (isCube) {
                pass.sample(surface);
                pass.sample(solid);
                pass.write(solids, layer);
            }
            return [=](const graph::Resources& resources, graph::Commands& commands) {
                std::vector<graph::Binding> textures{{"uPicture", resources[picture]}};
                if (isCube) {
                    textures.push_back({"uSurface", resources[surface]});
                    textures.push_back({"uSolid", resources[solid]});
                }
                commands.draw({.program = program, .textures = std::move(textures)});
            };
        });
        graph.keep(radiances);
        if (isCube) graph.keep(solids);
        return Done{};
    });
    if (!kept) return kept;
    if (isCube) {
        surroundings.faces[std::size_t(aside.cube)] |= 1 << (aside.face + (aside.second ? kFaces : 0));
        beyondFlat.faces = surroundings.faces;
    } else {
        flatDrawn |= 1 << aside.flat;
    }
    return Done{};
}

std::vector<std::string> Renderer::State::aroundLines() const {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < surroundings.cubes.size(); ++i) {
        const auto shown = std::bitset<2 * kFaces>(unsigned(facesShown[i]));
        const auto seconds = (shown >> kFaces).count();
        const bool isOfItself = surroundings.cubes[i].object < -1;
        lines.push_back(
            (isOfItself ? "of itself, " : "") + ("from \"" + surroundings.cubes[i].name + "\": ") +
            std::to_string(shown.count() - seconds) + " face(s) of a cube, " +
            (seconds > 0 ? std::to_string(seconds) + " of them also without what hides other objects, "
                         : "") +
            std::to_string(aroundRadiance.desc().size.x) +
            " pixels a side: rays leave it towards what the camera need not see");
    }
    for (const views::FlatMirror& mirror : surroundings.flat)
        lines.push_back("the camera's view mirrored by \"" + mirror.name + "\", " + std::to_string(size.x) +
                        "x" + std::to_string(size.y) + ": a flat mirror shows it exactly");
    if (probesLeft > 0)
        lines.push_back(std::to_string(probesLeft) + " more object(s): no more than " +
                        std::to_string(views::kMostCubes) +
                        " look around themselves; these show the environment");
    return lines;
}

} // namespace lucent::frame
