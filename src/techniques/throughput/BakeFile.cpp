#include "techniques/throughput/BakeFile.h"

#include "scene/Mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace lucent::throughput {

namespace {

constexpr std::string_view kMagic = "LUCENTTP";
constexpr std::uint32_t kVersion = 2;
static_assert(std::endian::native == std::endian::little, "bakes are written as they lie in memory");
static_assert(sizeof(Texel) == 36 && sizeof(std::array<vec2, 3>) == 24, "nothing lies between members");

class Writer {
public:
    template <class T>
    void value(const T& v, const char*) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&v, sizeof v);
    }
    template <class T>
    void list(const std::vector<T>& values, const char* what) {
        value(std::uint64_t(values.size()), what);
        append(values.data(), values.size() * sizeof(T));
    }
    Bytes take() { return std::move(bytes_); }

private:
    void append(const void* data, std::size_t size) {
        const auto* begin = static_cast<const std::byte*>(data);
        bytes_.insert(bytes_.end(), begin, begin + size);
    }
    Bytes bytes_;
};

// Behind the first thing that the file is too short for, nothing is read any more.
class Reader {
public:
    explicit Reader(std::span<const std::byte> rest) : rest_(rest) {}
    template <class T>
    void value(T& v, const char* what) {
        if (has(1, sizeof v, what)) take(&v, sizeof v);
    }
    template <class T>
    void list(std::vector<T>& values, const char* what) {
        std::uint64_t count = 0;
        value(count, what);
        if (!has(count, sizeof(T), what)) return;
        values.resize(std::size_t(count));
        take(values.data(), values.size() * sizeof(T));
    }
    const std::string& missing() const { return missing_; }
    std::size_t left() const { return rest_.size(); }

private:
    bool has(std::uint64_t count, std::size_t size, const char* what) {
        if (missing_.empty() && count > rest_.size() / size)
            missing_ = "the bake ends in its " + std::string(what) + ", of which " +
                       std::to_string(rest_.size()) + " bytes are there; must have " + std::to_string(count) +
                       " times " + std::to_string(size);
        return missing_.empty();
    }
    void take(void* to, std::size_t size) {
        if (size > 0) std::memcpy(to, rest_.data(), size);
        rest_ = rest_.subspan(size);
    }
    std::span<const std::byte> rest_;
    std::string missing_;
};

// What the file holds, in its order; File is a Writer or a Reader.
template <class File, class Key>
void keyFields(File& file, Key& key) {
    file.value(key.mesh, "key");
    for (auto& color : key.medium.colors) {
        file.value(color.scattering, "key");
        file.value(color.absorption, "key");
        file.value(color.ior, "key");
    }
    file.value(key.medium.geometry, "key");
    auto& options = key.options;
    file.value(options.side, "key");
    file.value(options.local, "key");
    file.value(options.blend, "key");
    file.value(options.factors.method, "key");
    file.value(options.factors.threshold, "key");
    file.value(options.factors.epsilon, "key");
    file.value(options.factors.quadrature, "key");
    file.value(options.factors.diagonal, "key");
}

template <class File, class Table>
void rowFields(File& file, Table& rows, const char* what) {
    file.list(rows.starts, what);
    file.list(rows.columns, what);
    file.list(rows.values, what);
}

template <class File, class Baked>
void bakeFields(File& file, Baked& bake) {
    auto& hats = bake.surface.hats;
    file.list(hats.positions, "vertices");
    file.list(hats.normals, "vertices");
    file.list(hats.areas, "vertices");
    file.list(hats.triangles, "triangles");
    file.list(hats.triangleAreas, "triangles");
    file.list(hats.sources, "triangles");
    file.list(hats.across, "triangles");
    auto& texels = bake.surface.texels;
    file.value(texels.side, "texels");
    file.value(texels.size, "texels");
    file.list(texels.list, "texels");
    file.list(texels.indexAt, "texels");
    file.list(bake.surface.places, "places");
    rowFields(file, bake.surface.duals, "dual basis");
    file.value(bake.factors.method, "factors");
    file.value(bake.factors.count, "factors");
    file.list(bake.factors.dense, "factors");
    rowFields(file, bake.factors.close, "factors");
    rowFields(file, bake.factors.inner, "factors");
    rowFields(file, bake.factors.outer, "factors");
    file.list(bake.filters.factors, "filters");
    rowFields(file, bake.filters.direct, "filters");
    file.value(bake.cut, "reach");
    file.value(bake.radius, "reach");
    file.list(bake.reach, "reach");
}

// Whether rows are so many and name nothing beyond what they are multiplied by.
template <class Value>
bool isWhole(const Rows<Value>& rows, std::size_t count, std::size_t columns) {
    return rows.count() == count && std::is_sorted(rows.starts.begin(), rows.starts.end()) &&
           rows.starts.front() == 0 && rows.starts.back() == rows.columns.size() &&
           rows.values.size() == rows.columns.size() &&
           std::all_of(rows.columns.begin(), rows.columns.end(),
                       [&](std::uint32_t c) { return c < columns; });
}

