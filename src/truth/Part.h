#pragma once
/// Tiles of a truth as files that know what they belong to, and putting them together again.

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
    std::string aov;       ///< "color" or "d"
    std::string estimator; ///< "relief" or "lambert"
    std::uint64_t seed = 0;
    int samples = 0;    ///< of discs; of discs and the environment for lambert
    int directions = 0; ///< of the environment, for relief
    float exposure = 0; ///< ev, for a picture as it is displayed
};

/// 16 hexadecimal digits that change when a parameter or a texel of the scene does.
std::string fingerprint(const scene::Scene& scene);

/// JSON with the facts, the picture's standard error (Picture::standardError) and how many pixels it was
/// taken over.
std::string sidecar(const Facts& facts, const Picture& picture);

/// A part of a picture with what it belongs to.
struct Part {
    Facts facts;
    Tile tile;
    Picture rows;
};

Bytes encodePart(const Part& part);

/// Error "NAME: what was found; what was expected" when the bytes are no part, or not a whole one.
Result<Part> decodePart(std::span<const std::byte> bytes, const std::string& name);

/// Puts all parts of one picture together, in any order. Equal, bit by bit, to the picture made in one piece.
///
/// @param names  of the parts, for messages
/// @return       Error that names the part which belongs elsewhere or is given twice, or those that are
/// missing
Result<Picture> merge(std::span<const Part> parts, std::span<const std::string> names);

} // namespace lucent::truth
