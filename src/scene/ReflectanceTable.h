#pragma once
/// Measured BRDFs as pictures: for each pair of directions a texel with the BRDF, 1/sr of each colour.
///
/// Merl: kMerlSize texels, row by row 90 angles between normal and halfway direction (denser near 0: index 90
/// sqrt(theta_h / 90°)), of each 90 between halfway direction and light, of each 180 of the light around the
/// halfway direction up to 180° (Matusik et al. 2003). Below 0: nothing was measured there.
///
/// Projected, EqualArea: n x n blocks of m x m texels: the light's direction chooses a block, the view's a
/// texel in it (image-space dissertation 2007, figure 2.12). Projected takes both directions' parts along the
/// surface,
/// [-1, 1]², as the dissertation does; the corners, a fifth, are of no direction, and near the horizon one
/// texel holds many. EqualArea gives each texel the same solid angle: Lambert's equal-area disc, made a
/// square by Shirley and Chiu 1997.

#include "base/File.h"
#include "base/Image.h"
#include "scene/Scene.h"

#include <functional>
#include <memory>
#include <string>

namespace lucent::scene {

inline constexpr ivec2 kMerlSize{1800, 810};
inline constexpr int kMerlHalf = 90, kMerlDifference = 90, kMerlAround = 180;

/// A table as a file has it: MERL's own format (three whole numbers, then red, green and blue values as
/// doubles), or a picture. Error "NAME: what; expected" for other sizes than the form asks for and values
/// that are not finite.
///
/// @param blocks  n, of a form that has blocks; 0: as many as each has texels a side
Result<std::shared_ptr<const Image>> decodeTable(std::span<const std::byte> bytes, const std::string& name,
                                                 TableForm form, int blocks);

/// The same in MERL's format. Of a table of that form.
Bytes encodeMerl(const Image& table);

/// BRDF of light from one direction in another; z is the normal, both above the surface.
using Brdf = std::function<vec3(const dvec3& toLight, const dvec3& toEye)>;

/// A table of any BRDF, taken at the middles of texels.
///
/// @param blocks, texels  n and m; of no meaning to Merl
Image tabulate(const Brdf& brdf, TableForm form, int blocks, int texels);

/// Error "has ...; must have ..." for a table whose size is none of its form.
Status checkTable(const Image& table, TableForm form, int blocks);

/// The BRDF between a table's texels; z is the normal. 0 below the surface, and where nothing was measured
/// around.
dvec3 lookUp(const Image& table, TableForm form, int blocks, const dvec3& toLight, const dvec3& toEye);

/// What a table of a BRDF would say, of which only the texels around are taken: as lookUp(tabulate(...)).
///
/// @param form  one with blocks
dvec3 lookUp(const Brdf& brdf, TableForm form, int blocks, int texels, const dvec3& toLight,
             const dvec3& toEye);

/// n of a table with blocks: `blocks`, or where that is 0 the root of the table's side.
int blocksOf(const Image& table, int blocks);

/// Where on a square [0, 1]² a direction lies, and back. Places beside the disc of Projected are those of the
/// rim.
dvec2 squareFrom(const dvec3& direction, TableForm form);
dvec3 directionFrom(dvec2 square, TableForm form);

} // namespace lucent::scene
