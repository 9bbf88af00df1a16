#include "scene/Keys.h"
#include "scene/Mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <set>
#include <string_view>
#include <type_traits>

namespace lucent::scene {
namespace {

constexpr std::string_view kMagic = "LUCENTM7";
constexpr std::string_view kBefore = "LUCENTM6"; // without second coordinates, holes, lamps and cameras
static_assert(std::endian::native == std::endian::little, "mesh files are written as they lie in memory");
static_assert(sizeof(vec2) == 8 && sizeof(vec3) == 12 && sizeof(vec4) == 16 && sizeof(mat4) == 64);
static_assert(sizeof(Node) == 44, "parent, translate, rotate as x y z w, scale: nothing between them");

/// Puts values behind each other.
class Writer {
public:
    /// @param expected  about how many bytes it will be
    explicit Writer(std::size_t expected) { bytes_.reserve(expected); }

    template <class T>
    void value(const T& v, const char*) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&v, sizeof v);
    }
    template <class List>
    void list(const List& values, const char* what) {
        value(std::uint32_t(values.size()), what);
        append(values.data(), values.size() * sizeof values[0]);
    }
    template <class T, class Fields>
    void items(const std::vector<T>& values, const char* what, const Fields& fields) {
        value(std::uint32_t(values.size()), what);
        for (const T& v : values)
            fields(v);
    }
    Bytes take() { return std::move(bytes_); }

private:
    void append(const void* data, std::size_t size) {
        const auto* begin = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }
    Bytes bytes_;
};

/// Takes them apart again. Behind the first thing that the file is too short for, nothing is read any more.
class Reader {
public:
    explicit Reader(std::span<const std::byte> rest) : rest_(rest) {}

    template <class T>
    void value(T& v, const char* what) {
        if (has(1, sizeof v, what)) take(&v, sizeof v);
    }
    template <class List>
    void list(List& values, const char* what) {
        std::uint32_t count = 0;
        value(count, what);
        if (!has(count, sizeof values[0], what)) return;
        values.resize(count);
        take(values.data(), count * sizeof values[0]);
    }
    /// The bytes of a list of them, where they lie.
    std::span<const std::byte> bytes(const char* what) {
        std::uint32_t count = 0;
        value(count, what);
        if (!has(count, 1, what)) return {};
        const std::span<const std::byte> found = rest_.first(count);
        rest_ = rest_.subspan(count);
        return found;
    }
    template <class T, class Fields>
    void items(std::vector<T>& values, const char* what, const Fields& fields) {
        std::uint32_t count = 0;
        value(count, what);
        for (std::uint32_t i = 0; i < count && missing_.empty(); ++i)
            fields(values.emplace_back());
    }

    /// What the file ends in, in words; empty when everything was there.
    const std::string& missing() const { return missing_; }
    std::size_t left() const { return rest_.size(); }

private:
    bool has(std::uint64_t count, std::size_t size, const char* what) {
        if (missing_.empty() && count * size > rest_.size())
            missing_ = "the mesh file ends in its " + std::string(what) + ", of which " +
                       std::to_string(rest_.size()) + " bytes are there; must have " +
                       std::to_string(count * size);
        return missing_.empty();
    }
    void take(void* to, std::size_t size) {
        if (size > 0) std::memcpy(to, rest_.data(), size);
        rest_ = rest_.subspan(size);
    }
    std::span<const std::byte> rest_;
    std::string missing_;
};

