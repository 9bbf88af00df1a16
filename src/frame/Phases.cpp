// One picture's passes: what the guests draw, phase by phase.
#include "frame/RendererState.h"

#include "light/FlatWater.h"

#include "views/Surface.h"

#include <algorithm>

namespace lucent::frame {

using graph::Format;
using graph::TextureId;
using technique::Guest;
using technique::Passes;
using technique::Picture;

namespace {

using views::hasEnvironment;

const gl::Program* meanProgram(gl::Context& context, bool isComposed, bool isFirst) {
    std::vector<std::string> defines;
    if (isComposed) defines.push_back("COMPOSED");
    if (isFirst) defines.push_back("FIRST");
    return context.program("frame/mean", defines);
}

} // namespace

BackgroundBlock backgroundBlock(const scene::Environment& light, const views::Eye& eye, ivec2 size) {
    return {.view = views::viewBlock(eye, size),
            .mapFromWorld = mat4(glm::transpose(rotationFromDegrees(light.rotation))),
            .intensity = light.intensity};
}

Renderer::State::State(gl::Context& gl, Supplies* of)
    : context(gl), pool(gl.device()), own(of ? nullptr : std::make_unique<Supplies>(gl, pool)),
      supplies(of ? *of : *own), images(supplies.images), waters(supplies.waters), shadows(supplies.shadows),
      costs(supplies.costs), budget(*this) {
    for (const technique::Technique* technique : technique::all())
        members.push_back({technique, technique->make({context, pool, images})});
}

// Quantities of a place, such as normals and counts, are those of the pixel's middle.
int Renderer::State::pixelSamples(const scene::Scene& scene) const {
    return scene.view.show == scene::Aov::Color ? views::samplingOf(scene).pixelSamples : 1;
}

views::Eye Renderer::State::eyeOf(const scene::Scene& scene) const {
    const int samples = pixelSamples(scene);
    const vec2 offset = views::pixelOffset(sample, samples);
    views::Eye eye = views::makeEye(scene, aspect(), 1e-3f, shift + 2.0f * offset / vec2(size));
    eye.cut = cut;
    eye.second = second;
    eye.threshold = threshold + float(sample) / float(samples);
    return eye;
}

Result<Renderer::State::Moment> Renderer::State::momentOf(const scene::Scene& scene) {
    // Objects are the scene's own: those of a copy would be gone before the passes run.
    Result<views::Drawables> drawables = views::drawablesOf(scene, images, &waters);
    if (!drawables) return drawables.error();
    Moment moment{chosen(scene), eyeOf(scene), std::move(*drawables)};
    if (hasEnvironment(scene)) {
        Result<graph::TextureHandle> map = images.image(scene.environment->map);
        if (!map) return map.error();
        moment.environment = *map;
    }
    return moment;
}

std::vector<Guest*> Renderer::State::needed(const scene::Scene& scene) const {
    std::vector<Guest*> list;
    for (const Member& member : members)
        if (member.technique->need(scene)) list.push_back(member.guest.get());
    return list;
}

// Who owns the quantity that is shown, or else who makes the picture anew.
Guest* Renderer::State::replacing(const Picture& picture) const {
    Guest* found = nullptr;
    for (const Member& member : members) {
        if (!member.guest->replaces(picture)) continue;
        const auto& aovs = member.technique->aovs;
        if (std::find(aovs.begin(), aovs.end(), picture.scene.view.show) != aovs.end())
            return member.guest.get();
        if (!found) found = member.guest.get();
    }
    return found;
}

// Whether the picture stands in `through` and not in `shown`: a guest makes it anew, or an environment stands
// behind meshes.
bool Renderer::State::replaces(const Picture& picture) const {
    if (views::isGeometric(picture.scene.view.show)) return false;
    const bool background = hasEnvironment(picture.scene) && picture.scene.view.show == scene::Aov::Color;
    if (replacing(picture)) return true;
    return background &&
           !filtered(opaque(visible(picture.drawables)), std::not_fn(&views::Drawable::field)).empty();
}

// @return  whether guests have what they need: else again, when the GPU has answered
Result<bool> Renderer::State::prepare(const Picture& picture) {
    readings.restart(atOnce ? nullptr : std::function<bool()>([this] { return canPreview(); }));
    for (const Member& member : members) {
        if (!member.technique->need(picture.scene)) {
            member.guest->clear();
            continue;
        }
        if (!surfaceShown) member.guest->viewChanged();
        if (Status s = member.guest->prepare(picture); !s) return s.error();
    }
    if (!readings.areThere()) return false;
    readings.clear();
    if (!replaces(picture))
        through = graph::Texture();
    else if (!through || through.desc() != shown.desc())
        through = graph::Texture(context.device(), shown.desc(), "frame.through");
    return true;
}

// Whether guests carry the environment's light past what bends it.
bool Renderer::State::carriesEnvironment(const scene::Scene& scene) const {
    const std::vector<Guest*> guests = needed(scene);
    return std::any_of(guests.begin(), guests.end(),
                       [&](const Guest* guest) { return guest->carriesEnvironment(scene); });
}

// The water that bends it else.
std::optional<light::FlatWaterBlock> Renderer::State::bendingWater(const scene::Scene& scene) const {
    return carriesEnvironment(scene) ? std::nullopt : views::flatWater(scene);
}

// Triangles stay where they are while their objects do, for the last phases: rays are traced there.
Result<views::Drawables> Renderer::State::poseKeeping(graph::FrameGraph& graph, const Picture& picture) {
    std::vector<views::ObjectKey> standing;
    for (const auto& one : filtered(picture.drawables, &views::Drawable::isTraced))
        standing.push_back(views::objectKey(*one->object, picture.scene.view.time));
    if (standing.empty()) // the next picture with some finds its own
        return views::recordPose(graph, context, picture.drawables, picture.scene.view.time);
    if (standing != triangled || watersThen != waters.changes()) triangles.current = false;
    triangled = std::move(standing);
    watersThen = waters.changes();
    return views::recordPose(graph, context, picture.drawables, picture.scene.view.time, &triangles);
}

Status Renderer::State::recordSlice(graph::FrameGraph& graph, const Picture& picture, int end) {
    const TextureId surfaceId = import(graph, surfaceShown ? shownSurface : surface);
    const TextureId targetId = import(graph, next > 0 ? scratch : sum);
    graph.keep(targetId);
    Result<views::Drawables> posed =
        views::recordPose(graph, context, picture.drawables, picture.scene.view.time);
    if (!posed) return posed.error();
    const scene::Aov show = picture.scene.view.show;
    const bool isGeometric = views::isGeometric(show);
    const views::Drawables seen = isGeometric ? visible(*posed) : opaque(visible(*posed));
    if (!surfaceDrawn && !seen.empty()) graph.keep(surfaceId); // read after this graph
    if (!surfaceDrawn)
        if (Status s = views::recordSurface(graph, context, picture.eye, seen, surfaceId, size); !s) return s;
    if (isGeometric)
        return views::recordGeometry(graph, context, picture.eye, seen, surfaceId, targetId, show, size);
    const float all = float(lights.size());
    const vec2 share = lights.empty() ? vec2(0, 1) : vec2(next, end) / all;
    return recordLight({picture, graph, *posed, surfaceId, share}, targetId, end);
}

// Light of one slice of the samples on everything that is lit where it is seen.
Status Renderer::State::recordLight(const Passes& passes, TextureId target, int end) {
    const Picture& picture = passes.picture;
    std::vector<Guest*> shading = needed(picture.scene), guests = shading;
    std::erase_if(shading, [&](const Guest* guest) { return !guest->shades(picture.scene); });
    if (shading.empty()) {
        views::recordNothing(passes.graph, "nothing is lit sample by sample", target);
        return Done{};
    }
    TextureId flux;
    if (next == 0) carrier = nullptr;
    for (Guest* guest : guests) {
        Result<TextureId> carried = guest->light(passes);
        if (!carried) return carried.error();
        if (!*carried) continue;
        flux = *carried;
        carrier = guest;
    }
    views::Bounds beside;
    for (const Guest* guest : shading)
        beside.add(guest->lit(picture));
    const views::Lit lit{.eye = picture.eye,
                         .size = size,
                         .surface = passes.surface,
                         .drawables = changingLight(picture.scene, passes.posed),
                         .water = bendingWater(picture.scene),
                         .shadowSize = views::samplingOf(picture.scene).shadowSize,
                         .carriesEnvironment = carriesEnvironment(picture.scene),
                         .beside = beside,
                         .allAround = fitsAll(),
                         .kept = repeats(picture.scene) ? &shadows : nullptr,
                         .keepsParts = isCoarse() || (!variesLight(picture.scene) && lightOf.y == 1)};
    shadows.stand(picture.scene, waters);
    const std::span<const views::LampPoint> some(lights.data() + next, std::size_t(end - next));
    Result<views::Occlusion> occlusion = views::recordOcclusion(passes.graph, context, lit, some);
    if (!occlusion) return occlusion.error();
    technique::Slice slice{.samples = lights,
                           .table = import(passes.graph, lightTable),
                           .first = next,
                           .end = end,
                           .placed = placed,
                           .occlusion = *occlusion,
                           .flux = flux,
                           .fluxOn = {},
                           .sum = next > 0 ? import(passes.graph, sum) : TextureId{},
                           .target = target,
                           .baked = stages[stage].baked,
                           .clears = true};
    if (carrier) slice.fluxOn = [&](const views::LitView& view) { return carrier->lightOn(passes, view); };
    for (Guest* guest : shading) {
        if (Status s = guest->shade(passes, slice); !s) return s;
        slice.clears = false;
    }
    return Done{};
}

// Over the complete sum: what is not summed sample by sample, what is seen through other things, and the
// environment behind all of it.
Status Renderer::State::recordRest(graph::FrameGraph& graph, const Picture& picture) {
    Result<views::Drawables> posed = poseKeeping(graph, picture);
    if (!posed) return posed.error();
    const TextureId shownId = import(graph, shown);
    const Passes passes{picture, graph, *posed, import(graph, shownSurface)};
    graph.keep(shownId);
    if (pixelSamples(picture.scene) > 1 && !stages[stage].coarse) // it is made meanwhile
        meanProgram(context, composed, sample == 0);
    Guest* const last = replacing(picture);
    if (!isNumbered(picture.scene.view.show)) {
        const std::vector<Guest*> guests = needed(picture.scene);
        for (Guest* guest : guests)
            if (Status s = guest->scatter(passes, shownId); !s) return s;
        for (Guest* guest : guests)
            if (Status s = guest->mirror(passes, shownId); !s) return s;
    }
    if (composed) {
        const TextureId target = import(graph, through);
        graph.keep(target);
        if (Status s =
                last ? last->through(passes, shownId, target) : recordBackground(passes, shownId, target);
            !s)
            return s;
    }
    return recordDepth(passes);
}

Status Renderer::State::recordBackground(const Passes& passes, TextureId shownId, TextureId target) {
    const gl::Program* program = context.program("frame/background");
    const BackgroundBlock block =
        backgroundBlock(*passes.picture.scene.environment, passes.picture.eye, size);
    passes.graph.addPass("frame.background", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the environment behind everything else");
        pass.sample(passes.surface);
        pass.sample(shownId);
        pass.write(target);
        return [=, surfaceId = passes.surface, map = passes.picture.environment](
                   const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .block = block,
                           .textures = {{"uSurface", resources[surfaceId]},
                                        {"uShown", resources[shownId]},
                                        {"uEnvironment", map}}});
        };
    });
    return Done{};
}

// The mean of the samples so far, with the picture of the last one.
Status Renderer::State::recordMean(graph::FrameGraph& graph, TextureId target) {
    const gl::Program* program = meanProgram(context, composed, sample == 0);
    const TextureId surfaceId = import(graph, shownSurface), shownId = import(graph, picture());
    const TextureId meanId = sample > 0 ? import(graph, mean) : TextureId{};
    graph.addPass("frame.mean", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("a pixel is the mean over its samples");
        for (const TextureId id : {surfaceId, shownId})
            pass.sample(id);
        if (meanId) pass.sample(meanId);
        pass.write(target);
        return [=, block = MeanBlock{.share = 1 / float(sample + 1)}](const graph::Resources& resources,
                                                                      graph::Commands& commands) {
            graph::Draw draw{
                .program = program,
                .block = block,
                .textures = {{"uSurface", resources[surfaceId]}, {"uShown", resources[shownId]}}};
            if (meanId) draw.textures.push_back({"uMean", resources[meanId]});
            commands.draw(draw);
        };
    });
    graph.keep(target);
    return Done{};
}

} // namespace lucent::frame
