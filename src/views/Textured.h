#pragma once
/// Textures of meshes (scene/Textures.h) on the GPU, and what they say where a view shows these meshes.

#include "gl/Context.h"
#include "graph/FrameGraph.h"
#include "scene/Mesh.h"
#include "views/Eye.h"

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace lucent::views {

struct Drawable;

/// A picture on the GPU; shaders read linear light, whatever its encoding.
graph::Texture textureOf(gl::Device& device, const scene::TextureImage& image);

/// Coordinates of vertices as a texture of vertexImageSize(), RGBA32F: those of the second set behind the
/// first's, which may be empty.
graph::Texture coordinateTexture(gl::Device& device, const std::vector<vec2>& first,
                                 const std::vector<vec2>& second = {});

/// What an object with textures is drawn with.
struct Textured {
    graph::TextureHandle coordinates, colors, color, emission, roughness, normal;
    vec4 wraps; ///< of color, emission, roughness and normal: codes of shaders/views/texture_at.glsl
    float normalScale;
    float cutoff;   ///< scene::Textures::cutoff
    bool hasHoles;  ///< where the colour's alpha says so
    bool isBlended; ///< whether alpha is an opacity
    bool operator==(const Textured&) const = default;
    /// All that shaders/views/material_textures.glsl and the places on it need.
    void bind(std::vector<graph::Binding>& bindings) const;
};

/// Images of a view (shaders/views/textured.glsl).
struct TexturedImages {
    graph::TextureId factors, facets, emission;
    explicit operator bool() const { return bool(factors); }
};

/// What the textures of some objects say where a surface image shows them. Images that were drawn stay while
/// the surface and the objects do: light alone may change, or be summed slice by slice.
class TexturedView {
public:
    /// The next surface is another one.
    void surfaceChanged() { isDrawn_ = std::make_shared<bool>(false); }

    /// Draws what is not there yet; no images without objects.
    ///
    /// @param eye, size  of the surface image
    /// @param list       objects with textures
    TexturedImages record(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                          const std::vector<std::shared_ptr<const Drawable>>& list, graph::TextureId surface,
                          ivec2 size);

private:
    void fit(gl::Context& context, ivec2 size);

    std::vector<std::pair<int, Textured>> of_; // object, its textures
    // Set when the pass has run, which a picture that is given up never does.
    std::shared_ptr<bool> isDrawn_ = std::make_shared<bool>(false);
    graph::Texture factors_, facets_, emission_;
};

/// What shaders/views/textured.glsl samples; nothing without images.
void sampleTextured(graph::PassBuilder& pass, const TexturedImages& images);
void bindTextured(std::vector<graph::Binding>& bindings, const graph::Resources& resources,
                  const TexturedImages& images);

} // namespace lucent::views
