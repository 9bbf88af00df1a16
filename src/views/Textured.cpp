#include "views/Textured.h"

#include "views/Drawable.h"
#include "views/Meshes.h"

#include <string>

namespace lucent::views {

using graph::Format;

graph::Texture textureOf(gl::Device& device, const scene::TextureImage& image) {
    const bool srgb = image.encoding == Encoding::Srgb;
    graph::Texture texture(device, {.size = image.size, .format = srgb ? Format::SRGBA8 : Format::RGBA8},
                           "views.texture");
    device.upload(texture.handle(), 0, image.texels);
    return texture;
}

graph::Texture coordinateTexture(gl::Device& device, const std::vector<vec2>& first,
                                 const std::vector<vec2>& second) {
    const ivec2 size = vertexImageSize(first.size());
    std::vector<vec4> rows(std::size_t(size.x) * std::size_t(size.y)); // the last row filled up
    for (std::size_t i = 0; i < first.size(); ++i)
        rows[i] = vec4(first[i], second.empty() ? vec2(0) : second[i]);
    graph::Texture texture(device, {.size = size, .format = Format::RGBA32F}, "views.coordinates");
    device.upload(texture.handle(), 0, rows);
    return texture;
}

void TexturedView::fit(gl::Context& context, ivec2 size) {
    const auto make = [&](graph::Texture& texture, Format format, const char* label) {
        const graph::TextureDesc desc{.size = size, .format = format};
        if (texture && texture.desc() == desc) return;
        texture = graph::Texture(context.device(), desc, label);
        surfaceChanged();
    };
    make(factors_, Format::RGBA16F, "views.factors");
    make(facets_, Format::RGBA32F, "views.facets");
    make(emission_, Format::RGBA16F, "views.emission");
}

void Textured::bind(std::vector<graph::Binding>& bindings) const {
    bindings.insert(bindings.end(), {{"uCoordinates", coordinates},
                                     {"uVertexColors", colors},
                                     {"uColor", color},
                                     {"uEmission", emission},
                                     {"uRoughness", roughness},
                                     {"uNormal", normal}});
}

TexturedImages TexturedView::record(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                    const Drawables& list, graph::TextureId surface, ivec2 size) {
    if (list.empty()) {
        if (factors_) *this = {}; // gives memory back
        return {};
    }
    fit(context, size);
    std::vector<std::pair<int, Textured>> of;
    for (const auto& one : list)
        of.emplace_back(one->index, *one->textured);
    if (of != of_) surfaceChanged();
    of_ = std::move(of);
    const auto imported = [&](const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    };
    const TexturedImages images{imported(factors_), imported(facets_), imported(emission_)};
    if (*isDrawn_) return images;
    graph.addPass("views.textured", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("textures of " + std::to_string(list.size()) + " object(s)");
        pass.sample(surface);
        for (const graph::TextureId image : {images.factors, images.facets, images.emission}) {
            pass.write(image);
            pass.clear(image, vec4(0));
        }
        pass.clear(pass.createDepth("views.depth", size), 1.0f);
        const std::vector<Drawing> drawings = drawingsOf(context, pass, list, ViewKind::Textured);
        return [=, isDrawn = isDrawn_](const graph::Resources& resources, graph::Commands& commands) {
            for (const Drawing& drawing : drawings)
                drawing(
                    resources, commands, eye, size,
                    {.depthTest = graph::DepthTest::Less, .textures = {{"uSurface", resources[surface]}}});
            *isDrawn = true;
        };
    });
    for (const graph::TextureId image : {images.factors, images.facets, images.emission})
        graph.keep(image); // read by later slices
    return images;
}

void sampleTextured(graph::PassBuilder& pass, const TexturedImages& images) {
    if (!images) return;
    for (const graph::TextureId image : {images.factors, images.facets, images.emission})
        pass.sample(image);
}

void bindTextured(std::vector<graph::Binding>& bindings, const graph::Resources& resources,
                  const TexturedImages& images) {
    if (!images) return;
    bindings.push_back({"uFactors", resources[images.factors]});
    bindings.push_back({"uFacets", resources[images.facets]});
    bindings.push_back({"uEmission", resources[images.emission]});
}

} // namespace lucent::views
