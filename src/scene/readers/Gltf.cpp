#include "scene/readers/Gltf.h"

#include "base/Log.h"
#include "scene/Json.h"
#include "scene/readers/GltfMaterial.h"
#include "scene/readers/GltfNumbers.h"
#include "scene/readers/GltfTextures.h"
#include "scene/readers/GltfView.h"
#include "scene/readers/TinyGltf.h"

#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace lucent::scene {
namespace {

using glm::dmat4;

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

// Pictures are decoded once it is known what for: until then they stay as the file has them.
bool keepImage(tinygltf::Image* image, const int, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void*) {
    image->image.assign(bytes, bytes + size);
    return true;
}

dmat4 parentFromNode(const tinygltf::Node& node) {
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

// A matrix as scale, turn and move; nothing when it slants or flattens.
std::optional<Node> decompose(const dmat4& matrix) {
    glm::dmat3 axes(matrix);
    dvec3 scale(glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2]));
    if (glm::determinant(axes) < 0) scale.x = -scale.x;
    for (int i = 0; i < 3; ++i) {
        if (scale[i] == 0) return {};
        axes[i] /= scale[i];
    }
    constexpr double kRight = 1e-4; // matrices are stored with about 6 digits
    for (int i = 0; i < 3; ++i)
        if (std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) > kRight) return {};
    return Node{-1, vec3(matrix[3]), glm::quat(glm::normalize(glm::quat_cast(axes))), vec3(scale)};
}

std::vector<vec3> toVectors(const std::vector<double>& numbers) {
    std::vector<vec3> vectors;
    vectors.reserve(numbers.size() / 3);
    for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
        vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
    return vectors;
}

template <class T>
void append(std::vector<T>& list, const std::vector<T>& more) {
    list.insert(list.end(), more.begin(), more.end());
}

std::string listed(const std::set<std::string>& words) {
    std::string text;
    for (const std::string& word : words)
        text += (text.empty() ? "" : ", ") + word;
    return text;
}

/// Tells what has the same name apart: a, a', a'3, a'4, ...
class UniqueNames {
public:
    std::string unique(const std::string& name) {
        std::string given = name;
        for (int& count = counts_[name]; !taken_.insert(given).second;)
            given = name + "'" + (++count > 1 ? std::to_string(count + 1) : "");
        return given;
    }

private:
    std::set<std::string> taken_;
    std::map<std::string, int> counts_; // of names given again
};

/// Puts a file together in three steps: the tree of nodes, what of it moves, and the triangles. Of a file in
/// which nothing moves all triangles stand in the pose of rest, and there is no rig.
class GltfReader {
public:
    GltfReader(const tinygltf::Model& model, const std::string& name, const ReadFile& read)
        : model_(model), name_(name), textures_(model, name, read, unread_) {}

    Result<Mesh> read() {
        if (!(checkExtensions() && readTree() && findUse() && readAnimation() && addMeshes() && finishRig()))
            return error_;
        if (mesh_.positions.empty() || !finishParts())
            return Error{name_ + ": holds no triangles; must hold at least one"};
        addView();
        if (!unread_.empty()) warnOnce(name_ + ": not read: " + listed(unread_));
        return std::move(mesh_);
    }

private:
    // Of the file's nodes, in its order.
    struct Place {
        int parent = -1;
        int inRig = -1; ///< place in Rig::nodes; -1: no root leads here
        dmat4 rootFromNode{1};
        bool inScene = false;
        bool isUsed = false; ///< it, or a node below, carries triangles
        int firstTarget = 0; ///< of its morph targets in Rig::targets
        std::size_t targets = 0;
        int firstJoint = -1; ///< where its triangles have it as their only joint
    };

    bool fail(const std::string& what) {
        error_ = {name_ + ": " + what};
        return false;
    }
    template <class T>
    bool pass(const Result<T>& result) {
        if (!result) error_ = result.error();
        return bool(result);
    }
    Place& at(int node) { return places_[std::size_t(node)]; }
    const tinygltf::Node& node(int index) const { return model_.nodes[std::size_t(index)]; }

    bool checkExtensions() {
        for (const std::string& extension : model_.extensionsRequired)
            if (extension != "KHR_mesh_quantization" && extension.find("material") == extension.npos &&
                extension.find("texture") == extension.npos && extension != "KHR_lights_punctual")
                return fail("needs the extension " + extension + ", which is not read; must do without");
        const auto known = knownGltfExtensions();
        for (const std::string& extension : model_.extensionsUsed)
            if (std::find(known.begin(), known.end(), extension) == known.end()) unread_.insert(extension);
        return true;
    }

