#include "views/Fields.h"

namespace lucent::views {

Result<Drawable::Ptr> DrawnField::create(const scene::Object& object, int index, ImageCache& images) {
    const auto drawn = std::make_shared<DrawnField>(object, index);
    Result<const FieldTextures*> heights = images.field(object.field().heights);
    if (!heights) return heights.error();
    drawn->heights = *heights;
    const std::pair<const std::shared_ptr<const Image>*, graph::TextureHandle*> maps[] = {
        {&object.field().alpha, &drawn->alpha},
        {&object.material.baseMap, &drawn->baseMap},
        {&object.material.diffuseMap, &drawn->diffuseMap},
        {&object.material.specularMap, &drawn->specularMap}};
    for (const auto& [map, handle] : maps) {
        if (!*map) continue;
        Result<graph::TextureHandle> texture = images.image(*map);
        if (!texture) return texture.error();
        *handle = *texture;
    }
    return Ptr(drawn);
}

Drawing DrawnField::drawing(gl::Context& context, graph::PassBuilder&, ViewKind kind, int number,
                            std::vector<std::string> defines) const {
    std::erase(defines, "CUT"); // rays begin at the plane
    if (kind == ViewKind::Shadow) defines.push_back("AS_SHADOW");
    const gl::Program* program = context.program("views/surface", defines);
    return [drawn = *this, program, number](const graph::Resources&, graph::Commands& commands,
                                            const Eye& eye, ivec2 size, graph::Draw draw) {
        const auto clipFromPixel = glm::scale(glm::dmat4(1), glm::dvec3(2.0 / size.x, 2.0 / size.y, 1));
        const mat4 worldFromObject = drawn.object->transform.worldFromObject();
        const mat4 clipFromObject = eye.clipFromWorld * worldFromObject;
        const SurfaceBlock block{
            .clipFromObject = clipFromObject,
            .objectFromPixel = mat4(glm::inverse(glm::dmat4(clipFromObject)) * clipFromPixel),
            .depthFromObject = vec4(eye.forward, -glm::dot(eye.forward, eye.position)) * worldFromObject,
            .cut = eye.cut * worldFromObject,
            .eye = eye.inObject(worldFromObject),
            .field = drawn.block(),
            .size = vec2(size),
            .object = number,
            .hasAlpha = drawn.alpha != graph::TextureHandle::None,
            .corner = vec2(draw.region),
            .depths = {eye.nearest, eye.farthest}};
        const auto textures = drawn.heights->bindings();
        draw.textures.insert(draw.textures.end(), textures.begin(), textures.end());
        if (block.hasAlpha) draw.textures.push_back({"uAlpha", drawn.alpha});
        draw.program = program;
        draw.vertices = 36;
        draw.cull = graph::Cull::Front;
        draw.block = block;
        commands.draw(draw);
    };
}

std::optional<graph::Draw> DrawnField::geometry(gl::Context& context, const Eye& eye,
                                                const char* quantity) const {
    return graph::Draw{.program = context.program("views/geometry", {quantity}),
                       .block = GeometryBlock{.worldFromObject = object->transform.worldFromObject(),
                                              .eye = vec4(eye.position, 1),
                                              .forward = vec4(eye.forward, 0),
                                              .field = block(),
                                              .object = index},
                       .textures = heights->bindings()};
}

} // namespace lucent::views
