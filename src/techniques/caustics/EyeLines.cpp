#include "techniques/caustics/LightPasses.h"

namespace lucent::caustics {

using graph::Format;
using graph::TextureId;

Status LightPasses::drawLines(TextureId& sum) {
    const gl::Program* drawing = program("caustics/line");
    const views::Bounds box = boxOfReceivers();
    TextureId flux;
    graph_.addPass("caustics.lines", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("rays as lines in the picture, which light what they intersect there");
        pass.sample(in_.surface);
        for (const Sheet& sheet : sheets_) {
            pass.sample(sheet.grid.place);
            pass.sample(sheet.grid.direction);
            pass.sample(sheet.grid.flux);
        }
        flux = pass.createColor("caustics.linesFlux", {.size = in_.size, .format = sumFormat()});
        pass.clear(flux, vec4(0));
        return [=, program = drawing, sheets = sheets_, surface = in_.surface, unit = unit(),
                view = views::viewBlock(in_.eye, in_.size)](const graph::Resources& resources,
                                                            graph::Commands& commands) {
            for (const Sheet& sheet : sheets) {
                const Photons& photons = sheet.grid;
                commands.draw(
                    {.program = program,
                     .vertices = 2 * photons.count.x * photons.count.y,
                     .topology = graph::Topology::Lines,
                     .blend = graph::Blend::Add,
                     .block = LinesBlock{view, vec4(box.low, 0), vec4(box.high, 0), photons.count, unit},
                     .textures = {{"uPlace", resources[photons.place]},
                                  {"uDirection", resources[photons.direction]},
                                  {"uFlux", resources[photons.flux]},
                                  {"uSurface", resources[surface]}}});
            }
        };
    });
    return gather(flux, sum);
}

Status LightPasses::gather(TextureId flux, TextureId& sum) {
    const gl::Program* gathering =
        program("caustics/gather", sum ? std::vector<std::string>{"USE_BEFORE"} : std::vector<std::string>{});
    const TextureId before = sum;
    graph_.addPass("caustics.gather", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("irradiance by the rays that hit what the pixels around show");
        pass.sample(in_.surface);
        pass.sample(flux);
        if (before) pass.sample(before);
        sum = pass.createColor("caustics.irradiance", {.size = in_.size, .format = Format::RGBA32F});
        return [=, program = gathering, surface = in_.surface,
                block = GatherBlock{views::viewBlock(in_.eye, in_.size), unit()}](
                   const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> textures{{"uSurface", resources[surface]},
                                                 {"uFlux", resources[flux]}};
            if (before) textures.push_back({"uBefore", resources[before]});
            commands.draw({.program = program, .block = block, .textures = std::move(textures)});
        };
    });
    return Done{};
}

} // namespace lucent::caustics