// What the file holds, in its order; File is a Writer or a Reader. A file's materials are of any kind but
// relief, and without layers.
template <class File>
void kindFields(File&, const Relief&) {}
template <class File>
void kindFields(File&, const Matt&) {}
// The classical models stand in no file.
template <class File>
void kindFields(File&, const Phong&) {}
template <class File>
void kindFields(File&, const Blinn&) {}
template <class File>
void kindFields(File&, const CookTorrance&) {}
template <class File>
void kindFields(File&, const OrenNayar&) {}
template <class File>
void kindFields(File&, const MeasuredBrdf&) {}
template <class File>
void kindFields(File& file, auto& m) requires requires {
    m.metallic;
}
{
    file.value(m.metallic, "materials");
    file.value(m.roughness, "materials");
    file.value(m.ior, "materials");
    file.value(m.specular, "materials");
}
template <class File>
void kindFields(File& file, auto& m) requires requires {
    m.reflectance;
}
{ file.value(m.reflectance, "materials"); }
template <class File>
void kindFields(File& file, auto& m) requires requires {
    m.transmission;
}
{
    file.value(m.transmission, "materials");
    file.value(m.ior, "materials");
    file.value(m.absorption, "materials");
    file.value(m.dispersion, "materials");
    file.value(m.attenuationDistance, "materials");
}
template <class File>
void kindFields(File& file, auto& m) requires requires {
    m.scattering;
}
{
    file.value(m.scattering, "materials");
    file.value(m.ior, "materials");
    file.value(m.absorption, "materials");
    file.value(m.anisotropy, "materials");
    file.value(m.roughness, "materials");
    file.value(m.attenuationDistance, "materials");
}
// Measured ones would need their table.
constexpr auto kMostKind = std::size_t(MaterialKind::OrenNayar);

template <class File, class AnyMaterial>
void materialFields(File& file, AnyMaterial& m) {
    file.value(m.base, "materials");
    file.value(m.diffuse, "materials");
    auto kind = std::uint8_t(m.kind.index());
    file.value(kind, "materials");
    if constexpr (!std::is_const_v<AnyMaterial>)
        m.kind = alternative<MaterialKinds>(std::min<std::size_t>(kind, kMostKind));
    std::visit([&](auto& of) { kindFields(file, of); }, m.kind);
}

// A byte, 0 or 1.
template <class File, class Flag>
void flag(File& file, Flag& is, const char* what) {
    auto byte = std::uint8_t(is);
    file.value(byte, what);
    if constexpr (!std::is_const_v<Flag>) is = byte != 0;
}

template <class File>
void useFields(File& file, auto& use, bool isWhole) {
    file.value(use.image, "textures");
    file.value(use.u, "textures");
    file.value(use.v, "textures");
    if (isWhole) flag(file, use.second, "textures");
}

template <class File>
void lampFields(File& file, auto& light) {
    file.value(light.kind, "lamps");
    file.value(light.position, "lamps");
    file.value(light.direction, "lamps");
    file.value(light.color, "lamps");
    file.value(light.intensity, "lamps");
    file.value(light.innerAngle, "lamps");
    file.value(light.outerAngle, "lamps");
}

template <class File>
void cameraFields(File& file, auto& camera) {
    flag(file, camera.perspective, "cameras");
    file.value(camera.eye, "cameras");
    file.value(camera.forward, "cameras");
    file.value(camera.up, "cameras");
    file.value(camera.fov, "cameras");
    file.value(camera.height, "cameras");
    file.value(camera.aspect, "cameras");
}

template <class File>
void imageFields(File& file, auto& image) {
    file.value(image.size, "sizes of textures");
    file.value(image.encoding, "sizes of textures");
}

// What is most of a large file, and not read at once.
struct Unread {
    std::shared_ptr<TextureImage> image;
    std::span<const std::byte> texels;
};

