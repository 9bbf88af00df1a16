#include "scene/readers/Readers.h"

#include "base/Pfm.h"
#include "scene/readers/Exr.h"
#include "scene/readers/Gltf.h"
#include "scene/readers/Obj.h"

namespace lucent::scene {

bool isForeign(const std::string& name, std::span<const std::byte> bytes) {
    return isExr(bytes) || isGltf(name, bytes) || isObj(name);
}

Result<Bytes> toPlain(const std::string& name, Bytes bytes, const ReadFile& read) {
    if (isExr(bytes)) {
        const Result<Image> image = decodeExr(bytes, name);
        if (!image) return image.error();
        return encodePfm(*image);
    }
    if (!isForeign(name, bytes)) return bytes;
    const Result<Mesh> mesh = isObj(name) ? readObj(name, bytes, read) : readGltf(name, bytes, read);
    if (!mesh) return mesh.error();
    return encodeMesh(*mesh);
}

} // namespace lucent::scene