    // Parents come before their children; places_ of both say how they stand.
    bool readTree() {
        places_.resize(model_.nodes.size());
        for (std::size_t i = 0; i < model_.nodes.size(); ++i)
            for (const int child : model_.nodes[i].children) {
                if (!element(model_.nodes, child))
                    return fail("points to node " + std::to_string(child) + ", which does not exist");
                if (at(child).parent >= 0)
                    return fail("has node " + std::to_string(child) + " below two others; must form a tree");
                at(child).parent = int(i);
            }
        std::vector<int> waiting;
        for (int i = int(places_.size()) - 1; i >= 0; --i)
            if (at(i).parent < 0) waiting.push_back(i);
        while (!waiting.empty()) {
            const int index = waiting.back();
            waiting.pop_back();
            Place& place = at(index);
            place.inRig = int(order_.size());
            order_.push_back(index);
            place.rootFromNode = parentFromNode(node(index));
            if (place.parent >= 0) place.rootFromNode = at(place.parent).rootFromNode * place.rootFromNode;
            waiting.insert(waiting.end(), node(index).children.rbegin(), node(index).children.rend());
        }
        if (order_.size() != places_.size()) return fail("has nodes that hold each other; must form a tree");
        return true;
    }

    // What the default scene shows, or all when there is none, and the nodes on which its place depends.
    bool findUse() {
        const auto* scene = element(model_.scenes, std::max(model_.defaultScene, 0));
        for (const int root : scene ? scene->nodes : std::vector<int>()) {
            if (!element(model_.nodes, root))
                return fail("points to node " + std::to_string(root) + ", which does not exist");
            at(root).inScene = true;
        }
        for (const int index : order_) {
            Place& place = at(index);
            place.inScene = place.inScene || !scene || (place.parent >= 0 && at(place.parent).inScene);
            if (!place.inScene || node(index).mesh < 0) continue;
            if (!element(model_.meshes, node(index).mesh))
                return fail("points to mesh " + std::to_string(node(index).mesh) + ", which does not exist");
            markUsed(index);
            if (node(index).skin < 0) continue;
            const tinygltf::Skin* skin = element(model_.skins, node(index).skin);
            if (!skin || skin->joints.empty())
                return fail("points to skin " + std::to_string(node(index).skin) +
                            ", which does not exist or has no joints");
            for (const int joint : skin->joints) {
                if (!element(model_.nodes, joint))
                    return fail("points to node " + std::to_string(joint) + ", which does not exist");
                markUsed(joint);
            }
        }
        return true;
    }

    void markUsed(int index) {
        for (; index >= 0 && !at(index).isUsed; index = at(index).parent)
            at(index).isUsed = true;
    }

    // The channels of the first animation that move something; their nodes still count in the file's list.
    bool readAnimation() {
        std::set<std::string> others;
        for (std::size_t i = 1; i < model_.animations.size(); ++i)
            others.insert(model_.animations[i].name.empty() ? std::to_string(i)
                                                            : "\"" + model_.animations[i].name + "\"");
        if (!others.empty()) unread_.insert("animations behind the first (" + listed(others) + ")");
        if (model_.animations.empty()) return true;
        const tinygltf::Animation& animation = model_.animations.front();
        for (const tinygltf::AnimationChannel& from : animation.channels) {
            if (from.target_node < 0 || from.target_path == "pointer") {
                unread_.insert("animations of properties");
                continue;
            }
            if (!element(model_.nodes, from.target_node))
                return fail("points to node " + std::to_string(from.target_node) + ", which does not exist");
            const tinygltf::AnimationSampler* sampler = element(animation.samplers, from.sampler);
            if (!sampler)
                return fail("points to sampler " + std::to_string(from.sampler) + ", which does not exist");
            if (at(from.target_node).isUsed && !addChannel(from, *sampler)) return false;
        }
        if (!mesh_.rig.channels.empty() && mesh_.rig.duration == 0) {
            mesh_.rig.channels.clear();
            unread_.insert("an animation that takes no time");
        }
        return true;
    }

