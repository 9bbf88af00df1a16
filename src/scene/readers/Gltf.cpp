#include "scene/readers/Gltf.h"

#include "base/Log.h"
#include "scene/Json.h"

#include <fstream> // tinygltf names its types even where it opens no files

#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NOEXCEPTION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>

namespace lucent::scene {
namespace {

using glm::dmat4;

constexpr int kMaxNodeDepth = 128; // deeper means that nodes hold each other

// What tinygltf needs to reach the files beside the scene.
struct Files {
    const std::string& name;
    const ReadFile& read;
    Error error;

    static bool exists(const std::string&, void*) { return true; } // reading tells
    static std::string expand(const std::string& path, void*) { return path; }
    static bool readWhole(std::vector<unsigned char>* out, std::string*, const std::string& path,
                          void* user) {
        auto& files = *static_cast<Files*>(user);
        const Result<Bytes> bytes = files.read(resolvePath(files.name, path));
        if (!bytes) {
            files.error = bytes.error();
            return false;
        }
        const auto* begin = reinterpret_cast<const unsigned char*>(bytes->data());
        out->assign(begin, begin + bytes->size());
        return true;
    }
    static bool write(std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
        return false;
    }
};

// Pictures are of no interest here.
bool skipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int,
               void*) {
    return true;
}

// Element of a list that a file points into; null when it points outside.
template <class T>
const T* element(const std::vector<T>& list, int index) {
    return index >= 0 && std::size_t(index) < list.size() ? &list[std::size_t(index)] : nullptr;
}

// `count` elements of a buffer view, each `stride` bytes apart.
struct View {
    const unsigned char* data = nullptr;
    std::size_t stride = 0;
    const unsigned char* at(std::size_t i) const { return data + i * stride; }
};

// One number of a component type, scaled when it is normalised (glTF 2.0, 3.6.2.2).
double readComponent(const unsigned char* data, int type, bool normalized) {
    const auto read = [&]<class T>(T value) {
        std::memcpy(&value, data, sizeof value);
        return normalized ? std::max(double(value) / double(std::numeric_limits<T>::max()), -1.0)
                          : double(value);
    };
    switch (type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return read(std::int8_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return read(std::uint8_t());
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return read(std::int16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return read(std::uint16_t());
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
        return read(std::uint32_t());
    default:
        break;
    }
    float value;
    std::memcpy(&value, data, sizeof value);
    return value;
}

class GltfReader {
public:
    GltfReader(const tinygltf::Model& model, const std::string& name) : model_(model), name_(name) {}

    Result<Mesh> read() {
        for (const std::string& extension : model_.extensionsRequired)
            if (extension != "KHR_mesh_quantization" && extension.find("material") == extension.npos &&
                extension.find("texture") == extension.npos && extension != "KHR_lights_punctual") {
                fail("needs the extension " + extension + ", which is not read; must do without");
                return error_;
            }
        for (const int root : rootNodes())
            if (!addNode(root, dmat4(1), 0)) return error_;
        if (mesh_.indices.empty()) fail("holds no triangles; must hold at least one");
        if (!error_.message.empty()) return error_;
        return std::move(mesh_);
    }

private:
    bool fail(const std::string& what) {
        error_ = {name_ + ": " + what};
        return false;
    }

    std::vector<int> rootNodes() const {
        if (const auto* scene = element(model_.scenes, std::max(model_.defaultScene, 0))) return scene->nodes;
        std::vector<bool> isChild(model_.nodes.size());
        for (const tinygltf::Node& node : model_.nodes)
            for (const int child : node.children)
                if (element(model_.nodes, child)) isChild[std::size_t(child)] = true;
        std::vector<int> roots;
        for (std::size_t i = 0; i < isChild.size(); ++i)
            if (!isChild[i]) roots.push_back(int(i));
        return roots;
    }

    static dmat4 parentFromNode(const tinygltf::Node& node) {
        if (node.matrix.size() == 16) return glm::make_mat4(node.matrix.data());
        dmat4 matrix(1);
        if (node.translation.size() == 3)
            matrix = glm::translate(matrix, glm::make_vec3(node.translation.data()));
        if (node.rotation.size() == 4) { // x, y, z, w in the file
            const auto& r = node.rotation;
            matrix = matrix * glm::mat4_cast(glm::dquat(r[3], r[0], r[1], r[2]));
        }
        if (node.scale.size() == 3) matrix = glm::scale(matrix, glm::make_vec3(node.scale.data()));
        return matrix;
    }

    bool addNode(int index, const dmat4& parent, int depth) {
        const tinygltf::Node* node = element(model_.nodes, index);
        if (!node) return fail("points to node " + std::to_string(index) + ", which does not exist");
        if (depth > kMaxNodeDepth) return fail("has nodes that hold each other; must form a tree");
        const dmat4 worldFromNode = parent * parentFromNode(*node);
        if (node->skin >= 0) warnOnce(name_ + ": skins are not read; the mesh stands in its rest pose");
        if (node->mesh >= 0) {
            const tinygltf::Mesh* mesh = element(model_.meshes, node->mesh);
            if (!mesh) return fail("points to mesh " + std::to_string(node->mesh) + ", which does not exist");
            for (const tinygltf::Primitive& primitive : mesh->primitives)
                if (!addPrimitive(primitive, worldFromNode)) return false;
        }
        return std::all_of(node->children.begin(), node->children.end(),
                           [&](int child) { return addNode(child, worldFromNode, depth + 1); });
    }

    bool addPrimitive(const tinygltf::Primitive& primitive, const dmat4& worldFromNode) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode < TINYGLTF_MODE_TRIANGLES) {
            warnOnce(name_ + ": points and lines are left out; only triangles have a depth");
            return true;
        }
        if (!primitive.targets.empty())
            warnOnce(name_ + ": morph targets are left out; the mesh keeps its rest shape");
        const auto attribute = primitive.attributes.find("POSITION");
        if (attribute == primitive.attributes.end()) return true; // legal, and draws nothing
        const tinygltf::Accessor* positions = element(model_.accessors, attribute->second);
        if (!positions || positions->type != TINYGLTF_TYPE_VEC3)
            return fail("has positions that are not three numbers each; must be VEC3");
        const std::optional<std::vector<double>> values = readAccessor(*positions, 3);
        if (!values) return false;

        const auto first = std::uint32_t(mesh_.positions.size());
        for (std::size_t i = 0; i + 2 < values->size(); i += 3)
            mesh_.positions.emplace_back(worldFromNode *
                                         glm::dvec4((*values)[i], (*values)[i + 1], (*values)[i + 2], 1));
        std::vector<std::uint32_t> corners;
        if (!readCorners(primitive, positions->count, corners)) return false;
        for (const std::uint32_t corner : corners)
            if (corner >= positions->count)
                return fail("has index " + std::to_string(corner) + " behind its " +
                            std::to_string(positions->count) + " positions; must be smaller");
        addTriangles(mode, corners, first, glm::determinant(worldFromNode) < 0);
        return true;
    }

    bool readCorners(const tinygltf::Primitive& primitive, std::size_t positions,
                     std::vector<std::uint32_t>& corners) {
        if (primitive.indices < 0) {
            for (std::size_t i = 0; i < positions; ++i)
                corners.push_back(std::uint32_t(i));
            return true;
        }
        const tinygltf::Accessor* accessor = element(model_.accessors, primitive.indices);
        if (!accessor || accessor->type != TINYGLTF_TYPE_SCALAR ||
            accessor->componentType == TINYGLTF_COMPONENT_TYPE_FLOAT)
            return fail("has indices that are no whole numbers; must be SCALAR of an unsigned type");
        const std::optional<std::vector<double>> values = readAccessor(*accessor, 1);
        if (!values) return false;
        for (const double value : *values)
            corners.push_back(value < 0 ? ~0u : std::uint32_t(value));
        return true;
    }

    void addTriangles(int mode, const std::vector<std::uint32_t>& c, std::uint32_t first, bool mirrored) {
        const auto add = [&](std::size_t a, std::size_t b, std::size_t d) {
            if (mirrored) std::swap(b, d); // a mirror turns counter-clockwise round
            for (const std::size_t corner : {a, b, d})
                mesh_.indices.push_back(first + c[corner]);
        };
        if (mode == TINYGLTF_MODE_TRIANGLES)
            for (std::size_t i = 0; i + 2 < c.size(); i += 3)
                add(i, i + 1, i + 2);
        else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
            for (std::size_t i = 0; i + 2 < c.size(); ++i)
                add(i, i + 1 + i % 2, i + 2 - i % 2);
        else
            for (std::size_t i = 1; i + 1 < c.size(); ++i)
                add(0, i, i + 1);
    }

    // `count` elements of `bytes` each, checked to lie inside their buffer.
    std::optional<View> view(int index, std::size_t offset, std::size_t count, std::size_t bytes,
                             bool packed) {
        const tinygltf::BufferView* part = element(model_.bufferViews, index);
        const tinygltf::Buffer* buffer = part ? element(model_.buffers, part->buffer) : nullptr;
        if (!buffer) {
            fail("points to a buffer that does not exist");
            return {};
        }
        const std::size_t stride = packed || part->byteStride == 0 ? bytes : part->byteStride;
        const std::size_t size = buffer->data.size();
        const bool inside =
            part->byteOffset <= size && offset <= size - part->byteOffset &&
            (count == 0 || (bytes <= size - part->byteOffset - offset &&
                            (count - 1) <= (size - part->byteOffset - offset - bytes) / stride));
        if (!inside) {
            fail("has a buffer of " + std::to_string(size) +
                 " bytes that is too short for what points into it");
            return {};
        }
        return View{buffer->data.data() + part->byteOffset + offset, stride};
    }

    // All numbers of an accessor, sparse ones put in their places.
    std::optional<std::vector<double>> readAccessor(const tinygltf::Accessor& accessor, int width) {
        const int componentBytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(accessor.componentType));
        if (componentBytes <= 0 || accessor.componentType == TINYGLTF_COMPONENT_TYPE_DOUBLE) {
            fail("has numbers of unknown type " + std::to_string(accessor.componentType));
            return {};
        }
        const std::size_t bytes = std::size_t(componentBytes) * std::size_t(width);
        const auto component = [&](const unsigned char* from, int c) {
            return readComponent(from + c * componentBytes, accessor.componentType, accessor.normalized);
        };
        std::vector<double> values;
        if (accessor.bufferView >= 0) {
            const std::optional<View> dense =
                view(accessor.bufferView, accessor.byteOffset, accessor.count, bytes, false);
            if (!dense) return {};
            values.reserve(accessor.count * std::size_t(width));
            for (std::size_t i = 0; i < accessor.count; ++i)
                for (int c = 0; c < width; ++c)
                    values.push_back(component(dense->at(i), c));
        } else if (accessor.count <= kMaxUnstored) {
            values.resize(accessor.count * std::size_t(width)); // zeros unless sparse values follow
        } else {
            fail("has an accessor of " + std::to_string(accessor.count) + " elements without data");
            return {};
        }
        if (!accessor.sparse.isSparse) return values;

        const auto& sparse = accessor.sparse;
        const int indexBytes = tinygltf::GetComponentSizeInBytes(std::uint32_t(sparse.indices.componentType));
        const std::size_t count = std::size_t(std::max(sparse.count, 0));
        if (indexBytes <= 0) {
            fail("has sparse indices of an unknown type");
            return {};
        }
        const auto places = view(sparse.indices.bufferView, std::size_t(sparse.indices.byteOffset), count,
                                 std::size_t(indexBytes), true);
        const auto news =
            view(sparse.values.bufferView, std::size_t(sparse.values.byteOffset), count, bytes, true);
        if (!places || !news) return {};
        for (std::size_t i = 0; i < count; ++i) {
            const double place = readComponent(places->at(i), sparse.indices.componentType, false);
            if (!(place >= 0 && place < double(accessor.count))) {
                fail("has a sparse index outside its accessor");
                return {};
            }
            for (int c = 0; c < width; ++c)
                values[std::size_t(place) * std::size_t(width) + std::size_t(c)] = component(news->at(i), c);
        }
        return values;
    }

