#include "views/Paint.h"

#include "views/Meshes.h"
#include "views/Textured.h"

#include <algorithm>
#include <span>
#include <string>

namespace lucent::views {

using graph::Format;

bool isPainted(const scene::Object& object) { return object.painting && object.material.isScattering(); }

PaintMap::PaintMap(gl::Device& device, std::shared_ptr<const Image> map)
    : source_(std::move(map)),
      texture_(device, {.size = source_->size(), .format = Format::RGBA32F}, "views.paint"),
      least_(source_->pixels[3]), most_(source_->pixels[3]) {}

bool PaintMap::takePart(gl::Device& device) {
    constexpr int kTexels = 1 << 16; // at once
    const ivec2 size = source_->size();
    if (rows_ == size.y) return false;
    const int count = std::min(std::max(1, kTexels / size.x), size.y - rows_);
    const std::size_t perRow = std::size_t(size.x) * 4;
    const std::span<const float> part(&source_->pixels[std::size_t(rows_) * perRow],
                                      std::size_t(count) * perRow);
    device.upload(texture_.handle(), 0, 0, std::as_bytes(part), rows_);
    for (std::size_t i = 3; i < part.size(); i += 4) {
        least_ = std::min(least_, part[i]);
        most_ = std::max(most_, part[i]);
    }
    rows_ += count;
    return true;
}

graph::Texture placeTexture(gl::Device& device, const scene::Atlas& atlas) {
    return coordinateTexture(device, atlas.places);
}

std::vector<graph::Binding> enteringBindings(const Paint& paint) {
    return {{"uPlaces", paint.places}, {"uEntering", paint.entering}, {"uLeaving", paint.leaving}};
}

namespace {

// What of a painting: that of light which enters, the map of that alone, or what leaves.
enum class Part { Entering, EnteringMap, Leaving };

// What is painted on the nearest of the meshes in each pixel. A surface image that shows one of them shows
// its nearest place, which no other of them hides: depths need no comparison with those of the image.
Result<graph::TextureId> recordPaint(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                     const std::vector<DrawnMesh>& meshes, ivec2 size, Part part) {
    std::vector<std::string> defines{"PAINTED"};
    if (part == Part::Entering) defines.push_back("ENTERING");
    if (part == Part::EnteringMap) defines.push_back("ENTERING_MAP");
    const bool leaves = part == Part::Leaving;
    const gl::Program* program = context.program("views/paint", defines);
    graph::TextureId target;
    graph.addPass("views.paint", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason(part == Part::Entering
                        ? "what is painted where light enters object \"" + meshes.front().object->name + "\""
                        : "what is painted where the camera sees " + std::to_string(meshes.size()) +
                              " object(s)");
        for (const DrawnMesh& mesh : meshes)
            mesh.sampleFrom(pass);
        target = pass.createColor(leaves ? "views.paintLeaving" : "views.paintEntering",
                                  {.size = size, .format = Format::RGBA32F});
        pass.clear(target, vec4(1));
        pass.clear(pass.createDepth("views.depth", size), 1.0f);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const DrawnMesh& mesh : meshes) {
                const Paint& paint = *mesh.paint;
                graph::Draw draw{.depthTest = graph::DepthTest::Less};
                draw.textures = {{"uPlaces", paint.places}};
                if (part != Part::Leaving) draw.textures.push_back({"uEntering", paint.entering});
                if (part != Part::EnteringMap) draw.textures.push_back({"uLeaving", paint.leaving});
                drawMesh(commands, *program, resources, mesh, eye, size, mesh.index, std::move(draw));
            }
        };
    });
    return target;
}

} // namespace

Result<graph::TextureId> recordEntering(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                        const DrawnMesh& mesh, ivec2 size) {
    return recordPaint(graph, context, eye, {mesh}, size, Part::Entering);
}

Result<graph::TextureId> recordEnteringMap(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                           const std::vector<DrawnMesh>& meshes, ivec2 size) {
    return recordPaint(graph, context, eye, meshes, size, Part::EnteringMap);
}

Result<graph::TextureId> recordLeaving(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                       const std::vector<DrawnMesh>& meshes, ivec2 size) {
    return recordPaint(graph, context, eye, meshes, size, Part::Leaving);
}

} // namespace lucent::views
