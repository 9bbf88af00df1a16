#pragma once
/// What glTF files show their triangles with: lamps (KHR_lights_punctual) and cameras.

#include "scene/Mesh.h"
#include "scene/readers/TinyGltf.h"

#include <optional>

namespace lucent::scene {

/// The lamp of a node; nothing where it has none, or one of an unknown kind.
std::optional<FileLight> lightOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                 const glm::dmat4& rootFromNode);

/// The camera of a node; nothing where it has none.
std::optional<FileCamera> cameraOf(const tinygltf::Model& model, const tinygltf::Node& node,
                                   const glm::dmat4& rootFromNode);

} // namespace lucent::scene
