#include "views/Pose.h"

#include "shaders/views/Blocks.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace lucent::views {

using graph::Format;

namespace {

PoseBlock blockOf(const scene::Wave& wave, float time) {
    return {vec4(wave.amplitude, 0),
            vec4(glm::normalize(wave.direction) / wave.wavelength, -std::fmod(time / wave.period, 1.0f))};
}

// Rows filled up to their end.
template <class Texel, class Value>
std::vector<Texel> rowsOf(const std::vector<Value>& values, const Texel& filling,
                          Texel (*texelOf)(const Value&)) {
    const ivec2 size = vertexImageSize(values.size());
    std::vector<Texel> texels(std::size_t(size.x) * std::size_t(size.y), filling);
    std::transform(values.begin(), values.end(), texels.begin(), texelOf);
    return texels;
}

std::vector<vec4> rowsOf(const std::vector<vec3>& values, vec4 filling = vec4(0, 1, 0, 0)) {
    return rowsOf<vec4, vec3>(values, filling, [](const vec3& v) { return vec4(v, 0); });
}

// Whether a target's weight is ever another than 0.
bool isMoved(const scene::Rig& rig, std::size_t target) {
    if (rig.weights[target] != 0) return true;
    return std::any_of(rig.channels.begin(), rig.channels.end(), [&](const scene::Channel& channel) {
        const auto first = std::size_t(channel.firstTarget);
        return channel.path == scene::Channel::Path::Weights && target >= first &&
               target < first + channel.width();
    });
}

} // namespace

ivec2 vertexImageSize(std::size_t vertices) {
    return {kVerticesPerRow, std::max(1, (int(vertices) + kVerticesPerRow - 1) / kVerticesPerRow)};
}

graph::Texture vertexTexture(gl::Device& device, const std::vector<vec3>& values, const char* label) {
    graph::Texture texture(device, {.size = vertexImageSize(values.size()), .format = Format::RGBA32F},
                           label);
    device.upload(texture.handle(), 0, rowsOf(values));
    return texture;
}

PoseTextures::PoseTextures(gl::Device& device, const scene::Mesh& mesh) {
    for (std::size_t i = 0; i < mesh.rig.targets.size(); ++i)
        if (isMoved(mesh.rig, i)) moved_.push_back(i);
    if (!moved_.empty()) makeTargets(device, mesh);
    if (!mesh.joints.empty()) makeJoints(device, mesh);
}

void PoseTextures::makeTargets(gl::Device& device, const scene::Mesh& mesh) {
    const int count = int(moved_.size());
    targets_ = graph::Texture(
        device,
        {.size = vertexImageSize(mesh.positions.size()), .format = Format::RGBA32F, .layers = 2 * count},
        "views.morphTargets");
    weights_ = graph::Texture(device, {.size = {count, 1}, .format = Format::R32F}, "views.morphWeights");
    const std::vector<vec3> unturned(mesh.positions.size(), vec3(0));
    for (int i = 0; i < count; ++i) {
        const scene::MorphTarget& target = mesh.rig.targets[moved_[std::size_t(i)]];
        const std::vector<vec3>& normals = target.normals.empty() ? unturned : target.normals;
        device.upload(targets_.handle(), 0, 2 * i, rowsOf(target.positions, vec4(0)));
        device.upload(targets_.handle(), 0, 2 * i + 1, rowsOf(normals, vec4(0)));
    }
}

void PoseTextures::makeJoints(gl::Device& device, const scene::Mesh& mesh) {
    const ivec2 size = vertexImageSize(mesh.positions.size());
    joints_ = graph::Texture(device, {.size = size, .format = Format::RG32UI}, "views.joints");
    jointWeights_ = graph::Texture(device, {.size = size, .format = Format::RGBA32F}, "views.jointWeights");
    matrices_ = graph::Texture(device, {.size = {4, int(mesh.rig.joints.size())}, .format = Format::RGBA32F},
                               "views.jointMatrices");
    using Four = std::array<std::uint16_t, 4>;
    using Pairs = glm::uvec2;
    device.upload(joints_.handle(), 0, rowsOf<Pairs, Four>(mesh.joints, Pairs(0), [](const Four& j) {
                      return Pairs(j[0] | std::uint32_t(j[1]) << 16, j[2] | std::uint32_t(j[3]) << 16);
                  }));
    device.upload(jointWeights_.handle(), 0,
                  rowsOf<vec4, vec4>(mesh.jointWeights, vec4(1, 0, 0, 0), [](const vec4& w) { return w; }));
}

