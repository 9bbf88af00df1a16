#include "techniques/displacement/Counting.h"

#include "shaders/displacement/Blocks.h"
#include "views/Displaced.h"
#include "views/Surface.h"

namespace lucent::displacement {

using technique::Passes;

Status recordIterations(const Passes& passes, gl::Context& context, graph::TextureId target, bool clears) {
    const views::Drawables shown = filtered(visible(passes.posed), &views::Drawable::displaced);
    passes.graph.addPass("displacement.iterations", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("view.show asks for \"iterations\"");
        pass.sample(passes.surface);
        pass.write(target);
        if (clears) pass.clear(target, vec4(0));
        std::vector<views::Drawing> drawings =
            drawingsOf(context, pass, shown, views::ViewKind::Surface, {"SHOW_ITERATIONS"});
        return [=, surface = passes.surface, eye = passes.picture.eye,
                size = passes.picture.size](const graph::Resources& resources, graph::Commands& commands) {
            for (const views::Drawing& draw : drawings)
                draw(resources, commands, eye, size, {.textures = {{"uSurface", resources[surface]}}});
        };
    });
    return Done{};
}

Status recordMisses(const Passes& passes, gl::Context& context, graph::TextureId target) {
    const technique::Picture& picture = passes.picture;
    views::Drawables exact;
    for (const auto& one : opaque(visible(passes.posed))) {
        const views::DrawnDisplaced* displaced = one->displaced();
        if (!displaced) {
            exact.push_back(one);
            continue;
        }
        auto other = std::make_shared<views::DrawnDisplaced>(*displaced);
        other->method = scene::DisplacementMethod::Quadtree;
        exact.push_back(std::move(other));
    }
    const graph::TextureId image =
        passes.graph.create("displacement.exact", {.size = picture.size, .format = graph::Format::RGBA32F});
    if (Status s = views::recordSurface(passes.graph, context, picture.eye, exact, image, picture.size); !s)
        return s;
    const gl::Program* program = context.program("displacement/misses");
    std::vector<MissesBlock> blocks;
    for (const views::DrawnDisplaced& one : displacedOf(exact)) {
        const scene::Object& object = *one.object;
        blocks.push_back({.object = one.index,
                          .apart = one.base->reach(*object.displacement) * object.transform.scale / 256});
    }
    passes.graph.addPass("displacement.misses", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("view.show asks for \"misses\"");
        pass.sample(passes.surface);
        pass.sample(image);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=, surface = passes.surface](const graph::Resources& resources, graph::Commands& commands) {
            for (const MissesBlock& block : blocks)
                commands.draw({.program = program,
                               .block = block,
                               .textures = {{"uSurface", resources[surface]}, {"uExact", resources[image]}}});
        };
    });
    return Done{};
}

} // namespace lucent::displacement