    static constexpr std::size_t kMaxUnstored = std::size_t(1)
                                                << 26; // a number in the file must not eat memory

    const tinygltf::Model& model_;
    const std::string& name_;
    Mesh mesh_;
    Error error_;
};

// First line of tinygltf's messages, without its blanks.
std::string firstLine(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \n");
    if (begin == text.npos) return "cannot be read";
    std::string line = text.substr(begin, text.find('\n', begin) - begin);
    while (!line.empty() && (line.back() == '.' || line.back() == ' '))
        line.pop_back();
    return line;
}

// The JSON text of either kind of file; empty when a binary file is too short to have one.
std::span<const std::byte> jsonOf(std::span<const std::byte> bytes, bool binary) {
    if (!binary) return bytes;
    constexpr std::size_t kHeader = 20; // file: magic, version, length; chunk: length, kind
    std::uint32_t length = 0;
    if (bytes.size() < kHeader) return {};
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return length <= bytes.size() - kHeader ? bytes.subspan(kHeader, length) : std::span<const std::byte>();
}

// tinygltf ends the program on what is refused here.
Status checkJson(const std::string& name, std::span<const std::byte> text) {
    const Result<Json> json = parseJson(text, name);
    if (!json) return json.error();
    const Json* buffers = json->find("buffers");
    for (std::size_t i = 0; buffers && i < buffers->items.size(); ++i) {
        const Json* length = buffers->items[i].find("byteLength");
        if (!length || !(length->number >= 1))
            return Error{name + ": buffers." + std::to_string(i) + ".byteLength is " +
                         (length ? length->describe() : "missing") + "; must be at least 1"};
    }
    return Done{};
}

