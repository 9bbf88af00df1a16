#pragma once
/// glTF files in memory, and meshes as a scene gets them.

#include "scene/Mesh.h"
#include "scene/readers/Readers.h"
#include "tests/base/Png.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <string>

namespace lucent::test {

inline const ReadFile kNoFiles = [](const std::string& path) -> Result<Bytes> {
    return Error{path + ": cannot be read (none)"};
};

template <class T>
void append(Bytes& bytes, std::initializer_list<T> values) {
    for (const T value : values) {
        const auto* begin = reinterpret_cast<const std::byte*>(&value);
        bytes.insert(bytes.end(), begin, begin + sizeof value);
    }
}

/// A unit square in the xy plane: four positions, then six indices of a given width.
template <class Index>
Bytes squareBuffer() {
    Bytes buffer;
    append<float>(buffer, {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    append<Index>(buffer, {0, 1, 2, 0, 2, 3});
    return buffer;
}

/// glTF around a buffer with positions at 0 and indices at 48; `node` and `primitive` are members of theirs.
inline std::string gltf(const Bytes& buffer, int indexType, const std::string& node = "",
                        const std::string& primitive = "",
                        const std::string& uri = R"("uri": "square.bin", )") {
    const std::string size = std::to_string(buffer.size()), rest = std::to_string(buffer.size() - 48);
    return R"({ "asset": { "version": "2.0" }, "scene": 0, "scenes": [ { "nodes": [0] } ],
        "nodes": [ { "mesh": 0)" +
           node + R"( } ],
        "meshes": [ { "primitives": [ { "attributes": { "POSITION": 0 }, "indices": 1)" +
           primitive + R"( } ] } ],
        "accessors": [ { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [0,0,0], "max": [1,1,0] },
                       { "bufferView": 1, "componentType": )" +
           std::to_string(indexType) + R"(, "count": 6, "type": "SCALAR" } ],
        "bufferViews": [ { "buffer": 0, "byteOffset": 0, "byteLength": 48 },
                         { "buffer": 0, "byteOffset": 48, "byteLength": )" +
           rest + R"( } ],
        "buffers": [ { )" +
           uri + R"("byteLength": )" + size + " } ] }";
}

/// The same as one binary file.
inline Bytes glb(const Bytes& buffer, std::string json) {
    while (json.size() % 4)
        json += ' ';
    Bytes bin = buffer;
    while (bin.size() % 4)
        bin.push_back(std::byte(0));
    Bytes file; // "glTF", version 2, length; length of "JSON"
    append<std::uint32_t>(file, {0x46546c67, 2, std::uint32_t(12 + 8 + json.size() + 8 + bin.size()),
                                 std::uint32_t(json.size()), 0x4e4f534a});
    const Bytes text = bytesOf(json);
    file.insert(file.end(), text.begin(), text.end());
    append<std::uint32_t>(file, {std::uint32_t(bin.size()), 0x004e4942});
    file.insert(file.end(), bin.begin(), bin.end());
    return file;
}

inline Bytes squareGlb(const std::string& node = "", const std::string& primitive = "") {
    const Bytes buffer = squareBuffer<std::uint16_t>();
    return glb(buffer, gltf(buffer, 5123, node, primitive, ""));
}

/// The mesh, or the message in `error`.
inline scene::Mesh read(const Bytes& file, std::string& error, const std::string& name = "m/a.gltf",
                        const ReadFile& files = kNoFiles) {
    const Result<Bytes> plain = scene::toPlain(name, file, files);
    const auto mesh = plain ? scene::decodeMesh(*plain, name) : Result<scene::Mesh>(plain.error());
    error = mesh ? "" : mesh.error().message;
    return mesh ? *mesh : scene::Mesh();
}

} // namespace lucent::test
