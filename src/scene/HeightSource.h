#pragma once
/// How the three kinds of files become a field of heights.

#include "base/File.h"
#include "scene/Scene.h"

#include <memory>
#include <optional>
#include <span>

namespace lucent::scene {

struct SourcedHeights {
    std::shared_ptr<const Image> image; ///< 1 channel; of a normal map in [0,1]
    float texelsPerHeight = 0;          ///< of a normal map: how many texel widths high a height of 1 stands
};

/// Of a normal map as stored (heightsFromNormals() in Mesh.h).
Result<SourcedHeights> heightsOfNormals(const Image& normals, const std::string& name);

/// Decodes the file of `source`.
///
/// @param name  of the file, for messages
/// @return      Error "NAME: what was found; what was expected"
Result<SourcedHeights> loadHeights(const HeightSource& source, std::span<const std::byte> bytes,
                                   const std::string& name);
/// The same piece by piece, for who must not wait.
class HeightsMaking {
public:
    /// @param read  gives the file
    HeightsMaking(HeightSource source, std::string name, ReadFile read);
    ~HeightsMaking();
    /// One piece more; the heights once they are whole.
    std::optional<Result<SourcedHeights>> advance();

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Sinks every texel with alpha below 0.5 (nearest texel of `field.alpha`, which must be there) as deep below
/// the lowest height as the larger side of the footprint, at most 1e4 heights.
void digHoles(HeightField& field);

} // namespace lucent::scene
