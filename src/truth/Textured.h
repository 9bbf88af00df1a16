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

/// Where the alpha of a mesh's colour says that nothing is (Textures::cutoff); empty without such places. The
/// mesh must live as long.
std::function<bool(unsigned triangle, const dvec3& weights)> holesOf(const scene::Object& object);

} // namespace lucent::truth