// @param unread  textures of a Reader's mesh whose texels are not read yet
template <class File, class AnyMesh>
void meshFields(File& file, AnyMesh& mesh, bool isWhole = true, std::vector<Unread>* unread = nullptr) {
    file.list(mesh.positions, "positions");
    file.list(mesh.indices, "indices");
    file.list(mesh.normals, "normals");
    file.list(mesh.joints, "joints");
    file.list(mesh.jointWeights, "weights of joints");
    file.list(mesh.coordinates, "texture coordinates");
    if (isWhole) file.list(mesh.secondCoordinates, "texture coordinates");
    file.list(mesh.colors, "colours");
    auto& rig = mesh.rig;
    file.list(rig.nodes, "nodes");
    file.list(rig.joints, "list of joints");
    file.list(rig.jointFromMesh, "matrices of joints");
    file.items(rig.targets, "morph targets", [&](auto& target) {
        file.list(target.positions, "morph targets");
        file.list(target.normals, "morph targets");
    });
    file.list(rig.weights, "weights of morph targets");
    file.items(rig.channels, "channels", [&](auto& channel) {
        file.value(channel.node, "channels");
        file.value(channel.firstTarget, "channels");
        file.value(channel.path, "channels");
        file.value(channel.interpolation, "channels");
        file.list(channel.times, "times");
        file.list(channel.values, "values over time");
    });
    file.value(rig.duration, "duration");
    file.items(mesh.parts, "parts", [&](auto& part) {
        file.list(part.material, "names of materials");
        file.value(part.firstIndex, "parts");
        file.value(part.indexCount, "parts");
        materialFields(file, part.values);
        auto& textures = part.textures;
        for (auto* use : {&textures.color, &textures.emission, &textures.roughness, &textures.normal})
            useFields(file, *use, isWhole);
        file.value(textures.normalScale, "textures");
        flag(file, textures.vertexColors, "textures");
        if (isWhole) file.value(textures.cutoff, "textures");
    });
    file.items(mesh.images, "textures", [&](auto& image) {
        if constexpr (std::is_const_v<AnyMesh>) {
            imageFields(file, *image);
            file.list(image->texels, "textures");
        } else {
            const auto read = std::make_shared<TextureImage>();
            imageFields(file, *read);
            unread->push_back({read, file.bytes("textures")});
            image = read;
        }
    });
    if (!isWhole) return;
    file.items(mesh.lights, "lamps", [&](auto& light) { lampFields(file, light); });
    file.items(mesh.cameras, "cameras", [&](auto& camera) { cameraFields(file, camera); });
}

bool startsWith(std::span<const std::byte> bytes, std::string_view magic) {
    return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

bool isFinite(float x) { return std::isfinite(x); }
template <int N>
bool isFinite(const glm::vec<N, float>& v) {
    for (int i = 0; i < N; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}
bool isFinite(const glm::quat& q) { return isFinite(vec4(q.x, q.y, q.z, q.w)); }
bool isFinite(const mat4& m) { return isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]); }

bool isSound(const Material& m) {
    if (!isFinite(m.base) || !isFinite(m.diffuse)) return false;
    if (m.isMirror()) return isFinite(m.mirror().reflectance);
    if (m.isRefractive()) {
        const Clear& c = m.clear();
        return isFinite(c.transmission) && isFinite(c.ior) && c.ior > 0 && isFinite(c.absorption) &&
               isFinite(c.dispersion) && isFinite(c.attenuationDistance);
    }
    if (const auto* g = std::get_if<Glossy>(&m.kind))
        return isFinite(g->metallic) && isFinite(g->roughness) && isFinite(g->ior) && isFinite(g->specular);
    if (!m.isScattering()) return true;
    const Translucent& t = m.translucent();
    return isFinite(t.scattering) && isFinite(t.ior) && t.ior > 0 && isFinite(t.absorption) &&
           isFinite(t.anisotropy) && isFinite(t.roughness) && isFinite(t.attenuationDistance);
}

// Normals and weights of joints are stored rounded, often to 8 or 16 bits.
constexpr float kUnitTolerance = 1e-2f;

bool isUnit(const vec3& v) { return std::abs(glm::length(v) - 1) <= kUnitTolerance; }

/// What keeps a mesh from being used; the first thing that is wrong stays.
class Checker {
public:
    /// @param hasTexels  false: those of its pictures were not read
    Checker(const Mesh& mesh, bool hasTexels) : mesh_(mesh), rig_(mesh.rig), hasTexels_(hasTexels) {}

