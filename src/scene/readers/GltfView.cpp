#include "scene/readers/GltfView.h"

#include "scene/readers/GltfNumbers.h"

#include <algorithm>

namespace lucent::scene {
namespace {

// Nodes look along -z, their up is +y (glTF 2.0, 3.10.2). A node that flattens has no direction: its own
// stays.
vec3 turned(const glm::dmat4& rootFromNode, dvec3 direction) {
    const dvec3 in = glm::dmat3(rootFromNode) * direction;
    const double length = glm::length(in);
    return vec3(length > 0 ? in / length : direction);
}

} // namespace

std::optional<FileLight> lightOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                 const glm::dmat4& rootFromNode) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.Has("light")) return {};
    const tinygltf::Light* from = element(model.lights, found->second.Get("light").GetNumberAsInt());
    if (!from) return {};
    FileLight light{.position = vec3(rootFromNode[3]),
                    .direction = turned(rootFromNode, {0, 0, -1}),
                    .intensity = std::max(float(from->intensity), 0.0f)};
    if (from->type == "spot")
        light.kind = FileLight::Kind::Spot;
    else if (from->type == "directional")
        light.kind = FileLight::Kind::Distant;
    else if (from->type != "point")
        return {};
    if (from->color.size() == 3) light.color = vec3(from->color[0], from->color[1], from->color[2]);
    const auto degrees = [](double radians) { return std::clamp(float(glm::degrees(radians)), 0.0f, 90.0f); };
    light.outerAngle = degrees(from->spot.outerConeAngle);
    light.innerAngle = std::min(degrees(from->spot.innerConeAngle), light.outerAngle);
    return light;
}

std::optional<FileCamera> cameraOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                   const glm::dmat4& rootFromNode) {
    const tinygltf::Camera* from = element(model.cameras, node.camera);
    if (!from) return {};
    FileCamera camera{.perspective = from->type == "perspective",
                      .eye = vec3(rootFromNode[3]),
                      .forward = turned(rootFromNode, {0, 0, -1}),
                      .up = turned(rootFromNode, {0, 1, 0})};
    const auto& orthographic = from->orthographic;
    if (camera.perspective) {
        camera.fov = float(glm::degrees(from->perspective.yfov));
        camera.aspect = float(from->perspective.aspectRatio);
    } else {
        camera.height = float(2 * orthographic.ymag);
        camera.aspect = orthographic.ymag > 0 ? float(orthographic.xmag / orthographic.ymag) : 0;
    }
    const bool isSound = camera.fov > 0 && camera.fov < 180 && camera.height > 0 && camera.aspect >= 0;
    return isSound ? std::optional(camera) : std::nullopt;
}

} // namespace lucent::scene
