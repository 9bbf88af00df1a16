#pragma once
/// Parts of a truth as files that know what they belong to, and putting them together again. A part holds
/// some of the picture's rows and, of pictures by light rays, what some of the rays bring to the whole.

#include "base/File.h"
#include "base/Math.h"
#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Picture.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lucent::truth {

/// What a truth is the truth of: two with equal facts have the same pixels.
struct Facts {
    std::string scene;       ///< its file, as it was named
    std::string fingerprint; ///< of the scene with everything it loaded; see fingerprint()
    ivec2 size{0};
    std::string aov;       ///< "color", "d", "direction", ...
    std::string estimator; ///< "relief", "lambert", "glass", "glass-tree", "light", "light-tree", "dipole" or
                           ///< "walk"
    std::uint64_t seed = 0;
    int samples = 0;          ///< of discs; for all but relief of the environment as well
    int directions = 0;       ///< of the environment, for relief
    std::int64_t photons = 0; ///< light rays of the whole picture; 0: the picture is made pixel by pixel
    bool antialias = false;   ///< samples lie all over each pixel
    float exposure = 0;       ///< ev, for a picture as it is displayed
};

/// 16 hexadecimal digits that change when a parameter or a texel of the scene does.
std::string fingerprint(const scene::Scene& scene);

/// JSON with the facts, the picture's standard error (Picture::standardError) and the fluxes of its light
/// rays.
std::string sidecar(const Facts& facts, const Picture& picture);

/// A part of a picture with what it belongs to.
struct Part {
    Facts facts;
    Tile tile;
    Picture rows;
};

Bytes encodePart(Part part);

/// Error "NAME: what was found; what was expected" when the bytes are no part, or not a whole one.
Result<Part> decodePart(std::span<const std::byte> bytes, const std::string& name);

/// Puts all parts of one picture together, in any order: equal, bit by bit, to the picture made in one piece.
///
/// @param names  of the parts, for messages
/// @return       Error that names the part which belongs elsewhere or is given twice, or those that are
/// missing
Result<Picture> merge(std::span<const Part> parts, std::span<const std::string> names);

} // namespace lucent::truth