bool startsWith(std::span<const std::byte> bytes, std::string_view signature) {
    return bytes.size() >= signature.size() &&
           std::memcmp(bytes.data(), signature.data(), signature.size()) == 0;
}

} // namespace

bool isGltf(const std::string& name, std::span<const std::byte> bytes) {
    return startsWith(bytes, "glTF") || name.ends_with(".gltf") || name.ends_with(".GLTF");
}

Result<Mesh> readGltf(const std::string& name, std::span<const std::byte> bytes, const ReadFile& read) {
    const bool binary = startsWith(bytes, "glTF");
    const std::span<const std::byte> json = jsonOf(bytes, binary);
    if (json.empty()) return Error{name + ": the file ends too early; must be a whole glTF 2.0 file"};
    if (Status legal = checkJson(name, json); !legal) return legal.error();

    tinygltf::TinyGLTF loader;
    Files files{name, read, {}};
    loader.SetFsCallbacks({Files::exists, Files::expand, Files::readWhole, Files::write, &files});
    loader.SetImageLoader(skipImage, nullptr);

    tinygltf::Model model;
    std::string error, warning;
    const auto length = unsigned(bytes.size());
    const auto* text = reinterpret_cast<const char*>(bytes.data());
    const bool loaded =
        binary ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                             reinterpret_cast<const unsigned char*>(text), length, "")
               : loader.LoadASCIIFromString(&model, &error, &warning, text, length, "");
    if (!files.error.message.empty()) return Error{name + ": " + files.error.message};
    if (!loaded) return Error{name + ": " + firstLine(error) + "; must be a whole glTF 2.0 file"};
    return GltfReader(model, name).read();
}

} // namespace lucent::scene