    bool addChannel(const tinygltf::AnimationChannel& from, const tinygltf::AnimationSampler& sampler) {
        using Path = Channel::Path;
        using Interpolation = Channel::Interpolation;
        static const std::map<std::string, Path> kPaths = {{"translation", Path::Translation},
                                                           {"rotation", Path::Rotation},
                                                           {"scale", Path::Scale},
                                                           {"weights", Path::Weights}};
        static const std::map<std::string, Interpolation> kInterpolations = {
            {"", Interpolation::Linear},
            {"LINEAR", Interpolation::Linear},
            {"STEP", Interpolation::Step},
            {"CUBICSPLINE", Interpolation::CubicSpline}};
        const auto path = kPaths.find(from.target_path);
        const auto interpolation = kInterpolations.find(sampler.interpolation);
        if (path == kPaths.end() || interpolation == kInterpolations.end())
            return fail("animates \"" + from.target_path + "\" by \"" + sampler.interpolation +
                        "\"; must be translation, rotation, scale or weights by LINEAR, STEP or CUBICSPLINE");
        Channel channel;
        channel.node = from.target_node;
        channel.path = path->second;
        channel.interpolation = interpolation->second;
        const Result<std::vector<double>> times =
            readNumbers(model_, sampler.input, TINYGLTF_TYPE_SCALAR, "times of an animation", name_);
        if (!pass(times)) return false;
        channel.times.assign(times->begin(), times->end());
        const int type = channel.path == Path::Rotation  ? TINYGLTF_TYPE_VEC4
                         : channel.path == Path::Weights ? TINYGLTF_TYPE_SCALAR
                                                         : TINYGLTF_TYPE_VEC3;
        const Result<std::vector<double>> values =
            readNumbers(model_, sampler.output, type, "values of an animation", name_);
        if (!pass(values)) return false;
        channel.values.assign(values->begin(), values->end());
        if ((animated_ += channel.values.size() + channel.times.size()) > kMostVertices)
            return fail("has more than " + std::to_string(kMostVertices) +
                        " numbers in its animation; must have fewer");
        if (channel.times.empty()) return fail("has an animation without times; must have one or more");
        mesh_.rig.duration =
            std::max(mesh_.rig.duration, *std::max_element(channel.times.begin(), channel.times.end()));
        mesh_.rig.channels.push_back(std::move(channel));
        return true;
    }

    bool moves() const { return !mesh_.rig.channels.empty(); }

    // One mesh may hang on many nodes, so that a small file can mean a large scene: counted before memory is
    // taken.
    bool checkAmount() {
        std::size_t vertices = 0, corners = 0;
        const auto countOf = [&](int accessor) {
            const tinygltf::Accessor* found = element(model_.accessors, accessor);
            return found ? found->count : 0; // others are refused when they are read
        };
        for (const int index : order_) {
            if (!at(index).inScene || node(index).mesh < 0) continue;
            for (const tinygltf::Primitive& primitive :
                 model_.meshes[std::size_t(node(index).mesh)].primitives) {
                const auto positions = primitive.attributes.find("POSITION");
                if (positions == primitive.attributes.end()) continue;
                const std::size_t count = countOf(positions->second);
                const std::size_t around = primitive.indices < 0 ? count : countOf(primitive.indices);
                // With flat normals every corner of a triangle may be a vertex.
                const bool flat = !primitive.attributes.contains("NORMAL");
                const bool strip = primitive.mode > TINYGLTF_MODE_TRIANGLES; // or fan
                vertices += flat ? std::max(count, (strip ? 3 : 1) * around) : count;
                corners += around;
                if (vertices <= kMostVertices && corners <= kMostCorners) continue;
                return fail("has more than " + std::to_string(kMostVertices) + " vertices or " +
                            std::to_string(kMostCorners) +
                            " corners of triangles where its nodes put them; must "
                            "have fewer");
            }
        }
        return true;
    }

    bool addMeshes() {
        if (!checkAmount()) return false;
        for (const int index : order_) {
            if (!at(index).inScene || node(index).mesh < 0) continue;
            const tinygltf::Mesh& mesh = model_.meshes[std::size_t(node(index).mesh)];
            if (!addTargets(index, mesh)) return false;
            for (const tinygltf::Primitive& primitive : mesh.primitives)
                if (!addPrimitive(primitive, index)) return false;
        }
        if (!moves()) return true;
        for (MorphTarget& target : mesh_.rig.targets) { // vertices behind the last that a target moves
            target.positions.resize(mesh_.positions.size(), vec3(0));
            target.normals.resize(mesh_.positions.size(), vec3(0));
        }
        return true;
    }

