#pragma once
/// What textures make of a surface at one place, in double precision.

#include "truth/Optics.h"

#include <functional>
#include <optional>

namespace lucent::truth {

/// The material of a hit, and the normal that its textures give it.
struct Textured {
    scene::Material material;
    Hit hit; ///< smoothNormal is the textures'
};

/// Nothing where the object has no textures (scene::texturesOf()).
///
/// Bilinear between texels in linear light (glTF 2.0, 3.8.4). Tangents are those of the triangle's own plane,
/// turned into that of the interpolated normal: u along the first of them, v against the second (3.7.2.1).
std::optional<Textured> texturedAt(const Optics& optics, const Hit& hit);

/// The share of a place of a mesh that the alpha of its colour says is there (Textures::cutoff), [0,1]; empty
/// where all is. The mesh must live as long.
std::function<double(unsigned triangle, const dvec3& weights)> opacityOf(const scene::Object& object);

} // namespace lucent::truth
