#pragma once
/// Height fields as views draw them: rays are intersected with them, pixel by pixel.

#include "views/Drawable.h"
#include "views/FieldTextures.h"

namespace lucent::views {

struct DrawnField final : Drawable {
    using Drawable::Drawable;
    static Result<Ptr> create(const scene::Object& object, int index, ImageCache& images);

    const FieldTextures* heights = nullptr;
    graph::TextureHandle alpha = graph::TextureHandle::None;
    graph::TextureHandle baseMap = graph::TextureHandle::None;
    graph::TextureHandle diffuseMap = graph::TextureHandle::None;
    graph::TextureHandle specularMap = graph::TextureHandle::None;

    FieldBlock block() const { return heights->block(object->field()); }

    const DrawnField* field() const override { return this; }
    Result<Ptr> posed(graph::FrameGraph&, gl::Context&, float, std::vector<DrawnMesh*>&) const override {
        return Ptr(std::make_shared<DrawnField>(*this));
    }
    Drawing drawing(gl::Context& context, graph::PassBuilder&, ViewKind kind, int number,
                    std::vector<std::string> defines) const override;
    bool hasBack() const override { return false; }
    bool drawsNearest() const override { return true; }
    std::optional<graph::Draw> geometry(gl::Context& context, const Eye& eye,
                                        const char* quantity) const override;
};

} // namespace lucent::views
