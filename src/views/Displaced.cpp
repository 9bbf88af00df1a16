#include "views/Displaced.h"

#include "shaders/views/Blocks.h"

#include <algorithm>

namespace lucent::views {

namespace {
constexpr float kRoom =
    1e-3f; // of the heights: rays begin so much above the highest, and end below the surface
} // namespace

Result<Drawable::Ptr> DrawnDisplaced::create(const scene::Object& object, int index, ImageCache& images) {
    const auto drawn = std::make_shared<DrawnDisplaced>(object, index);
    drawn->base = scene::baseOf(object);
    drawn->method = object.displacement->method;
    Result<const Prisms*> prisms = images.prisms(drawn->base);
    if (!prisms) return prisms.error();
    drawn->prisms = *prisms;
    Result<const FieldTextures*> heights = images.field(drawn->base->heights);
    if (!heights) return heights.error();
    drawn->heights = *heights;
    if (const scene::Textures* pictures = texturesOf(object)) {
        const auto& mesh = std::get<scene::MeshShape>(object.shape).mesh;
        if (Result<const MeshTextures*> vertices = images.mesh(mesh, false); !vertices)
            return vertices.error();
        drawn->textured = images.textured(*mesh, *pictures);
    }
    return Ptr(drawn);
}

Drawing DrawnDisplaced::drawing(gl::Context& context, graph::PassBuilder&, ViewKind kind, int number,
                                std::vector<std::string> defines) const {
    std::erase(defines, "CUT"); // rays begin at the plane
    if (kind == ViewKind::Shadow) defines.push_back("AS_SHADOW");
    const bool isTextured = kind == ViewKind::Textured;
    if (method != scene::DisplacementMethod::Quadtree && !isTextured) defines.push_back("SEARCHED");
    const gl::Program* program =
        context.program(isTextured ? "views/displaced_textures" : "views/displaced", defines);
    return [drawn = *this, program, number, isTextured](const graph::Resources&, graph::Commands& commands,
                                                        const Eye& eye, ivec2 size, graph::Draw draw) {
        const scene::Displacement& displacement = *drawn.object->displacement;
        const scene::Transform& transform = drawn.object->transform;
        const auto clipFromPixel = glm::scale(glm::dmat4(1), glm::dvec3(2.0 / size.x, 2.0 / size.y, 1));
        const mat4 worldFromObject = transform.worldFromObject();
        const mat4 clipFromObject = eye.clipFromWorld * worldFromObject;
        scene::HeightField field;
        field.heightScale = displacement.scale;
        field.heights = drawn.base->heights;
        field.width = float(field.heights->width); // texels are 1 wide
        const float reach = drawn.base->reach(displacement),
                    room = kRoom * std::max(reach, 1e-3f * displacement.scale);
        draw.textures.push_back({"uPrisms", drawn.prisms->texels.handle()});
        const auto textures = drawn.heights->bindings();
        draw.textures.insert(draw.textures.end(), textures.begin(), textures.end());
        if (isTextured) drawn.textured->bind(draw.textures);
        draw.program = program;
        draw.indices = drawn.prisms->hulls.handle();
        draw.vertices = drawn.prisms->hulls.count();
        draw.cull = graph::Cull::Front; // an eye may stand in a prism
        draw.block = DisplacedBlock{
            .clipFromObject = clipFromObject,
            .objectFromPixel = mat4(glm::inverse(glm::dmat4(clipFromObject)) * clipFromPixel),
            .normalFromObject = mat4(rotationFromDegrees(transform.rotate)),
            .depthFromObject = vec4(eye.forward, -glm::dot(eye.forward, eye.position)) * worldFromObject,
            .cut = eye.cut * worldFromObject,
            .eye = eye.inObject(worldFromObject),
            .field = drawn.heights->block(field),
            .size = vec2(size),
            .corner = vec2(draw.region),
            .depths = {eye.nearest, eye.farthest},
            .span = {-room, reach + room},
            .object = number,
            .method = int(drawn.method),
            .searchSteps = displacement.searchSteps,
            .refineSteps = displacement.refineSteps,
            .isClosed = drawn.base->closed,
            .normalScale = drawn.textured ? drawn.textured->normalScale : 0,
            .wraps = drawn.textured ? drawn.textured->wraps : vec4(0)};
        commands.draw(draw);
    };
}

std::vector<DrawnDisplaced> displacedOf(const Drawables& list) {
    std::vector<DrawnDisplaced> surfaces;
    for (const auto& one : list)
        if (const DrawnDisplaced* surface = one->displaced()) surfaces.push_back(*surface);
    return surfaces;
}

} // namespace lucent::views
