#pragma once
/// Light scattered inside objects, by random walks: the physics that profiles of diffusion stand for.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Picture.h"

#include <atomic>
#include <cstdint>
#include <optional>

namespace lucent::truth {

struct WalkOptions {
    scene::Aov aov = scene::Aov::Color; ///< or Radiosity
    std::int64_t photons = 1'000'000;   ///< of the whole picture, > 0
    int samples = 256;                  ///< of each pixel of what scatters nothing; see GlassEstimator
    bool overPixels = false;            ///< of the color: that, too, as the mean over each pixel
    std::uint64_t seed = 0;
    /// Only light that was scattered so often is counted in the picture; nothing: all. Energy is all light's.
    std::optional<int> scatterings = {};
};

/// Rays of light from lamps and environment that enter bodies by Fresnel's equations, are scattered inside
/// (free ways by sigma_s, directions by Henyey and Greenstein 1941 with g, absorption by e^(-sigma_a length))
/// and meet the refracting boundary from inside: what passes it leaves, the rest is mirrored and goes on.
///
/// What leaves through a place that the camera sees is counted in the pixel that shows it, over the area that
/// a pixel covers there: radiosity B without any assumption about directions. A ray towards the eye would
/// have to be found through the boundary, which bends it; therefore the color is B F_t(w) / (pi mean F_t), by
/// the same lobe as DipoleEstimator's, and the difference of both pictures is that of the ways inside alone.
///
/// Each ray has one colour, chosen by chance. Light that has left a body is not followed to others, nor is
/// what its boundary mirrors outside, nor light that reaches it by way of glass or mirrors; light that was
/// never scattered inside leaves as well and is counted. Bodies end at their triangles, whose own normals
/// count; from open ones light may be lost. A slab is a body that thin: material.thickness is refused. Of
/// material.layers light finds the one in whose depth it is, by its distance from the nearest place of the
/// surface; their indices of refraction count at the surface only, where it is that of the top layer, and not
/// between layers. Where bodies overlap the
/// first surface met is entered and the others are not there.
///
/// Of painted bodies all of a way is as dense as the paint makes it where it began (M_d of eq. 7.4 scales
/// both coefficients), the matt share of the surface lets no light in or out and is shown as it is lit, and
/// M_i and what is painted on what leaves are factors. Where M_i is not 1 the book does not add up: paint
/// makes light or takes it.
///
/// Picture::energy: met is what arrives at bodies' outsides, reflected by them outside, absorbed inside,
/// escaped out of them again, received by what is matt
/// of them, lost given up.
///
/// @param part    of several parts each has what is not scattered in its rows, and Picture::rays for merge()
/// @param cancel  set from elsewhere to stop
/// @return        Error for another AOV, when nothing scatters, for material.thickness above 0, when
///                cancelled, or when Embree cannot hold the scene
Result<Picture> traceWalks(const scene::Scene& scene, ivec2 size, const WalkOptions& options,
                           const Tile& part, const Work& work, const std::atomic<bool>& cancel);

} // namespace lucent::truth