    /// Empty for a sound mesh, else "what was found; what was expected".
    std::string check() {
        triangles();
        vertices();
        bones();
        morphs();
        for (std::size_t i = 0; i < rig_.channels.size(); ++i)
            channel(rig_.channels[i], "channel " + std::to_string(i));
        for (std::size_t i = 0; i < mesh_.images.size(); ++i)
            image(*mesh_.images[i], "texture " + std::to_string(i));
        if (!(rig_.duration >= 0 && isFinite(rig_.duration)))
            wrong("lasts " + std::to_string(rig_.duration) + " s; must be 0 or more");
        parts();
        for (const FileLight& light : mesh_.lights)
            lamp(light);
        for (const FileCamera& of : mesh_.cameras)
            camera(of);
        return wrong_;
    }

private:
    void wrong(const std::string& what) {
        if (wrong_.empty()) wrong_ = what;
    }
    template <class List>
    void finite(const List& values, const std::string& what) {
        for (std::size_t i = 0; i < values.size(); ++i)
            if (!isFinite(values[i]))
                return wrong(what + " " + std::to_string(i) + " is not finite; must be");
    }
    // Lists of which there is one entry for each of another.
    void sameLength(std::size_t found, const std::string& what, std::size_t expected) {
        if (found != expected)
            wrong("has " + std::to_string(found) + " " + what + "; must have " + std::to_string(expected));
    }
    void below(std::int64_t index, std::size_t end, const std::string& what, const std::string& list) {
        if (index < 0 || index >= std::int64_t(end))
            wrong(what + " " + std::to_string(index) + " points outside the " + std::to_string(end) + " " +
                  list + "; must be smaller");
    }

    void triangles() {
        const std::size_t count = mesh_.indices.size();
        if (count == 0 || count % 3)
            wrong("has " + std::to_string(count) + " indices; must be three a triangle, at least one");
        for (const std::uint32_t index : mesh_.indices)
            if (index >= mesh_.positions.size())
                return below(index, mesh_.positions.size(), "index", "positions");
    }

    void vertices() {
        const std::size_t count = mesh_.positions.size();
        finite(mesh_.positions, "position");
        if (!mesh_.normals.empty()) sameLength(mesh_.normals.size(), "normals", count);
        for (std::size_t i = 0; i < mesh_.normals.size(); ++i) {
            const float length = glm::length(mesh_.normals[i]);
            if (!(std::abs(length - 1) <= kUnitTolerance))
                return wrong("normal " + std::to_string(i) + " has length " + std::to_string(length) +
                             "; must be 1");
        }
        if (!mesh_.coordinates.empty()) sameLength(mesh_.coordinates.size(), "texture coordinates", count);
        finite(mesh_.coordinates, "texture coordinate");
        if (!mesh_.secondCoordinates.empty())
            sameLength(mesh_.secondCoordinates.size(), "second texture coordinates", count);
        finite(mesh_.secondCoordinates, "second texture coordinate");
        if (!mesh_.colors.empty()) sameLength(mesh_.colors.size(), "colours", count);
        for (std::size_t i = 0; i < mesh_.colors.size(); ++i)
            if (!isFinite(mesh_.colors[i]) || glm::any(glm::lessThan(mesh_.colors[i], vec3(0))))
                return wrong("colour " + std::to_string(i) + " is negative or not finite; must be 0 or more");
        if (!mesh_.joints.empty()) sameLength(mesh_.joints.size(), "joints of positions", count);
        sameLength(mesh_.jointWeights.size(), "weights of joints", mesh_.joints.size());
        for (const auto& four : mesh_.joints)
            for (const std::uint16_t joint : four)
                if (joint >= rig_.joints.size()) return below(joint, rig_.joints.size(), "joint", "joints");
        for (std::size_t i = 0; i < mesh_.jointWeights.size(); ++i) {
            const vec4 w = mesh_.jointWeights[i];
            const float sum = w.x + w.y + w.z + w.w;
            if (!(std::abs(sum - 1) <= kUnitTolerance && glm::all(glm::greaterThanEqual(w, vec4(0)))))
                return wrong("weights of joints " + std::to_string(i) + " are negative or sum to " +
                             std::to_string(sum) + "; must be 0 or more and sum to 1");
        }
    }

