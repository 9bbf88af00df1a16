#include "views/Meshes.h"

#include "views/FieldTextures.h"

namespace lucent::views {

using graph::Format;

namespace {

bool isWaved(const scene::Object& object) { return object.wave.amplitude != vec3(0); }

// A copy of all its vertices would be the same.
bool hasNoPose(const scene::Mesh& mesh) { return mesh.joints.empty() && mesh.rig.targets.empty(); }

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
    if (hasNoPose(mesh)) return boundsOfPoints(mesh.positions);
    Bounds bounds;
    const int times = mesh.moves() ? kTimes : 1;
    for (int i = 0; i < times; ++i) {
        const scene::Pose pose = scene::poseAt(mesh.rig, mesh.rig.duration * float(i) / float(times));
        const Bounds at = boundsOfPoints(scene::posed(mesh, pose).positions);
        bounds.add(at);
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
    const auto take = [&](const std::vector<vec3>& positions, const std::vector<vec3>& normals) {
        positions_ = vertexTexture(device, positions, "views.positions");
        normals_ = vertexTexture(device, normals, "views.normals");
    };
    if (source_->moves()) {
        take(source_->positions, source_->normals);
        pose_.emplace(device, *source_);
    } else if (hasNoPose(*source_)) {
        scene::Mesh standing; // whose positions need not be copied
        standing.normals = source_->normals;
        take(source_->positions, scene::posed(standing, {}).normals);
    } else {
        const scene::Mesh standing = scene::posed(*source_, scene::poseAt(source_->rig, 0));
        take(standing.positions, standing.normals);
    }
}

void MeshTextures::addTriangles(gl::Context& context) {
    while (addTrianglesPart(context)) {
    }
}

bool MeshTextures::addTrianglesPart(gl::Context& context) {
    if (triangles_) return false;
    if (!making_) making_ = std::make_unique<TriangleMaking>(source_);
    if (std::optional<TriangleTable> table = making_->advance()) {
        triangles_.emplace(context, std::move(*table));
        making_.reset();
    }
    return true;
}

void MeshTextures::addCoordinates(gl::Context& context) {
    if (coordinates_) return;
    coordinates_ = coordinateTexture(context.device(), source_->coordinates, source_->secondCoordinates);
    const std::vector<vec3> white(std::size_t(vertexImageSize(1).x), vec3(1)); // a row
    colors_ =
        vertexTexture(context.device(), source_->colors.empty() ? white : source_->colors, "views.colors");
}

std::size_t MeshTextures::bytes() const {
    return positions_.desc().bytes() + normals_.desc().bytes() + 4 * std::size_t(indices_.count()) +
           (coordinates_ ? coordinates_.desc().bytes() + colors_.desc().bytes() : 0) +
           (pose_ ? pose_->bytes() : 0) + (triangles_ ? triangles_->bytes() : 0);
}

Result<Drawable::Ptr> DrawnMesh::create(const scene::Object& object, int index, ImageCache& images,
                                        const Waters* waters) {
    const auto drawn = std::make_shared<DrawnMesh>(object, index);
    std::shared_ptr<const scene::Mesh> source = meshOf(object);
    if (isPainted(object)) {
        auto atlas = scene::atlasOf(object, object.painting->side());
        if (!atlas) return atlas.error();
        Result<Paint> maps = images.paint(*object.painting, *atlas);
        if (!maps) return maps.error();
        drawn->paint = *maps;
        source = (*atlas)->mesh;
    }
    if (const auto coarse = scene::shadowMeshOf(object); coarse != meshOf(object)) {
        Result<const MeshTextures*> caster = images.mesh(coarse, false);
        if (!caster) return caster.error();
        drawn->caster = *caster;
    }
    Result<const MeshTextures*> textures = images.mesh(source, drawn->isTraced());
    if (!textures) return textures.error();
    drawn->textures = *textures;
    if (const scene::Textures* pictures = texturesOf(object))
        drawn->textured = images.textured(*source, *pictures);
    if (waters) drawn->water = waters->of(index);
    return Ptr(drawn);
}

void DrawnMesh::sampleFrom(graph::PassBuilder& pass) const {
    pass.sample(positions);
    pass.sample(normals);
}

Result<Drawable::Ptr> DrawnMesh::posed(graph::FrameGraph& graph, gl::Context& context, float time,
                                       std::vector<DrawnMesh*>& traced) const {
    const auto images = [&]() -> Result<VertexImages> {
        if (water) return recordWater(graph, context, *water, *object);
        const auto import = [&](const graph::Texture& texture) {
            return graph.import(texture.handle(), texture.desc(), texture.label());
        };
        const VertexImages rest{import(textures->positions()), import(textures->normals())};
        const PoseTextures* pose = textures->pose();
        if (!pose && !isWaved(*object)) return rest;
        if (pose) pose->take(context.device(), textures->source().rig, time);
        const graph::TextureDesc& desc = textures->positions().desc();
        const Result<VertexImages> moved = recordMotion(
            graph, context, rest, desc, pose, isWaved(*object) ? &object->wave : nullptr, time, object->name);
        return moved && isFlat(*object) ? recordFlat(graph, context, *moved, desc, object->name) : moved;
    }();
    if (!images) return images.error();
    const auto standing = std::make_shared<DrawnMesh>(*this);
    standing->positions = images->positions;
    standing->normals = images->normals;
    if (isTraced()) traced.push_back(standing.get());
    return Ptr(standing);
}

namespace {
void setMesh(graph::Draw& draw, const gl::Program& program, const graph::Indices& indices,
             const DrawnMesh& mesh, const Eye& eye, ivec2 size, int number) {
    const scene::Transform& transform = mesh.object->transform;
    draw.program = &program;
    draw.indices = indices.handle();
    draw.vertices = indices.count();
    draw.block = MeshBlock{.clipFromWorld = eye.clipFromWorld,
                           .worldFromObject = transform.worldFromObject(),
                           .normalFromObject = mat4(rotationFromDegrees(transform.rotate)),
                           .view = viewBlock(eye, size),
                           .object = number,
                           .firstCorner = mesh.firstCorner,
                           .normalScale = mesh.textured ? mesh.textured->normalScale : 0,
                           .cutoff = mesh.textured ? mesh.textured->cutoff : 0,
                           .threshold = eye.threshold,
                           .wraps = mesh.textured ? mesh.textured->wraps : vec4(0)};
}

// With its numbered triangles (shaders/views/peel.vert).
void drawTriangles(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
                   const DrawnMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw) {
    setMesh(draw, program, mesh.textures->triangles()->indices(), mesh, eye, size, number);
    draw.textures.push_back({"uCorners", resources[mesh.triangles.corners]});
    commands.draw(draw);
}

// Draws what stands in the light's way in place of a mesh that neither moves nor has holes.
Drawing casterDrawing(const gl::Program* program, const DrawnMesh& drawn, int number) {
    return [=](const graph::Resources&, graph::Commands& commands, const Eye& eye, ivec2 size,
               graph::Draw draw) {
        setMesh(draw, *program, drawn.caster->indices(), drawn, eye, size, number);
        draw.textures.push_back({"uPositions", drawn.caster->positions().handle()});
        draw.textures.push_back({"uNormals", drawn.caster->normals().handle()});
        commands.draw(draw);
    };
}
} // namespace

void drawMesh(graph::Commands& commands, const gl::Program& program, const graph::Resources& resources,
              const DrawnMesh& mesh, const Eye& eye, ivec2 size, int number, graph::Draw draw) {
    setMesh(draw, program, mesh.textures->indices(), mesh, eye, size, number);
    draw.textures.push_back({"uPositions", resources[mesh.positions]});
    draw.textures.push_back({"uNormals", resources[mesh.normals]});
    commands.draw(draw);
}

Drawing DrawnMesh::drawing(gl::Context& context, graph::PassBuilder& pass, ViewKind kind, int number,
                           std::vector<std::string> defines) const {
    constexpr const char* kStems[] = {"views/solid",         "views/shadow",     "views/textured",
                                      "views/optical_depth", "views/peel",       "views/count",
                                      "views/voxel_bounds",  "views/voxel_slice"};
    const bool isTextured = kind == ViewKind::Textured, hasHoles = textured && textured->hasHoles;
    if (isTextured)
        defines.push_back("TEXTURED"); // whose surface image knows the holes
    else if (hasHoles)
        defines.push_back("HOLES");
    const gl::Program* program = context.program(kStems[int(kind)], defines);
    if (kind == ViewKind::Shadow && caster) return casterDrawing(program, *this, number);
    const auto draws = kind == ViewKind::Peel ? drawTriangles : drawMesh;
    if (kind == ViewKind::Peel)
        pass.sample(triangles.corners);
    else
        sampleFrom(pass);
    return [=, drawn = *this](const graph::Resources& resources, graph::Commands& commands, const Eye& eye,
                              ivec2 size, graph::Draw draw) {
        if (isTextured) {
            drawn.textured->bind(draw.textures);
        } else if (hasHoles) {
            draw.textures.push_back({"uCoordinates", drawn.textured->coordinates});
            draw.textures.push_back({"uColor", drawn.textured->color});
        }
        draws(commands, *program, resources, drawn, eye, size, number, std::move(draw));
    };
}

} // namespace lucent::views
