#pragma once
/// Bakes in files: what `lucent bake throughput` writes and scenes name.

#include "base/File.h"
#include "scene/Scene.h"
#include "techniques/throughput/Bake.h"

#include <cstdint>
#include <string>

namespace lucent::throughput {

/// What a bake was made of: it serves no other object.
struct BakeKey {
    std::uint64_t mesh = 0; ///< of its places and triangles, and the object's scale
    Medium medium;
    BakeOptions options;
    bool operator==(const BakeKey&) const = default;
};
BakeKey keyOf(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry);
/// Tells a key from others.
std::string textOf(const BakeKey& key);

/// Bakes the object's mesh as it is at rest.
BakeMaking makingOf(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry,
                    int threads = 0);
Result<Bake> bake(const scene::Object& object, const BakeOptions& options, DipoleGeometry geometry);

/// "LUCENTTP", the version, the key and everything else, little-endian.
Bytes encodeBake(const BakeKey& key, const Bake& bake);
/// Error "NAME: what was found; what was expected": of another kind, of an earlier version, of another mesh,
/// material or settings, truncated, or with numbers that no bake has.
Result<Bake> decodeBake(std::span<const std::byte> bytes, const std::string& name, const BakeKey& expected);

} // namespace lucent::throughput
