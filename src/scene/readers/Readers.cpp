#include "scene/readers/Readers.h"

#include "base/Pfm.h"
#include "scene/readers/Exr.h"
#include "scene/readers/Gltf.h"
#include "scene/readers/Obj.h"
#include "scene/readers/Tiff.h"

#include <cstring>

namespace lucent::scene {

bool isForeign(const std::string& name, std::span<const std::byte> bytes) {
    return isExr(bytes) || isTiff(bytes) || isGltf(name, bytes) || isObj(name);
}

Result<Bytes> toPlain(const std::string& name, Bytes bytes, const ReadFile& read) {
    if (isExr(bytes)) {
        const Result<Image> image = decodeExr(bytes, name);
        if (!image) return image.error();
        return encodePfm(*image);
    }
    if (isTiff(bytes)) return plainTiff(bytes, name);
    if (!isForeign(name, bytes)) return bytes;
    const Result<Mesh> mesh = isObj(name) ? readObj(name, bytes, read) : readGltf(name, bytes, read);
    if (!mesh) return mesh.error();
    return encodeMesh(*mesh);
}

std::string plainName(const std::string& name, std::span<const std::byte> plain) {
    constexpr std::string_view kPng = "\x89PNG";
    const bool isPng = plain.size() > kPng.size() && std::memcmp(plain.data(), kPng.data(), kPng.size()) == 0;
    const std::string ending = isMesh(plain) ? ".mesh" : isPfm(plain) ? ".pfm" : isPng ? ".png" : "";
    return ending.empty() ? name : name.substr(0, name.find_last_of('.')) + ending;
}

} // namespace lucent::scene
