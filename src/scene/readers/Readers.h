#pragma once
/// Readers of foreign files, kept apart so that a page fetches them only when a scene needs one: they turn
/// glTF, OBJ, EXR and TIFF into the plain forms (LUCENTM7, PFM, PNG) that the loader reads.

#include "base/File.h"
#include "base/Image.h"
#include "scene/Mesh.h"

namespace lucent::scene {

/// True for bytes that toPlain() would turn into another form.
bool isForeign(const std::string& name, std::span<const std::byte> bytes);

/// glTF 2.0 (.gltf, .glb) and OBJ become a mesh file, EXR PFM, TIFF 16-bit PNG or PFM, everything else stays
/// as it is.
///
/// @param read  gives the external buffers of a .gltf, the material files of an .obj
/// @return      Error "NAME: what was found; what was expected"
Result<Bytes> toPlain(const std::string& name, Bytes bytes, const ReadFile& read);

/// The name of a file that toPlain() made of another: "a.exr" becomes "a.pfm", "a.glb" "a.mesh"; others keep
/// theirs.
std::string plainName(const std::string& name, std::span<const std::byte> plain);

/// Linear floats as EXR (32-bit float, 1, 3 or 4 channels, ZIP).
Result<Bytes> encodeExr(const Image& image);

/// What native programs load the file `path` with and all that it names: readBeneath() with every foreign
/// file turned into its plain form.
ReadFile plainFiles(const std::string& path, const std::vector<std::string>& allowed = {});

/// A scene, and what reads it and all that it names.
struct SceneSource {
    std::string path; ///< of the scene file; "ARCHIVE.zip/FILE" for one in an archive
    ReadFile read;
};

/// What native programs load the scene `path` with: plainFiles() of a scene file. Of a zip archive the scene
/// in it, whose files lie in it too.
///
/// @return  Error "PATH: what; what was expected" for an archive that cannot be read, or holds no scene
Result<SceneSource> sceneSource(const std::string& path, const std::vector<std::string>& allowed = {});

} // namespace lucent::scene