void PoseTextures::take(gl::Device& device, const scene::Rig& rig, float time) const {
    const scene::Pose pose = scene::poseAt(rig, time);
    if (hasJoints()) device.upload(matrices_.handle(), 0, pose.joints);
    if (!hasTargets()) return;
    std::vector<float> weights;
    for (const std::size_t target : moved_)
        weights.push_back(pose.weights[target]);
    device.upload(weights_.handle(), 0, weights);
}

std::vector<graph::Binding> PoseTextures::bindings() const {
    std::vector<graph::Binding> list;
    if (hasTargets()) list = {{"uTargets", targets_.handle()}, {"uTargetWeights", weights_.handle()}};
    if (hasJoints())
        list.insert(list.end(), {{"uJoints", joints_.handle()},
                                 {"uJointWeights", jointWeights_.handle()},
                                 {"uJointMatrices", matrices_.handle()}});
    return list;
}

std::size_t PoseTextures::bytes() const {
    std::size_t sum = 0;
    for (const graph::Texture* texture : {&targets_, &weights_, &joints_, &jointWeights_, &matrices_})
        if (*texture) sum += texture->desc().bytes();
    return sum;
}

Result<VertexImages> recordMotion(graph::FrameGraph& graph, gl::Context& context, const VertexImages& rest,
                                  const graph::TextureDesc& desc, const PoseTextures* rig,
                                  const scene::Wave* wave, float time, const std::string& name) {
    std::vector<std::string> defines;
    std::string what;
    const auto add = [&](const char* define, const char* mover) {
        defines.push_back(define);
        what += (what.empty() ? "" : ", ") + std::string(mover);
    };
    if (rig && rig->hasTargets()) add("TARGETS", "morph targets");
    if (rig && rig->hasJoints()) add("JOINTS", "joints");
    if (wave) add("WAVE", "a wave");
    const gl::Program* program = context.program("views/pose", defines);
    std::vector<graph::Binding> bindings = rig ? rig->bindings() : std::vector<graph::Binding>{};
    const PoseBlock block = wave ? blockOf(*wave, time) : PoseBlock{};
    VertexImages moved;
    graph.addPass("views.pose", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("object \"" + name + "\" moves: " + what);
        pass.sample(rest.positions);
        pass.sample(rest.normals);
        moved = {pass.createColor("views.posedPositions", desc),
                 pass.createColor("views.posedNormals", desc)};
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            graph::Draw draw{.program = program, .textures = bindings};
            if (wave) draw.block = block;
            draw.textures.push_back({"uPositions", resources[rest.positions]});
            draw.textures.push_back({"uNormals", resources[rest.normals]});
            commands.draw(draw);
        };
    });
    return moved;
}

Result<VertexImages> recordFlat(graph::FrameGraph& graph, gl::Context& context, const VertexImages& moved,
                                const graph::TextureDesc& desc, const std::string& name) {
    const gl::Program* program = context.program("views/pose_flat");
    VertexImages flat = moved;
    graph.addPass("views.poseFlat", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("object \"" + name + "\" moves and has the normals of its triangles");
        pass.sample(moved.positions);
        pass.sample(moved.normals);
        flat.normals = pass.createColor("views.flatNormals", desc);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = program,
                           .textures = {{"uPositions", resources[moved.positions]},
                                        {"uNormals", resources[moved.normals]}}});
        };
    });
    return flat;
}

} // namespace lucent::views