bool isWhole(const Bake& bake) {
    const Hats& hats = bake.surface.hats;
    const Texels& texels = bake.surface.texels;
    const std::size_t vertices = hats.count(), triangles = hats.triangles.size(), count = texels.list.size();
    const auto indicesBelow = [](const auto& list, std::size_t end) {
        return std::all_of(list.begin(), list.end(), [&](const auto& three) {
            return std::all_of(three.begin(), three.end(),
                               [&](std::uint32_t i) { return i < end || i == Hats::kNone; });
        });
    };
    if (hats.normals.size() != vertices || hats.areas.size() != vertices ||
        hats.triangleAreas.size() != triangles || hats.sources.size() != triangles ||
        hats.across.size() != triangles || bake.surface.places.size() != triangles ||
        !indicesBelow(hats.triangles, vertices) || !indicesBelow(hats.across, triangles))
        return false;
    if (texels.side < 1 || texels.side > 4096 || !(texels.size > 0) ||
        texels.indexAt.size() != std::size_t(texels.side) * std::size_t(texels.side))
        return false;
    for (const Texel& texel : texels.list)
        if (texel.place.triangle >= triangles || texel.at.x < 0 || texel.at.y < 0 ||
            texel.at.x >= texels.side || texel.at.y >= texels.side)
            return false;
    for (const std::int32_t index : texels.indexAt)
        if (index < -1 || index >= std::int32_t(count)) return false;
    const Factors& factors = bake.factors;
    const bool isDense = factors.method == Global::Dense;
    const bool isHierarchical = factors.method == Global::Hierarchical;
    const std::size_t moments = isHierarchical ? factors.inner.count() : 0;
    const bool isStored = bake.options.local == Local::Stored;
    constexpr std::size_t kFilter = std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth);
    return isWhole(bake.surface.duals, vertices, count) && factors.count == vertices &&
           factors.method == bake.options.factors.method &&
           factors.dense.size() == (isDense ? vertices * vertices : 0) &&
           isWhole(factors.close, isDense ? 0 : vertices, vertices) &&
           isWhole(factors.inner, moments, vertices) &&
           isWhole(factors.outer, isHierarchical ? vertices : 0, moments) &&
           bake.filters.factors.size() == (isStored ? count * kFilter : 0) &&
           isWhole(bake.filters.direct, isStored ? vertices : 0, count) && bake.radius > 0 &&
           bake.radius < 64 && bake.reach.size() == (isStored ? 0 : count);
}

// FNV-1a.
class Fingerprint {
public:
    void add(const void* data, std::size_t size) {
        for (std::size_t i = 0; i < size; ++i)
            value_ = (value_ ^ std::uint64_t(static_cast<const unsigned char*>(data)[i])) * 0x100000001b3u;
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::string inHex(std::uint64_t value) {
    std::string text;
    for (int shift = 60; shift >= 0; shift -= 4)
        text += "0123456789abcdef"[value >> shift & 15];
    return text;
}

Medium mediumOf(const scene::Object& object, DipoleGeometry geometry) {
    Medium medium{diffusion::mediaOf(object.material), geometry};
    for (diffusion::Medium& color : medium.colors)
        color.above.clear();
    return medium;
}

} // namespace

BakeKey keyOf(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry) {
    const std::shared_ptr<const scene::Mesh> mesh = scene::meshOf(object);
    Fingerprint fingerprint;
    fingerprint.add(mesh->positions.data(), mesh->positions.size() * sizeof(vec3));
    fingerprint.add(mesh->indices.data(), mesh->indices.size() * sizeof(std::uint32_t));
    fingerprint.add(mesh->normals.data(), mesh->normals.size() * sizeof(vec3));
    fingerprint.add(&object.transform.scale, sizeof(float));
    return {fingerprint.value(), mediumOf(object, geometry), options};
}

std::string textOf(const BakeKey& key) {
    Writer fields;
    BakeKey copy = key;
    keyFields(fields, copy);
    const Bytes bytes = fields.take();
    Fingerprint fingerprint;
    fingerprint.add(bytes.data(), bytes.size());
    return inHex(fingerprint.value());
}

BakeMaking makingOf(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry,
                    int threads) {
    return {scene::meshOf(object), object.transform.scale, mediumOf(object, geometry), options, threads};
}

Result<Bake> bake(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry) {
    return makingOf(object, options, geometry).finish();
}

Bytes encodeBake(const BakeKey& key, const Bake& bake) {
    Writer file;
    for (const char c : kMagic)
        file.value(c, "");
    file.value(kVersion, "");
    keyFields(file, key);
    bakeFields(file, bake);
    return file.take();
}

Result<Bake> decodeBake(std::span<const std::byte> bytes, const std::string& name, const BakeKey& expected) {
    if (bytes.size() < kMagic.size() || std::memcmp(bytes.data(), kMagic.data(), kMagic.size()) != 0)
        return Error{name + ": is no bake; must be a file of lucent bake throughput"};
    Reader file(bytes.subspan(kMagic.size()));
    std::uint32_t version = 0;
    file.value(version, "version");
    if (file.missing().empty() && version != kVersion)
        return Error{name + ": is a bake of version " + std::to_string(version) + "; must be of version " +
                     std::to_string(kVersion) + ": bake again"};
    BakeKey key;
    keyFields(file, key);
    if (!file.missing().empty()) return Error{name + ": " + file.missing()};
    if (key.mesh != expected.mesh)
        return Error{name + ": is baked of another mesh, " + inHex(key.mesh) + "; must be of " +
                     inHex(expected.mesh) + ": bake again"};
    if (key.medium != expected.medium)
        return Error{name + ": is baked of another material; must be of the object's: bake again"};
    if (key.options != expected.options)
        return Error{name + ": is baked with other settings; must be with the scene's: bake again"};
    Bake bake;
    bake.options = key.options;
    bake.medium = key.medium;
    bakeFields(file, bake);
    if (!file.missing().empty()) return Error{name + ": " + file.missing()};
    if (file.left() > 0)
        return Error{name + ": has " + std::to_string(file.left()) +
                     " bytes behind its bake; must end there"};
    if (!isWhole(bake)) return Error{name + ": holds numbers that no bake has; must be baked again"};
    return bake;
}

} // namespace lucent::throughput
