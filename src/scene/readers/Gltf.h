#pragma once
/// Triangles of glTF 2.0 files by tinygltf.

#include "base/File.h"
#include "scene/Mesh.h"

namespace lucent::scene {

bool isGltf(const std::string& name, std::span<const std::byte> bytes);

/// Every triangle of the default scene (of all nodes when there is none) with its normals, flat ones where
/// the file has none, its materials, and how it moves.
///
/// - Lists, strips and fans; all index widths; sparse and quantised numbers.
/// - Where the first animation moves something, every vertex keeps its joints, be it those of a skin or the
/// node
///   that carries it, and its morph targets. Else all stand where nodes, skins and weights put them at rest.
/// - Of textures those of the base colour, metal and roughness, normals and emission (GltfTextures.h).
/// - What is not read (points, lines, cameras, lights, further animations, ...) is named once on stderr.
///
/// @param read  gives external buffers and pictures, by paths beside `name`
/// @return      Error "NAME: what was found; what was expected"
Result<Mesh> readGltf(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read);

} // namespace lucent::scene