    // Room for the targets of one node's mesh, at the weights of rest.
    bool addTargets(int index, const tinygltf::Mesh& mesh) {
        const std::size_t count = mesh.primitives.empty() ? 0 : mesh.primitives.front().targets.size();
        for (const tinygltf::Primitive& primitive : mesh.primitives)
            if (primitive.targets.size() != count)
                return fail("has a mesh whose primitives have " + std::to_string(count) + " and " +
                            std::to_string(primitive.targets.size()) + " morph targets; must be the same");
        const std::vector<double>& weights = node(index).weights.empty() ? mesh.weights : node(index).weights;
        at(index).firstTarget = int(mesh_.rig.targets.size());
        at(index).targets = count;
        for (std::size_t i = 0; i < count; ++i) {
            mesh_.rig.targets.emplace_back();
            mesh_.rig.weights.push_back(i < weights.size() ? float(weights[i]) : 0.0f);
        }
        return true;
    }

    bool addPrimitive(const tinygltf::Primitive& primitive, int index) {
        const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
        if (mode < TINYGLTF_MODE_TRIANGLES) {
            unread_.insert("points and lines");
            return true;
        }
        if (!primitive.attributes.contains("POSITION")) return true; // legal, and draws nothing
        if (primitive.material >= 0 && !element(model_.materials, primitive.material))
            return fail("points to material " + std::to_string(primitive.material) +
                        ", which does not exist");
        for (const auto& [attribute, accessor] : primitive.attributes)
            if (attribute.starts_with("COLOR_") && attribute != "COLOR_0")
                unread_.insert("further colours of vertices");
        Mesh piece;
        if (!(readPositions(primitive, piece) && readCoordinates(primitive, piece) &&
              readColors(primitive, piece) && readTriangles(primitive, mode, piece) &&
              readTargets(primitive, piece) && readJoints(primitive, index, piece)))
            return false;
        if (primitive.attributes.contains("NORMAL")) {
            if (!readNormals(primitive, piece)) return false;
        } else {
            makeFlat(piece);
        }
        const mat4& first = rest_[piece.joints.empty() ? 0 : piece.joints.front()[0]];
        if (glm::determinant(first) < 0) // a mirror turns counter-clockwise round
            for (std::size_t i = 0; i + 2 < piece.indices.size(); i += 3)
                std::swap(piece.indices[i + 1], piece.indices[i + 2]);
        addPiece(std::move(piece), index, primitive.material);
        return true;
    }

    bool readPositions(const tinygltf::Primitive& primitive, Mesh& piece) {
        const Result<std::vector<double>> positions =
            readNumbers(model_, primitive.attributes.at("POSITION"), TINYGLTF_TYPE_VEC3, "positions", name_);
        if (pass(positions)) piece.positions = toVectors(*positions);
        return bool(positions);
    }

    // Where the textures of its material lie; none without textures.
    bool readCoordinates(const tinygltf::Primitive& primitive, Mesh& piece) {
        const tinygltf::Material* material = element(model_.materials, primitive.material);
        if (!material || !hasTextures(*material)) return true;
        const std::vector<TextureMapping> mappings = textures_.mappingsOf(*material);
        return readSet(primitive, mappings[0], piece, piece.coordinates) &&
               (mappings.size() < 2 || readSet(primitive, mappings[1], piece, piece.secondCoordinates));
    }

    bool readSet(const tinygltf::Primitive& primitive, const TextureMapping& mapping, const Mesh& piece,
                 std::vector<vec2>& coordinates) {
        const auto found = primitive.attributes.find("TEXCOORD_" + std::to_string(mapping.set));
        if (found == primitive.attributes.end()) return true;
        const Result<std::vector<double>> numbers =
            readNumbers(model_, found->second, TINYGLTF_TYPE_VEC2, "texture coordinates", name_);
        if (!pass(numbers)) return false;
        if (numbers->size() != 2 * piece.positions.size())
            return fail("has " + std::to_string(numbers->size() / 2) + " texture coordinates for " +
                        std::to_string(piece.positions.size()) + " positions; must be as many");
        for (std::size_t i = 0; i < numbers->size(); i += 2)
            coordinates.emplace_back(mapping.textureFromVertex * dvec3((*numbers)[i], (*numbers)[i + 1], 1));
        return true;
    }

