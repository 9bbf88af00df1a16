#pragma once
/// Files that a person brings become a scene of their own: framed, lit and exposed by their own bounds.
///
/// The scene is an ordinary scene file with the files it names, so that whoever shows, keeps or writes it
/// does as with any other. Its title is that of the files, its caption empty. Exposure follows from the light
/// that is known to arrive: what is opaque and as bright as the scene's brightest colour ends at kBrightest
/// where it faces the lamp and the sky, so that nothing is clipped but highlights and caustics may be.

#include "base/Output.h"
#include "scene/MapUse.h"

#include <span>
#include <string>
#include <vector>

namespace lucent::scene {

/// The scene file first, then every file that it names; paths without folders.
using Brought = std::vector<Output>;

inline constexpr float kBrightest = 0.95f; ///< of what can be shown, linear

/// A picture of a set; bytes as decodeImage() reads them.
struct MapFile {
    MapUse use;
    std::string name;
    Bytes bytes;
};

/// What each of some pictures is for: as its name says, else normals where it holds them. Where that leaves
/// one picture and no heights, it is the heights unless it holds colours; nothing stands for those that a
/// person must be asked about.
std::vector<std::optional<MapUse>> usesOf(std::span<const Output> pictures);

/// A relief, 1 m along its longer side, seen from straight above and raked by a lamp at the upper left.
///
/// Heights outside [0,1], such as metres, become a tenth of its longer side. Normals become heights by least
/// squares, in a file of their own with their true slopes, whichever way their green points; beside heights
/// they are left out, which is said once on stderr.
/// @param maps  one of heights or normals, at most one of each use
/// @return      Error "NAME: what was found; what was expected"
Result<Brought> sceneOfMaps(std::span<const MapFile> maps);

/// A model on a ground, under a lamp at the left and a sky, seen from above the front by a perspective
/// camera, so that the box around it just fits as it stands at time 0. Where its file has lamps or a camera
/// these take their places; the sky then shines as much beside them as it does beside the lamp.
///
/// @param bytes  of a mesh in the plain form (Mesh.h), whose name ends in .mesh or becomes so
/// @return       Error "NAME: ..." for what is no mesh, or has no extent
Result<Brought> sceneOfMesh(const std::string& name, std::span<const std::byte> bytes);

/// A ball of a measured material on a ground, under the same light.
///
/// @param bytes  of a file in the format of the MERL database
/// @return       Error "NAME: ..." for what is none
Result<Brought> sceneOfTable(const std::string& name, std::span<const std::byte> bytes);

} // namespace lucent::scene
