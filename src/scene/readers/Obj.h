#pragma once
/// Wavefront OBJ: positions, normals, texture coordinates, polygons and the little of their materials that
/// means the same here.

#include "base/File.h"
#include "scene/Mesh.h"

namespace lucent::scene {

bool isObj(const std::string& name);
bool isMaterialFile(const std::string& name); ///< of an OBJ

/// Files that an OBJ names for its materials, or a material file for its textures, as it names them.
std::vector<std::string> filesNamedIn(std::span<const std::byte> bytes);

/// Every face; polygons become triangles, faces of one material one part. Normals are the file's, else
/// area-weighted.
///
/// Of materials Kd (as linear colour), Ke, Ni and d or Tr are read: what is dissolved is transmitted. Of
/// textures map_Kd, map_Ke and norm, where nothing is dissolved. A material file or picture that cannot be
/// read, and whatever else is not, is named once on stderr.
///
/// @param read  gives material files and pictures, by paths beside `name`
/// @return      Error "NAME:LINE: what was found; what was expected"
Result<Mesh> readObj(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read);

/// Positions, normals and triangles as OBJ, parts as materials without a file; keeps every bit of the
/// numbers.
Bytes encodeObj(const Mesh& mesh);

} // namespace lucent::scene