    void image(const TextureImage& image, const std::string& name) {
        const auto legal = [](int side) { return side >= 1 && side <= kMostTextureSide; };
        const std::size_t texels =
            std::size_t(std::max(image.size.x, 0)) * std::size_t(std::max(image.size.y, 0));
        if (!legal(image.size.x) || !legal(image.size.y) || (hasTexels_ && image.texels.size() != 4 * texels))
            wrong(name + " has " + std::to_string(image.size.x) + " x " + std::to_string(image.size.y) +
                  " texels in " + std::to_string(image.texels.size()) +
                  " bytes; must have 4 bytes a texel and at most " + std::to_string(kMostTextureSide) +
                  " on a side");
        if (image.encoding != Encoding::Linear && image.encoding != Encoding::Srgb)
            wrong(name + " has encoding " + std::to_string(int(image.encoding)) + "; must be 0 or 1");
    }

    void textures(const Textures& textures, const std::string& name) {
        for (const TextureUse& use :
             {textures.color, textures.emission, textures.roughness, textures.normal}) {
            if (use.image < -1 || use.image >= std::int64_t(mesh_.images.size()))
                below(use.image, mesh_.images.size(), name + ": texture", "textures");
            if (use.second && use.image >= 0 && mesh_.secondCoordinates.empty())
                wrong(name + " has textures by second coordinates that are missing; must have them");
            if (use.u > Wrap::Mirror || use.v > Wrap::Mirror)
                wrong(name + " has textures that go on in an unknown way; must repeat, clamp or mirror");
        }
        if (textures.hasImages() && mesh_.coordinates.empty())
            wrong(name + " has textures without coordinates; must have them");
        if (textures.vertexColors && mesh_.colors.empty())
            wrong(name + " shows colours of vertices that have none; must have them");
        if (!isFinite(textures.normalScale) || !isFinite(textures.cutoff))
            wrong(name + " has a normal scale or a cutoff that is not finite; must be");
    }

    void lamp(const FileLight& light) {
        const bool isKnown = light.kind <= FileLight::Kind::Distant;
        if (!isKnown || !isFinite(light.position) || !isUnit(light.direction) || !isFinite(light.color) ||
            !(light.intensity >= 0) || !isFinite(light.intensity) ||
            !(light.innerAngle >= 0 && light.innerAngle <= light.outerAngle && light.outerAngle <= 90))
            wrong("has a lamp of an unknown kind or with values that are not finite; must be point, spot or "
                  "distant, its "
                  "direction unit, its intensity 0 or more, its angles from 0 to 90 degrees, the inner no "
                  "larger");
    }

    void camera(const FileCamera& of) {
        if (!isFinite(of.eye) || !isUnit(of.forward) || !isUnit(of.up) || !(of.fov > 0 && of.fov < 180) ||
            !(of.height > 0 && isFinite(of.height)) || !(of.aspect >= 0 && isFinite(of.aspect)))
            wrong("has a camera with values that are not finite; must have unit directions, an angle between "
                  "0 and 180 "
                  "degrees and a height above 0");
    }

    void bones() {
        for (std::size_t i = 0; i < rig_.nodes.size(); ++i) {
            const Node& node = rig_.nodes[i];
            if (node.parent < -1 || node.parent >= std::int64_t(i))
                wrong("node " + std::to_string(i) + " has parent " + std::to_string(node.parent) +
                      "; must be a node before it, or -1");
            if (!isFinite(node.translate) || !isFinite(node.rotate) || !isFinite(node.scale))
                wrong("node " + std::to_string(i) + " is not finite; must be");
        }
        for (const int joint : rig_.joints)
            below(joint, rig_.nodes.size(), "joint of node", "nodes");
        sameLength(rig_.jointFromMesh.size(), "matrices of joints", rig_.joints.size());
        finite(rig_.jointFromMesh, "matrix of joint");
    }