    // Of vertices: linear, with or without an alpha, which is not drawn.
    bool readColors(const tinygltf::Primitive& primitive, Mesh& piece) {
        const auto found = primitive.attributes.find("COLOR_0");
        if (found == primitive.attributes.end()) return true;
        const tinygltf::Accessor* accessor = element(model_.accessors, found->second);
        const bool hasAlpha = accessor && accessor->type == TINYGLTF_TYPE_VEC4;
        const Result<std::vector<double>> numbers =
            readNumbers(model_, found->second, hasAlpha ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3,
                        "colours of vertices", name_);
        if (!pass(numbers)) return false;
        const std::size_t each = hasAlpha ? 4 : 3;
        if (numbers->size() != each * piece.positions.size())
            return fail("has " + std::to_string(numbers->size() / each) + " colours for " +
                        std::to_string(piece.positions.size()) + " positions; must be as many");
        for (std::size_t i = 0; i < numbers->size(); i += each)
            piece.colors.push_back(
                glm::max(vec3(dvec3((*numbers)[i], (*numbers)[i + 1], (*numbers)[i + 2])), vec3(0)));
        colored_.insert(primitive.material < 0 ? kNoMaterial : primitive.material);
        return true;
    }

    bool readTriangles(const tinygltf::Primitive& primitive, int mode, Mesh& piece) {
        std::vector<std::uint32_t> corners;
        if (primitive.indices >= 0) {
            Result<std::vector<std::uint32_t>> indices =
                readIndices(model_, primitive.indices, TINYGLTF_TYPE_SCALAR, "indices", name_);
            if (!pass(indices)) return false;
            corners = std::move(*indices);
        } else {
            for (std::size_t i = 0; i < piece.positions.size(); ++i)
                corners.push_back(std::uint32_t(i));
        }
        for (const std::uint32_t corner : corners)
            if (corner >= piece.positions.size())
                return fail("has index " + std::to_string(corner) + " behind its " +
                            std::to_string(piece.positions.size()) + " positions; must be smaller");
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            piece.indices.insert(piece.indices.end(), {corners[a], corners[b], corners[c]});
        };
        if (mode == TINYGLTF_MODE_TRIANGLES)
            for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
                add(i, i + 1, i + 2);
        else if (mode == TINYGLTF_MODE_TRIANGLE_STRIP)
            for (std::size_t i = 0; i + 2 < corners.size(); ++i)
                add(i, i + 1 + i % 2, i + 2 - i % 2);
        else
            for (std::size_t i = 1; i + 1 < corners.size(); ++i)
                add(0, i, i + 1);
        return true;
    }

    // The file's normals; those of the triangles around where one has no direction.
    bool readNormals(const tinygltf::Primitive& primitive, Mesh& piece) {
        piece.normals = areaWeightedNormals(piece.positions, piece.indices);
        const Result<std::vector<double>> numbers =
            readNumbers(model_, primitive.attributes.at("NORMAL"), TINYGLTF_TYPE_VEC3, "normals", name_);
        if (!pass(numbers)) return false;
        const std::vector<vec3> normals = toVectors(*numbers);
        if (normals.size() != piece.positions.size())
            return fail("has " + std::to_string(normals.size()) + " normals for " +
                        std::to_string(piece.positions.size()) + " positions; must be as many");
        for (std::size_t i = 0; i < normals.size(); ++i)
            if (const float length = glm::length(normals[i]); length != 0)
                piece.normals[i] =
                    normals[i] / length; // what is no number stays one, and is refused at the end
        return true;
    }

    // Flat normals, which a file without any asks for (glTF 2.0, 3.7.2.1), in every morph target too. Corners
    // at one vertex of the file share one of ours where their normals are the same, to the bit.
    static void makeFlat(Mesh& piece) {
        constexpr std::uint32_t kNone = ~std::uint32_t(0);
        std::vector<std::uint32_t> last(piece.positions.size(), kNone); // of ours at one of the file
        std::vector<std::uint32_t> before, from;
        std::vector<vec3> normals;
        for (std::size_t i = 0; i + 2 < piece.indices.size(); i += 3) {
            const auto p = [&](std::size_t c) { return dvec3(piece.positions[piece.indices[i + c]]); };
            const dvec3 across = glm::cross(p(1) - p(0), p(2) - p(0));
            const vec3 normal = across == dvec3(0) ? vec3(0, 1, 0) : vec3(glm::normalize(across));
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint32_t& corner = piece.indices[i + c];
                std::uint32_t found = piece.rig.targets.empty() ? last[corner] : kNone;
                while (found != kNone && normals[found] != normal)
                    found = before[found];
                if (found == kNone) {
                    found = std::uint32_t(from.size());
                    from.push_back(corner);
                    normals.push_back(normal);
                    before.push_back(std::exchange(last[corner], found));
                }
                corner = found;
            }
        }
        const auto take = [&from](auto& list) {
            std::decay_t<decltype(list)> taken;
            for (const std::uint32_t vertex : from)
                taken.push_back(list[vertex]);
            list = std::move(taken);
        };
        take(piece.positions);
        if (!piece.coordinates.empty()) take(piece.coordinates);
        if (!piece.secondCoordinates.empty()) take(piece.secondCoordinates);
        if (!piece.colors.empty()) take(piece.colors);
        take(piece.joints);
        take(piece.jointWeights);
        piece.normals = std::move(normals);
        for (MorphTarget& target : piece.rig.targets) {
            take(target.positions);
            std::vector<vec3> moved = piece.positions;
            for (std::size_t i = 0; i < moved.size(); ++i)
                moved[i] += target.positions[i];
            target.normals = areaWeightedNormals(moved, piece.indices);
            for (std::size_t i = 0; i < moved.size(); ++i)
                target.normals[i] -= piece.normals[i];
        }
    }

    // Displacements of a file.
    bool readTargets(const tinygltf::Primitive& primitive, Mesh& piece) {
        const std::size_t count = piece.positions.size();
        const auto read = [&](const std::map<std::string, int>& target, const char* attribute,
                              std::vector<vec3>& to) {
            to.assign(count, vec3(0));
            const auto found = target.find(attribute);
            if (found == target.end()) return true;
            const Result<std::vector<double>> numbers =
                readNumbers(model_, found->second, TINYGLTF_TYPE_VEC3, "morph targets", name_);
            if (!pass(numbers)) return false;
            to = toVectors(*numbers);
            return to.size() == count || fail("has a morph target of " + std::to_string(to.size()) +
                                              " vertices for " + std::to_string(count) + "; must be as many");
        };
        if (count * primitive.targets.size() > kMostVertices)
            return fail("has " + std::to_string(primitive.targets.size()) + " morph targets of " +
                        std::to_string(count) + " vertices; must displace at most " +
                        std::to_string(kMostVertices) + " in all");
        for (const std::map<std::string, int>& from : primitive.targets) {
            MorphTarget& target = piece.rig.targets.emplace_back();
            if (!read(from, "POSITION", target.positions) || !read(from, "NORMAL", target.normals))
                return false;
        }
        return true;
    }

    // Joints of a skin; without one the node itself moves all vertices.
    bool readJoints(const tinygltf::Primitive& primitive, int index, Mesh& piece) {
        const std::size_t count = piece.positions.size();
        const auto joints = primitive.attributes.find("JOINTS_0"),
                   weights = primitive.attributes.find("WEIGHTS_0");
        if (node(index).skin < 0 || joints == primitive.attributes.end() ||
            weights == primitive.attributes.end()) {
            if (at(index).firstJoint < 0) {
                at(index).firstJoint = int(rest_.size());
                if (!addJoint(index, dmat4(1))) return false;
            }
            const auto only = std::uint16_t(at(index).firstJoint);
            piece.joints.assign(count, {only, only, only, only});
            piece.jointWeights.assign(count, vec4(1, 0, 0, 0));
            return true;
        }
        if (primitive.attributes.contains("JOINTS_1")) unread_.insert("more than four joints of a vertex");
        const Result<std::vector<std::uint32_t>> places =
            readIndices(model_, joints->second, TINYGLTF_TYPE_VEC4, "joints", name_);
        if (!pass(places)) return false;
        const Result<std::vector<double>> parts =
            readNumbers(model_, weights->second, TINYGLTF_TYPE_VEC4, "weights of joints", name_);
        if (!pass(parts)) return false;
        if (places->size() != 4 * count || parts->size() != 4 * count)
            return fail("has " + std::to_string(places->size() / 4) + " joints and " +
                        std::to_string(parts->size() / 4) + " weights for " + std::to_string(count) +
                        " positions; must be as many");
        int first = 0;
        if (!addSkin(node(index).skin, first)) return false;
        const std::size_t bones = model_.skins[std::size_t(node(index).skin)].joints.size();
        for (std::size_t i = 0; i < count; ++i) {
            auto& four = piece.joints.emplace_back();
            vec4 share;
            for (std::size_t j = 0; j < 4; ++j) {
                const std::uint32_t place = (*places)[4 * i + j];
                share[int(j)] = float((*parts)[4 * i + j]);
                if (!(share[int(j)] >= 0))
                    return fail("has a negative weight of a joint at vertex " + std::to_string(i) +
                                "; must be 0 or more");
                if (place >= bones && share[int(j)] > 0)
                    return fail("has joint " + std::to_string(place) + " behind the " +
                                std::to_string(bones) + " of its skin; must be smaller");
                // One that weighs nothing may be any number.
                four[j] = std::uint16_t(std::size_t(first) + std::min<std::size_t>(place, bones - 1));
            }
            const float sum = share.x + share.y + share.z + share.w;
            if (sum == 0) unread_.insert("vertices without weights of joints, which the first joint moves");
            piece.jointWeights.push_back(sum > 0 ? share / sum : vec4(1, 0, 0, 0));
        }
        return true;
    }

    bool addJoint(int index, const dmat4& jointFromMesh) {
        if (rest_.size() > std::numeric_limits<std::uint16_t>::max())
            return fail("has more than 65536 joints; must have fewer");
        mesh_.rig.joints.push_back(at(index).inRig);
        mesh_.rig.jointFromMesh.emplace_back(jointFromMesh);
        rest_.emplace_back(at(index).rootFromNode * jointFromMesh);
        return true;
    }

    // Joints of a skin, which several nodes may share.
    bool addSkin(int index, int& first) {
        const auto [known, isNew] = firstOfSkin_.emplace(index, int(rest_.size()));
        first = known->second;
        if (!isNew) return true;
        const tinygltf::Skin& skin = model_.skins[std::size_t(index)];
        std::vector<double> matrices;
        if (skin.inverseBindMatrices >= 0) {
            Result<std::vector<double>> numbers = readNumbers(
                model_, skin.inverseBindMatrices, TINYGLTF_TYPE_MAT4, "inverse bind matrices", name_);
            if (!pass(numbers)) return false;
            matrices = std::move(*numbers);
            if (matrices.size() < 16 * skin.joints.size())
                return fail("has " + std::to_string(matrices.size() / 16) + " inverse bind matrices for " +
                            std::to_string(skin.joints.size()) + " joints; must be as many");
        }
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            if (!addJoint(skin.joints[j], matrices.empty() ? dmat4(1) : glm::make_mat4(&matrices[16 * j])))
                return false;
        return true;
    }

    // What moves keeps its joints and targets; what does not is put where they hold it.
    void addPiece(Mesh piece, int index, int material) {
        const auto firstTarget = std::size_t(at(index).firstTarget);
        if (!moves()) {
            const auto weights = mesh_.rig.weights.begin() + std::ptrdiff_t(firstTarget);
            const Pose pose{rest_, {weights, weights + std::ptrdiff_t(piece.rig.targets.size())}};
            piece = posed(piece, pose);
        }
        const std::size_t first = mesh_.positions.size();
        std::vector<std::uint32_t>& indices = indicesOf_[material < 0 ? kNoMaterial : material];
        for (const std::uint32_t corner : piece.indices)
            indices.push_back(std::uint32_t(first) + corner);
        for (std::size_t t = 0; t < piece.rig.targets.size(); ++t) {
            MorphTarget& target = mesh_.rig.targets[firstTarget + t];
            target.positions.resize(first, vec3(0));
            target.normals.resize(first, vec3(0));
            append(target.positions, piece.rig.targets[t].positions);
            append(target.normals, piece.rig.targets[t].normals);
        }
        if (!piece.coordinates.empty()) {
            mesh_.coordinates.resize(first, vec2(0)); // of what has no textures
            append(mesh_.coordinates, piece.coordinates);
        }
        if (!piece.secondCoordinates.empty()) {
            mesh_.secondCoordinates.resize(first, vec2(0));
            append(mesh_.secondCoordinates, piece.secondCoordinates);
        }
        if (!piece.colors.empty()) {
            mesh_.colors.resize(first, vec3(1)); // of what has none
            append(mesh_.colors, piece.colors);
        }
        append(mesh_.positions, piece.positions);
        append(mesh_.normals, piece.normals);
        append(mesh_.joints, piece.joints);
        append(mesh_.jointWeights, piece.jointWeights);
    }

    bool finishRig() {
        Rig& rig = mesh_.rig;
        if (!moves()) {
            rig = {};
            return true;
        }
        for (const int index : order_) {
            const std::optional<Node> own = decompose(parentFromNode(node(index)));
            if (!own && node(index).matrix.size() == 16 && at(index).isUsed)
                return fail("node " + std::to_string(index) +
                            " has a matrix that slants or flattens; must scale, turn and move");
            Node& to = rig.nodes.emplace_back(own.value_or(Node{}));
            to.parent = at(index).parent < 0 ? -1 : at(at(index).parent).inRig;
            if (node(index).matrix.size() == 16) continue; // else as the file says it: a scale may be 0
            const tinygltf::Node& from = node(index);
            if (from.translation.size() == 3) to.translate = glm::make_vec3(from.translation.data());
            if (from.rotation.size() == 4)
                to.rotate = glm::quat(float(from.rotation[3]), float(from.rotation[0]),
                                      float(from.rotation[1]), float(from.rotation[2]));
            if (from.scale.size() == 3) to.scale = glm::make_vec3(from.scale.data());
        }
        for (Channel& channel : rig.channels) {
            const Place& place = at(channel.node);
            channel.firstTarget = place.firstTarget;
            channel.node = place.inRig;
            if (channel.path == Channel::Path::Weights && channel.width() != place.targets)
                return fail("animates " + std::to_string(channel.width()) +
                            " morph targets of a node that has " + std::to_string(place.targets) +
                            "; must be as many");
        }
        return true;
    }

    // Triangles in the order of their materials; false when there are none.
    bool finishParts() {
        const bool named =
            indicesOf_.size() > 1 || !indicesOf_.contains(kNoMaterial) || colored_.contains(kNoMaterial);
        UniqueNames names;
        for (const auto& [index, indices] : indicesOf_) {
            if (indices.empty()) continue;
            const tinygltf::Material* material = element(model_.materials, index);
            std::string name = material ? material->name : "default";
            name = names.unique(name.empty() ? "material " + std::to_string(index) : name);
            if (named) {
                Mesh::Part& part = mesh_.parts.emplace_back(
                    Mesh::Part{name, std::uint32_t(mesh_.indices.size()), std::uint32_t(indices.size()),
                               materialOf(material ? *material : tinygltf::Material(), unread_)});
                if (material) addTextures(*material, part);
                part.textures.vertexColors = colored_.contains(index) && showsTextures(part.values);
            }
            append(mesh_.indices, indices);
        }
        mesh_.images = textures_.takeImages();
        for (std::vector<vec2>* coordinates : {&mesh_.coordinates, &mesh_.secondCoordinates})
            if (!coordinates->empty()) coordinates->resize(mesh_.positions.size(), vec2(0));
        if (!mesh_.colors.empty()) mesh_.colors.resize(mesh_.positions.size(), vec3(1));
        return !mesh_.indices.empty();
    }

    void addTextures(const tinygltf::Material& material, Mesh::Part& part) {
        if (showsTextures(part.values) && !mesh_.coordinates.empty())
            part.textures = textures_.texturesOf(material);
        else if (showsTextures(part.values)) {
            part.textures.cutoff = std::min(cutoffOf(material), 0.0f);
            if (hasTextures(material)) unread_.insert("textures of what has no texture coordinates");
        }
        for (TextureUse* use :
             {&part.textures.color, &part.textures.emission, &part.textures.roughness, &part.textures.normal})
            if (use->second && mesh_.secondCoordinates.empty()) {
                unread_.insert("textures of what has no second texture coordinates");
                *use = {};
            }
        // Emission beside a texture, which mostly blackens it, counts nothing without that.
        if (material.emissiveTexture.index >= 0 && part.textures.emission.image < 0)
            part.values.base = vec3(0);
    }

    // Of the scene, where its nodes hold them at rest.
    void addView() {
        for (const int index : order_) {
            if (!at(index).inScene) continue;
            if (const auto light = lightOf(model_, node(index), at(index).rootFromNode))
                mesh_.lights.push_back(*light);
            const auto camera = cameraOf(model_, node(index), at(index).rootFromNode);
            if (camera && mesh_.cameras.empty()) mesh_.cameras.push_back(*camera);
        }
    }

    static constexpr std::size_t kMostVertices = std::size_t(1) << 24, kMostCorners = 6 * kMostVertices;
    static constexpr int kNoMaterial = std::numeric_limits<int>::max(); // comes last

    const tinygltf::Model& model_;
    const std::string& name_;
    Mesh mesh_;
    std::vector<Place> places_;
    std::vector<int> order_; // of nodes, parents first
    std::vector<mat4> rest_; // of joints, as Pose has them
    std::set<int> colored_;  // materials of triangles whose vertices have colours
    std::map<int, int> firstOfSkin_;
    std::map<int, std::vector<std::uint32_t>> indicesOf_; // by material
    std::size_t animated_ = 0;                            // numbers of the animation
    std::set<std::string> unread_;
    GltfTextures textures_;
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
    loader.SetImageLoader(keepImage, nullptr);

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
    return GltfReader(model, name, read).read();
}

} // namespace lucent::scene
