#pragma once
/// A height field on the GPU: its heights, and the pyramid of lowest and highest heights by which rays skip.

#include "gl/Context.h"
#include "graph/Device.h"
#include "scene/Scene.h"
#include "shaders/views/Blocks.h"
#include "views/Meshes.h"
#include "views/Prisms.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace lucent::views {

struct HeightRange {
    float lowest, highest; ///< stored heights
};
HeightRange heightRange(const Image& heights);

/// One level of a min-max pyramid: pairs of 16-bit numbers, row by row, rounded outwards over the map's
/// range.
struct PyramidLevel {
    ivec2 size;
    std::vector<std::uint16_t> pairs;
};

/// Lowest and highest height of every 2, 4, 8, ... cells squared, where a cell lies between four samples (or
/// at the border between two, or one). Sizes are padded so that each level is half of the one before; the
/// coarsest has at most 16 blocks on a side, padding aside. After maximum mipmaps (Tevs, Ihrke, Seidel 2008).
std::vector<PyramidLevel> buildPyramid(const Image& heights);

/// A height map and its pyramid as textures.
class FieldTextures {
public:
    /// Heights alone.
    FieldTextures(gl::Context& context, std::shared_ptr<const Image> heights);
    void addPyramid(gl::Context& context);
    bool isWhole() const { return bool(pyramid_); }

    FieldBlock block(const scene::HeightField& field) const;
    std::vector<graph::Binding> bindings() const;
    std::size_t bytes() const { return heights_.desc().bytes() + (isWhole() ? pyramid_.desc().bytes() : 0); }

private:
    std::shared_ptr<const Image> source_; // its address is the cache's key: it must not be reused
    graph::Texture heights_, pyramid_;
    HeightRange range_;
    int levels_ = 0;
};

/// Textures of the images of a scene, each made once and dropped when no scene image needs it.
class ImageCache {
public:
    explicit ImageCache(gl::Context& context) : context_(context) {}
    /// Error (Fault::Machine) when the map is larger than the GPU's textures.
    Result<const FieldTextures*> field(const std::shared_ptr<const Image>& heights);
    /// Error (Fault::Machine) when it has more vertices than a texture holds.
    ///
    /// @param refractive  whether its triangles are needed
    Result<const MeshTextures*> mesh(const std::shared_ptr<const scene::Mesh>& mesh, bool refractive);
    /// Of displaced surfaces (Displaced.h). Error (Fault::Machine) where they have too many triangles.
    Result<const Prisms*> prisms(const std::shared_ptr<const scene::DisplacedBase>& base);
    /// What a mesh that mesh() knows is drawn with, of whose images these are.
    Textured textured(const scene::Mesh& mesh, const scene::Textures& textures);
    /// Takes one part of what an object is drawn with to the GPU: its heights or vertices, one of its
    /// pictures. @return false: all are there, or it has no such parts
    bool takePart(const scene::Object& object);
    /// A colour map or alpha: 1 channel becomes R32F, 3 become RGBA16F filtered.
    Result<graph::TextureHandle> image(const std::shared_ptr<const Image>& image);
    /// The maps of a painting, each uploaded once: one that changes is another image. Error (Fault::Machine)
    /// when they are larger than the GPU's textures.
    Result<Paint> paint(const scene::Painting& painting, const std::shared_ptr<const scene::Atlas>& atlas);
    /// Drops what was not asked for since the last trim().
    void trim();
    void clear();
    std::size_t bytes() const;

private:
    template <class Self, class Each>
    static void forEachCache(Self& self, const Each& each);
    template <class Value, class Source = Image>
    struct Entry {
        std::unique_ptr<Value> value;
        std::shared_ptr<const Source> source;
        bool used = true;
    };
    Status checkSize(const Image& image) const;
    bool takePartOf(const scene::HeightField& field, const scene::Material& material);
    Result<FieldTextures*> heights(const std::shared_ptr<const Image>& image); // and a pyramid, or none yet
    Result<PaintMap*> begunPaint(const std::shared_ptr<const Image>& image);   // parts of it may lack
    Result<const PaintMap*> paintMap(const std::shared_ptr<const Image>& image);
    graph::TextureHandle texture(const std::shared_ptr<const scene::TextureImage>& image);
    gl::Context& context_;
    std::map<const Image*, Entry<FieldTextures>> fields_;
    std::map<const Image*, Entry<graph::Texture>> images_;
    std::map<const scene::Mesh*, Entry<MeshTextures, scene::Mesh>> meshes_;
    std::map<const scene::DisplacedBase*, Entry<Prisms, scene::DisplacedBase>> prisms_;
    std::map<const Image*, Entry<PaintMap>> paints_;
    std::map<const scene::Atlas*, Entry<graph::Texture, scene::Atlas>> places_;
    std::map<const scene::TextureImage*, Entry<graph::Texture, scene::TextureImage>> textures_;
};

} // namespace lucent::views
