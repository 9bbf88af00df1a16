#include "views/Meshes.h"

#include "views/FieldTextures.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>

namespace lucent::views {

using graph::Format;

namespace {

bool isWaved(const scene::Object& object) { return object.wave.amplitude != vec3(0); }

Bounds boundsOfPoints(const std::vector<vec3>& points) {
    Bounds bounds;
    for (const vec3& point : points)
        bounds.add(point);
    return bounds;
}

bool isFlat(const scene::Object& object) {
    const auto* file = std::get_if<scene::MeshShape>(&object.shape);
    return file && file->flatNormals;
}

} // namespace

Bounds meshBounds(const scene::Mesh& mesh) {
    constexpr int kTimes = 16;
    Bounds bounds;
    const int times = mesh.moves() ? kTimes : 1;
    for (int i = 0; i < times; ++i) {
        const scene::Pose pose = scene::poseAt(mesh.rig, mesh.rig.duration * float(i) / float(times));
        const Bounds at = boundsOfPoints(scene::posed(mesh, pose).positions);
        bounds.add(at.low);
        bounds.add(at.high);
    }
    if (times > 1) { // between those times it may swing out a little farther
        const vec3 margin = 0.1f * (bounds.high - bounds.low);
        bounds = {bounds.low - margin, bounds.high + margin};
    }
    return bounds;
}

MeshTextures::MeshTextures(gl::Context& context, std::shared_ptr<const scene::Mesh> mesh)
    : source_(std::move(mesh)), indices_(context.device(), source_->indices, "views.indices") {
    gl::Device& device = context.device();
    const auto take = [&](const scene::Mesh& bound) {
        positions_ = vertexTexture(device, bound.positions, "views.positions");
        normals_ = vertexTexture(device, bound.normals, "views.normals");
    };
    if (source_->moves()) {
        take(*source_);
        pose_.emplace(device, *source_);
    } else {
        take(scene::posed(*source_, scene::poseAt(source_->rig, 0)));
    }
}

void MeshTextures::addTriangles(gl::Context& context) {
    if (!triangles_) triangles_.emplace(context, *source_);
}

std::size_t MeshTextures::bytes() const {
    return positions_.desc().bytes() + normals_.desc().bytes() + 4 * std::size_t(indices_.count()) +
           (pose_ ? pose_->bytes() : 0) + (triangles_ ? triangles_->bytes() : 0);
}

Result<DrawnMeshes> drawnMeshes(const scene::Scene& scene, ImageCache& images, bool hiddenToo,
                                const Waters* waters) {
    DrawnMeshes drawn;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if (object.isField() || !(object.visible || hiddenToo)) continue;
        std::shared_ptr<const scene::Mesh> source = meshOf(object);
        std::optional<Paint> paint;
        if (isPainted(object)) {
            auto atlas = scene::atlasOf(object, object.painting->side());
            if (!atlas) return atlas.error();
            Result<Paint> maps = images.paint(*object.painting, *atlas);
            if (!maps) return maps.error();
            paint = *maps;
            source = (*atlas)->mesh;
        }
        Result<const MeshTextures*> mesh = images.mesh(source, object.material.isRefractive());
        if (!mesh) return mesh.error();
        (object.material.isRefractive() ? drawn.glass : drawn.solid)
            .push_back({&object, int(i), *mesh, waters ? waters->of(int(i)) : nullptr, paint});
    }
    return drawn;
}

Result<std::vector<PosedMesh>> recordPose(graph::FrameGraph& graph, gl::Context& context,
                                          const std::vector<DrawnMesh>& meshes, float time,
                                          KeptTriangles* kept) {
    const auto imagesOf = [&](const DrawnMesh& drawn) -> Result<VertexImages> {
        const scene::Object& object = *drawn.object;
        if (drawn.water) return recordWater(graph, context, *drawn.water, object.name);
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), texture.desc(), texture.label());
        };
        const VertexImages rest{import(drawn.mesh->positions()), import(drawn.mesh->normals())};
        const PoseTextures* pose = drawn.mesh->pose();
        if (!pose && !isWaved(object)) return rest;
        if (pose) pose->take(context.device(), drawn.mesh->source().rig, time);
        const graph::TextureDesc& desc = drawn.mesh->positions().desc();
        const Result<VertexImages> moved = recordMotion(
            graph, context, rest, desc, pose, isWaved(object) ? &object.wave : nullptr, time, object.name);
        return moved && isFlat(object) ? recordFlat(graph, context, *moved, desc, object.name) : moved;
    };
    std::vector<PosedMesh> posed;
    for (const DrawnMesh& drawn : meshes) {
        Result<VertexImages> images = imagesOf(drawn);
        if (!images) return images.error();
        posed.push_back({drawn, images->positions, images->normals});
    }
    if (Status s = recordTriangles(graph, context, posed, kept); !s) return s.error();
    return posed;
}

namespace {
void setMesh(graph::Draw& draw, const gl::Program& program, const graph::Indices& indices,
             const PosedMesh& mesh, const Eye& eye, ivec2 size, int number) {
    const scene::Transform& transform = mesh.drawn.object->transform;
    draw.program = &program;
    draw.indices = indices.handle();
    draw.vertices = indices.count();
    draw.block = MeshBlock{.clipFromWorld = eye.clipFromWorld,
                           .worldFromObject = transform.worldFromObject(),
                           .normalFromObject = mat4(rotationFromDegrees(transform.rotate)),
                           .view = viewBlock(eye, size),
                           .object = number,
                           .firstCorner = mesh.firstCorner};
}
} // namespace

void drawMesh(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
              const PosedMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw) {
    setMesh(draw, program, mesh.drawn.mesh->indices(), mesh, eye, size, number);
    draw.textures.push_back({"uPositions", resources[mesh.positions]});
    draw.textures.push_back({"uNormals", resources[mesh.normals]});
    commands.draw(draw);
}

void drawTriangles(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
                   const PosedMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw) {
    setMesh(draw, program, mesh.drawn.mesh->triangles()->indices(), mesh, eye, size, number);
    draw.textures.push_back({"uCorners", resources[mesh.triangles.corners]});
    commands.draw(draw);
}

Bounds boundsOfAll(const std::vector<DrawnMesh>& meshes) {
    Bounds all;
    for (const DrawnMesh& mesh : meshes) {
        const Bounds one = boundsOf(*mesh.object);
        all.add(one.low);
        all.add(one.high);
    }
    return all;
}

Bounds boundsOfAll(const std::vector<PosedMesh>& meshes) {
    std::vector<DrawnMesh> drawn;
    std::transform(meshes.begin(), meshes.end(), std::back_inserter(drawn),
                   [](const PosedMesh& mesh) { return mesh.drawn; });
    return boundsOfAll(drawn);
}

} // namespace lucent::views
