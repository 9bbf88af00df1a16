#pragma once
/// The spaces above the triangles of displaced surfaces, in which rays are cast.

#include "gl/Device.h"
#include "scene/Displacement.h"

#include <cstddef>

namespace lucent::views {

/// The prisms above the triangles of a base on the GPU.
struct Prisms {
    graph::Texture texels; ///< RGBA32F, of shaders/views/prism.glsl
    graph::Indices hulls;  ///< of shaders/views/displaced.vert

    Prisms(gl::Device& device, const scene::DisplacedBase& base);
    std::size_t bytes() const { return texels.desc().bytes() + 4 * std::size_t(hulls.count()); }
    /// Of the texture for so many triangles; larger than a GPU allows where these are too many.
    static ivec2 sizeFor(std::size_t triangles);
};

} // namespace lucent::views
