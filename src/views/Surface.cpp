#include "views/Surface.h"

namespace lucent::views {

namespace {

const char* switchFor(scene::Aov aov) {
    switch (aov) {
    case scene::Aov::Normal:
        return "SHOW_NORMAL";
    case scene::Aov::Position:
        return "SHOW_POSITION";
    default:
        return "SHOW_DEPTH";
    }
}

} // namespace

Result<std::vector<DrawnObject>> drawnObjects(const scene::Scene& scene, ImageCache& images, bool hiddenToo) {
    std::vector<DrawnObject> drawn;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if ((!object.visible && !hiddenToo) || !object.isField()) continue;
        DrawnObject one{.object = &object, .index = int(i)};
        Result<const FieldTextures*> field = images.field(object.field().heights);
        if (!field) return field.error();
        one.field = *field;
        const std::pair<const std::shared_ptr<const Image>*, graph::TextureHandle*> maps[] = {
            {&object.field().alpha, &one.alpha},
            {&object.material.baseMap, &one.baseMap},
            {&object.material.diffuseMap, &one.diffuseMap},
            {&object.material.specularMap, &one.specularMap}};
        for (const auto& [map, handle] : maps) {
            if (!*map) continue;
            Result<graph::TextureHandle> texture = images.image(*map);
            if (!texture) return texture.error();
            *handle = *texture;
        }
        drawn.push_back(one);
    }
    return drawn;
}

void drawField(graph::Commands& commands, const gl::Program& program, const DrawnObject& drawn,
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
        .field = drawn.field->block(drawn.object->field()),
        .size = vec2(size),
        .object = drawn.index,
        .hasAlpha = drawn.alpha != graph::TextureHandle::None,
        .corner = vec2(draw.region),
        .depths = {eye.nearest, eye.farthest}};
    const auto textures = drawn.field->bindings();
    draw.textures.insert(draw.textures.end(), textures.begin(), textures.end());
    if (block.hasAlpha) draw.textures.push_back({"uAlpha", drawn.alpha});
    draw.program = &program;
    draw.vertices = 36;
    draw.cull = graph::Cull::Front;
    draw.block = block;
    commands.draw(draw);
}

Status recordSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                     const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                     graph::TextureId target, ivec2 size) {
    const gl::Program* ofFields = fields.empty() ? nullptr : context.program("views/surface");
    const gl::Program* ofSolids = solids.empty() ? nullptr : context.program("views/solid");
    graph.addPass("views.surface", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the first point of " + std::to_string(fields.size() + solids.size()) +
                    " visible object(s) that each pixel meets");
        for (const PosedMesh& solid : solids) {
            pass.sample(solid.positions);
            pass.sample(solid.normals);
        }
        pass.write(target);
        pass.clear(target, vec4(0));
        const bool several = fields.size() > 1 || !solids.empty();
        if (several) pass.clear(pass.createDepth("views.depth", size), 1.0f);
        const auto depthTest = several ? graph::DepthTest::Less : graph::DepthTest::None;
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const DrawnObject& drawn : fields)
                drawField(commands, *ofFields, drawn, eye, size, {.depthTest = depthTest});
            for (const PosedMesh& solid : solids)
                drawMesh(commands, *ofSolids, resources, solid, eye, size, solid.drawn.index,
                         {.depthTest = depthTest});
        };
    });
    return Done{};
}

namespace {

// `quantity`: a switch of views/geometry.frag.
Status recordQuantity(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                      graph::TextureId surface, graph::TextureId target, ivec2 size, const char* quantity,
                      const std::string& reason) {
    const gl::Program* ofFields = context.program("views/geometry", {quantity});
    const gl::Program* ofSolids = context.program("views/geometry", {quantity, "OF_MESHES"});
    graph.addPass("views.geometry", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(reason);
        pass.sample(surface);
        pass.write(target);
        pass.clear(target, vec4(0));
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const DrawnObject& drawn : fields) {
                const GeometryBlock block{.worldFromObject = drawn.object->transform.worldFromObject(),
                                          .eye = vec4(eye.position, 1),
                                          .forward = vec4(eye.forward, 0),
                                          .field = drawn.field->block(drawn.object->field()),
                                          .object = drawn.index};
                auto textures = drawn.field->bindings();
                textures.push_back({"uSurface", resources[surface]});
                commands.draw({.program = ofFields, .block = block, .textures = std::move(textures)});
            }
            if (!solids.empty())
                commands.draw({.program = ofSolids,
                               .block = SolidBlock{viewBlock(eye, size)},
                               .textures = {{"uSurface", resources[surface]}}});
        };
    });
    return Done{};
}

} // namespace

Status recordGeometry(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                      graph::TextureId surface, graph::TextureId target, scene::Aov aov, ivec2 size) {
    return recordQuantity(graph, context, eye, fields, solids, surface, target, size, switchFor(aov),
                          "view.show asks for \"" + std::string(scene::aovNames()[std::size_t(aov)]) + "\"");
}

Status recordSolid(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                   const std::vector<DrawnObject>& fields, const std::vector<PosedMesh>& solids,
                   graph::TextureId surface, graph::TextureId target, ivec2 size) {
    return recordQuantity(graph, context, eye, fields, solids, surface, target, size, "SHOW_SOLID",
                          "opaque surfaces on which rays through refractive objects end");
}

} // namespace lucent::views
