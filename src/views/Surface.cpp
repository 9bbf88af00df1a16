#include "views/Surface.h"

#include <cstddef>

namespace lucent::views {

namespace {

struct SurfaceBlock {
    mat4 clipFromObject, objectFromPixel;
    vec4 eye;
    FieldBlock field;
    vec2 size;
    int object, hasAlpha;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = fieldMembers(offsetof(SurfaceBlock, field));
            list.insert(list.end(), {{"clipFromObject", offsetof(SurfaceBlock, clipFromObject)},
                                     {"objectFromPixel", offsetof(SurfaceBlock, objectFromPixel)},
                                     {"size", offsetof(SurfaceBlock, size)},
                                     {"eye", offsetof(SurfaceBlock, eye)},
                                     {"object", offsetof(SurfaceBlock, object)},
                                     {"hasAlpha", offsetof(SurfaceBlock, hasAlpha)}});
            return list;
        }();
        static const graph::BlockLayout layout{"SurfaceBlock", sizeof(SurfaceBlock), members};
        return layout;
    }
};

struct GeometryBlock {
    mat4 worldFromObject;
    vec4 eye, forward;
    FieldBlock field;
    int object;
    int padding[3] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = fieldMembers(offsetof(GeometryBlock, field));
            list.insert(list.end(), {{"worldFromObject", offsetof(GeometryBlock, worldFromObject)},
                                     {"eye", offsetof(GeometryBlock, eye)},
                                     {"forward", offsetof(GeometryBlock, forward)},
                                     {"object", offsetof(GeometryBlock, object)}});
            return list;
        }();
        static const graph::BlockLayout layout{"GeometryBlock", sizeof(GeometryBlock), members};
        return layout;
    }
};

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

Result<std::vector<DrawnObject>> drawnObjects(const scene::Scene& scene, ImageCache& images) {
    std::vector<DrawnObject> drawn;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if (!object.visible) continue;
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

Status recordSurface(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                     const std::vector<DrawnObject>& objects, graph::TextureId target, ivec2 size) {
    Result<const gl::Program*> program = context.program("views/surface");
    if (!program) return program.error();
    graph.addPass("views.surface", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("the first point of " + std::to_string(objects.size()) +
                    " visible object(s) that each pixel meets");
        pass.write(target);
        if (objects.size() > 1) pass.createDepth("views.depth", size);
        pass.clear(vec4(0));
        return [=, program = *program](const graph::Resources&, graph::Commands& commands) {
            const auto clipFromPixel = glm::scale(glm::dmat4(1), glm::dvec3(2.0 / size.x, 2.0 / size.y, 1));
            for (const DrawnObject& drawn : objects) {
                const mat4 worldFromObject = drawn.object->transform.worldFromObject();
                const mat4 clipFromObject = eye.clipFromWorld * worldFromObject;
                const SurfaceBlock block{.clipFromObject = clipFromObject,
                                         .objectFromPixel =
                                             mat4(glm::inverse(glm::dmat4(clipFromObject)) * clipFromPixel),
                                         .eye = eye.inObject(worldFromObject),
                                         .field = drawn.field->block(drawn.object->field()),
                                         .size = vec2(size),
                                         .object = drawn.index,
                                         .hasAlpha = drawn.alpha != graph::TextureHandle::None};
                auto textures = drawn.field->bindings();
                if (block.hasAlpha) textures.push_back({"uAlpha", drawn.alpha});
                commands.draw({.program = program,
                               .vertices = 36,
                               .cullFront = true,
                               .depthTest = objects.size() > 1,
                               .block = block,
                               .textures = std::move(textures)});
            }
        };
    });
    return Done{};
}

Status recordGeometry(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                      const std::vector<DrawnObject>& objects, graph::TextureId surface,
                      graph::TextureId target, scene::Aov aov) {
    Result<const gl::Program*> program = context.program("views/geometry", {switchFor(aov)});
    if (!program) return program.error();
    graph.addPass("views.geometry", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("view.show asks for \"" + std::string(scene::aovNames()[std::size_t(aov)]) + "\"");
        pass.sample(surface);
        pass.write(target);
        pass.clear(vec4(0));
        return [=, program = *program](const graph::Resources& resources, graph::Commands& commands) {
            for (const DrawnObject& drawn : objects) {
                const GeometryBlock block{.worldFromObject = drawn.object->transform.worldFromObject(),
                                          .eye = vec4(eye.position, 1),
                                          .forward = vec4(eye.forward, 0),
                                          .field = drawn.field->block(drawn.object->field()),
                                          .object = drawn.index};
                auto textures = drawn.field->bindings();
                textures.push_back({"uSurface", resources[surface]});
                commands.draw({.program = program, .block = block, .textures = std::move(textures)});
            }
        };
    });
    return Done{};
}

} // namespace lucent::views