    void morphs() {
        sameLength(rig_.weights.size(), "weights of morph targets", rig_.targets.size());
        finite(rig_.weights, "weight of morph target");
        for (std::size_t i = 0; i < rig_.targets.size(); ++i) {
            const MorphTarget& target = rig_.targets[i];
            const std::string name = "morph target " + std::to_string(i) + ": ";
            const std::size_t count = mesh_.positions.size();
            if (target.positions.size() != count ||
                (!target.normals.empty() && target.normals.size() != count))
                wrong(name + "has " + std::to_string(target.positions.size()) + " positions and " +
                      std::to_string(target.normals.size()) + " normals; must have " + std::to_string(count) +
                      " positions, and as many normals or none");
            finite(target.positions, name + "position");
            finite(target.normals, name + "normal");
        }
    }

    void channel(const Channel& c, const std::string& name) {
        const bool cubic = c.interpolation == Channel::Interpolation::CubicSpline;
        if (int(c.path) < 0 || c.path > Channel::Path::Weights || int(c.interpolation) < 0 ||
            c.interpolation > Channel::Interpolation::CubicSpline)
            return wrong(name + " has path " + std::to_string(int(c.path)) + " and interpolation " +
                         std::to_string(int(c.interpolation)) + "; must be 0 to 3 and 0 to 2");
        if (c.times.empty()) return wrong(name + " has no times; must have at least one");
        finite(c.times, name + ": time");
        finite(c.values, name + ": value");
        for (std::size_t i = 1; i < c.times.size(); ++i)
            if (c.times[i] <= c.times[i - 1])
                return wrong(name + ": time " + std::to_string(i) + " is not behind the one before; must be");
        const std::size_t keys = c.times.size() * (cubic ? 3 : 1), width = c.width();
        if (width == 0 || c.values.size() != keys * width)
            return wrong(name + " has " + std::to_string(c.values.size()) + " values at " +
                         std::to_string(c.times.size()) + " times; must be " +
                         (c.path == Channel::Path::Weights ? "a multiple of " + std::to_string(keys)
                                                           : std::to_string(keys * width)));
        if (c.path != Channel::Path::Weights)
            return below(c.node, rig_.nodes.size(), name + ": node", "nodes");
        below(c.firstTarget, rig_.targets.size(), name + ": morph target", "morph targets");
        below(c.firstTarget + std::int64_t(width) - 1, rig_.targets.size(), name + ": morph target",
              "morph targets");
    }

    void parts() {
        std::set<std::string_view> names;
        std::uint64_t end = 0;
        for (const Mesh::Part& part : mesh_.parts) {
            const std::string name = "part \"" + part.material + "\"";
            if (part.material.empty() || !names.insert(part.material).second)
                wrong(name + " has the name of another or none; must have one of its own");
            if (part.firstIndex != end || part.indexCount == 0 || part.indexCount % 3)
                wrong(name + " begins at index " + std::to_string(part.firstIndex) + " and has " +
                      std::to_string(part.indexCount) + "; must begin at " + std::to_string(end) +
                      " and have three a triangle");
            end = std::uint64_t(part.firstIndex) + part.indexCount;
            if (!isSound(part.values))
                wrong(name + " has a value that is not finite or an ior of 0 or less; must not");
            textures(part.textures, name);
        }
        if (!mesh_.parts.empty() && end != mesh_.indices.size())
            wrong("its parts end at index " + std::to_string(end) + "; must end at " +
                  std::to_string(mesh_.indices.size()));
    }

    const Mesh& mesh_;
    const Rig& rig_;
    bool hasTexels_;
    std::string wrong_;
};

} // namespace

bool isMesh(std::span<const std::byte> bytes) {
    return startsWith(bytes, kMagic) || startsWith(bytes, kBefore);
}

Bytes encodeMesh(const Mesh& mesh) {
    std::size_t expected = 4096 + 4 * mesh.indices.size() + 64 * mesh.positions.size();
    for (const auto& image : mesh.images)
        expected += image->texels.size();
    Writer file(expected); // else what is large would be copied as often as it doubles
    for (const char letter : kMagic)
        file.value(letter, "");
    meshFields(file, mesh);
    return file.take();
}

