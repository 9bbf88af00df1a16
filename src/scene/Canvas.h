#pragma once
/// Hands on a painted object: dabs, strokes, and taking them back.

#include "scene/Painting.h"

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace lucent::scene {

/// The texels that reading an atlas takes, with the places of the surface at rest that they stand for. Beyond
/// the border of a chart its nearest triangle goes on, so that what lies between texels is right up to the
/// border.
class PaintSurface {
public:
    struct Texel {
        vec3 place, normal;   ///< object space, unit
        std::uint32_t number; ///< row by row
    };
    /// Ordered by where they lie, not by number.
    const std::vector<Texel>& texels() const { return texels_; }
    int side() const { return side_; }

    /// Calls `found(texel)` for those within a distance, and some more.
    template <class Found>
    void forEachNear(vec3 centre, float distance, Found found) const {
        const ivec3 from = cellOf(centre - distance), to = cellOf(centre + distance);
        for (int z = from.z; z <= to.z; ++z)
            for (int y = from.y; y <= to.y; ++y) {
                const std::size_t row =
                    (std::size_t(z) * std::size_t(cells_.y) + std::size_t(y)) * std::size_t(cells_.x);
                for (std::uint32_t i = starts_[row + std::size_t(from.x)];
                     i < starts_[row + std::size_t(to.x) + 1]; ++i)
                    found(texels_[i]);
            }
    }

private:
    using ivec3 = glm::ivec3;
    ivec3 cellOf(vec3 place) const {
        return ivec3(glm::clamp((place - low_) / cell_, vec3(0), vec3(cells_ - 1)));
    }
    friend class PaintSurfaceMaking;
    void sort();

    int side_ = 0;
    std::vector<Texel> texels_;
    vec3 low_{0};
    float cell_ = 1; // edge, m
    ivec3 cells_{1};
    std::vector<std::uint32_t> starts_; // where each cell's texels begin, x fastest; one more for the end
};

/// Makes one piece by piece, for who must not wait.
class PaintSurfaceMaking {
public:
    using Made = std::shared_ptr<const PaintSurface>;
    explicit PaintSurfaceMaking(std::shared_ptr<const Atlas> atlas);
    /// One piece more; the surface once it is whole.
    std::optional<Made> advance();

private:
    std::shared_ptr<const Atlas> atlas_;
    std::vector<std::uint32_t> triangles_; // nearest to each texel,
    std::vector<float> distances_;         // and how far away
    std::size_t triangle_ = 0, texel_ = 0; // to come next
    std::shared_ptr<PaintSurface> surface_;
};

/// That of an object; made once for the last few atlases. Error where its mesh does not fit.
Result<std::shared_ptr<const PaintSurface>> paintSurfaceOf(const Object& object, int side);

/// Maps that are being painted, and every stroke that was. What a stroke did is kept tile by tile while
/// `budget` lasts; older ones are undone by painting anew from the last state that was kept. Either way the
/// same bits come back.
class Canvas {
public:
    static constexpr std::size_t kBudget = std::size_t(64) << 20; ///< bytes

    /// @param scale     of the object: brushes are measured in the world
    /// @param entering  what is there before the first stroke, as large as the surface's picture; null:
    /// unpainted
    /// @param start     translucency that erasing brings back; nothing: that of the canvas's own first stroke
    Canvas(std::shared_ptr<const PaintSurface> surface, float scale, std::shared_ptr<const Image> entering,
           std::shared_ptr<const Image> leaving, std::size_t budget = kBudget,
           std::optional<float> start = {});

    /// A stroke of dabs: between begin() and end() the maps show what there is of it already.
    void begin(const Brush& brush);
    void dab(const Dab& dab);
    void end();
    bool isOpen() const { return open_; }
    /// A whole stroke.
    void add(const Stroke& stroke);
    /// A part of it, where it fills much, for who must not wait: to be called again with the same stroke.
    ///
    /// @return whether it is whole
    bool addSome(const Stroke& stroke);

    /// @return false where there is nothing to take back, or to do again
    bool undo();
    bool redo();

    /// Those that are done, the oldest first; without one that is open.
    std::span<const Stroke> strokes() const { return std::span(strokes_).first(done_); }
    /// As they are now; the same pointer until a map changes.
    std::shared_ptr<const Image> entering() const { return shown(0); }
    std::shared_ptr<const Image> leaving() const { return shown(1); }
    /// What is kept to undo with.
    std::size_t bytes() const;

private:
    static constexpr int kTile = 32; // texels
    using Maps = std::array<std::shared_ptr<const Image>, 2>;
    struct Tile {
        int number;
        std::vector<vec4> before;
    };
    struct Step {
        int map = 0;
        std::vector<Tile> tiles;
        std::size_t bytes() const { return tiles.size() * kTile * kTile * sizeof(vec4); }
    };

    std::shared_ptr<const Image> shown(int map) const {
        own_[std::size_t(map)] = nullptr;
        return maps_[std::size_t(map)];
    }
    void apply(const Stroke& stroke);
    void close();
    void touch(vec3 centre, vec3 normal, float radius);
    bool fillSome(const Stroke::Fill& fill);
    void cover(std::uint32_t texel, float coverage);
    vec3 target() const;
    vec4 blended(const vec4& before, float share) const;
    Image& writable(int map);
    Tile& tileOf(std::uint32_t texel);
    std::size_t inTile(std::uint32_t texel) const;
    void restore(const Step& step);
    void replay(std::size_t count);
    std::size_t checkpointBytes() const;

    std::shared_ptr<const PaintSurface> surface_;
    float scale_;
    std::size_t budget_;
    std::optional<float> start_;
    Maps maps_;
    mutable std::array<Image*, 2> own_{}; // of those that nobody else has: what is shown never changes
    std::vector<Stroke> strokes_;
    std::size_t done_ = 0; // strokes; those behind were undone

    // The stroke that is open.
    bool open_ = false;
    Brush brush_;
    Stroke stroke_;
    Step step_;
    std::size_t filled_ = 0;       // of the surface's texels
    std::vector<float> coverage_;  // largest so far
    std::vector<int> tileNumbers_; // in step_, -1: untouched

    std::deque<Step> steps_; // of the last strokes that are done
    std::size_t stepBytes_ = 0;
    std::map<std::size_t, Maps> checkpoints_; // by number of strokes; always one at 0
    std::size_t interval_ = 32;               // strokes between two of them
};

} // namespace lucent::scene
