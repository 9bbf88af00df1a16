#pragma once
/// What was baked of an object, on the GPU.

#include "gl/Context.h"
#include "graph/Texture.h"
#include "techniques/throughput/Bake.h"

#include <map>
#include <memory>
#include <string>

namespace lucent::throughput {

/// Vectors are images so wide, and longer lists the other (shaders/throughput/vector.glsl).
inline constexpr int kVectorWidth = 256, kListWidth = 2048; // texels
/// The size of an image that holds so many numbers, row by row.
ivec2 listSize(std::size_t count, int width = kListWidth);

/// A sparse matrix: shaders/throughput/product.frag.
struct Matrix {
    graph::Texture starts, entries;
    int rows = 0;
};

struct BakeTextures {
    std::shared_ptr<const Bake> bake;
    graph::Texture place, frame, corners; ///< of the atlas: shaders/throughput
    graph::Texture triangles, charts;
    graph::Texture near, reach, filters;
    Matrix duals, close, inner, outer, direct;

    int side() const { return bake->surface.texels.side; } ///< of the atlas, texels
    int cornerCount() const { return 3 * int(bake->surface.hats.triangles.size()); }
    /// Adds the bytes of each texture, by its label.
    void addBytes(std::map<std::string, std::size_t>& bytes) const;
};

/// @return  Error (Fault::Machine): factors that no texture of this GPU holds
Result<std::shared_ptr<const BakeTextures>> upload(gl::Context& context, std::shared_ptr<const Bake> bake);

} // namespace lucent::throughput