namespace {

// Reads all but the texels.
Status decodeVertices(std::span<const std::byte> bytes, const std::string& name, Mesh& mesh,
                      std::vector<Unread>& unread) {
    if (!isMesh(bytes))
        return Error{name + ": is no mesh file; must be glTF 2.0, OBJ or start with " + std::string(kMagic)};
    Reader file(bytes.subspan(kMagic.size()));
    meshFields(file, mesh, startsWith(bytes, kMagic), &unread);
    if (!file.missing().empty()) return Error{name + ": " + file.missing()};
    if (file.left() > 0)
        return Error{name + ": " + std::to_string(file.left()) + " bytes follow the mesh; must be none"};
    return Done{};
}

void takeTexels(TextureImage& image, std::span<const std::byte> bytes) {
    const auto* texels = reinterpret_cast<const std::uint8_t*>(bytes.data());
    image.texels.assign(texels, texels + bytes.size());
    if (image.texels.size() % 4 == 0) image.findLeast(); // else it will be refused
}

// @param mesh  name of the file that `from` stands in
Status readTexels(const Unread& from, const std::string& mesh, const ReadFile& read) {
    takeTexels(*from.image, from.texels);
    if (!from.image->isElsewhere()) return Done{};
    const Result<Bytes> file = read(mesh + "#" + std::to_string(from.image->texels.front()));
    if (!file) return file.error();
    takeTexels(*from.image, *file);
    return Done{};
}

Status checkMesh(const Mesh& mesh, const std::string& name, bool hasTexels) {
    if (const std::string wrong = Checker(mesh, hasTexels).check(); !wrong.empty())
        return Error{name + ": " + wrong};
    return Done{};
}

} // namespace

Result<Mesh> decodeShape(std::span<const std::byte> bytes, const std::string& name) {
    Mesh mesh;
    std::vector<Unread> unread;
    if (Status s = decodeVertices(bytes, name, mesh, unread); !s) return s.error();
    if (Status s = checkMesh(mesh, name, false); !s) return s.error();
    return mesh;
}

Result<Mesh> decodeMesh(std::span<const std::byte> bytes, const std::string& name) {
    Mesh mesh;
    std::vector<Unread> unread;
    if (Status s = decodeVertices(bytes, name, mesh, unread); !s) return s.error();
    for (const Unread& from : unread)
        takeTexels(*from.image, from.texels);
    if (Status s = checkMesh(mesh, name, true); !s) return s.error();
    return mesh;
}

struct MeshMaking::State {
    std::string name;
    ReadFile read;
    std::optional<Bytes> bytes{}; // of the file
    std::optional<Mesh> mesh{};
    std::vector<Unread> unread{};
    std::size_t next = 0; // whose texels are read

    // The file, what is in it but for texels, the texels of one texture after the other.
    std::optional<Result<std::shared_ptr<const Mesh>>> advance() {
        if (!bytes) {
            Result<Bytes> file = read(name);
            if (!file) return file.error();
            bytes = std::move(*file);
            return std::nullopt;
        }
        if (!mesh) {
            mesh.emplace();
            if (Status s = decodeVertices(*bytes, name, *mesh, unread); !s) return s.error();
            if (!unread.empty()) return std::nullopt;
        }
        if (next < unread.size()) {
            if (Status s = readTexels(unread[next++], name, read); !s) return s.error();
            if (next < unread.size()) return std::nullopt;
        }
        if (Status s = checkMesh(*mesh, name, true); !s) return s.error();
        if (mesh->normals.empty()) mesh->normals = areaWeightedNormals(mesh->positions, mesh->indices);
        return std::shared_ptr<const Mesh>(std::make_shared<Mesh>(std::move(*mesh)));
    }
};

MeshMaking::MeshMaking(std::string name, ReadFile read)
    : state_(std::make_unique<State>(State{std::move(name), std::move(read)})) {}
MeshMaking::~MeshMaking() = default;

std::optional<Result<std::shared_ptr<const Mesh>>> MeshMaking::advance() { return state_->advance(); }

} // namespace lucent::scene
