#pragma once
/// Displaced surfaces as views draw them: rays are cast through the space above each of their triangles.

#include "scene/Displacement.h"
#include "views/Drawable.h"
#include "views/FieldTextures.h"

namespace lucent::views {

struct DrawnDisplaced final : Drawable {
    using Drawable::Drawable;
    static Result<Ptr> create(const scene::Object& object, int index, ImageCache& images);

    std::shared_ptr<const scene::DisplacedBase> base;
    const Prisms* prisms = nullptr;
    const FieldTextures* heights = nullptr;
    scene::DisplacementMethod method{}; ///< by which rays are cast

    Result<Ptr> posed(graph::FrameGraph&, gl::Context&, float, std::vector<DrawnMesh*>&) const override {
        return Ptr(std::make_shared<DrawnDisplaced>(*this));
    }
    bool hasBack() const override { return false; }
    Drawing drawing(gl::Context& context, graph::PassBuilder&, ViewKind kind, int number,
                    std::vector<std::string> defines) const override;
    const DrawnDisplaced* displaced() const override { return this; }
};

/// Those of one kind alone.
std::vector<DrawnDisplaced> displacedOf(const Drawables& list);

} // namespace lucent::views
