#pragma once
/// Triangles of glTF 2.0 files by tinygltf.

#include "base/File.h"
#include "scene/Mesh.h"

namespace lucent::scene {

bool isGltf(const std::string& name, std::span<const std::byte> bytes);

/// Every triangle of the default scene (of all root nodes when there is none), node transforms applied.
///
/// Lists, strips and fans; all index widths; sparse and quantised positions. Points, lines, skins and morph
/// targets are left out, each named once on stderr.
///
/// @param read  gives external buffers, by paths beside `name`
/// @return      Error "NAME: what was found; what was expected"
Result<Mesh> readGltf(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read);

} // namespace lucent::scene
