#pragma once
/// Pictures whose pixels are estimates: solved pixel by pixel, by several threads, whole or in tiles.

#include "base/Image.h"
#include "base/Math.h"
#include "base/Result.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

namespace lucent::truth {

/// What an estimator knows about a pixel.
struct Pixel {
    dvec3 value{0};      ///< linear Rec. 709
    dvec3 variance{0};   ///< of `value` as an estimate: the square of its standard error
    double coverage = 0; ///< [0,1]
};

/// Solves pixels one at a time, each on its own: by gathering the light that reaches the eye through it. What
/// it needs for all of them (fields, lights, maps of light) it prepares when it is made.
class Estimator {
public:
    virtual ~Estimator() = default;
    /// The same pixel gives the same value on whatever thread and in whatever order.
    virtual Pixel solve(ivec2 pixel) const = 0;
};

/// The mean over each pixel, by another estimator that solves its places: so many that no two lie in the same
/// row or column of the pixel (n-rooks, Shirley 1991), elsewhere in each pixel. A straight edge along a side
/// errs by 1 / (2 places) at most. The variance is that of independent places: rather more than there is.
class PixelMean : public Estimator {
public:
    static constexpr int kPlaces = 16, kMostPlaces = 256;
    /// Of what is seen by single rays, where a pixel should have so many samples, > 0: glass breaks up what
    /// is behind it into parts smaller than a pixel, so each sample has a place of its own.
    static int placesFor(int samples) { return std::clamp(samples, kPlaces, kMostPlaces); }
    /// Of the picture whose pixels are the places of one of `size` pixels.
    static ivec2 sizeOf(ivec2 size, int count = kPlaces) { return count * size; }
    /// Samples of each place, where a pixel should have so many, > 0.
    static int samplesOf(int samples, int count = kPlaces) { return (samples + count - 1) / count; }

    /// @param places  of a picture of sizeOf() its pixels
    /// @param count   of each pixel, > 1
    PixelMean(std::unique_ptr<const Estimator> places, std::uint64_t seed, int count = kPlaces)
        : places_(std::move(places)), seed_(seed), count_(count) {}
    /// Light of what is covered, and the mean of the coverage.
    Pixel solve(ivec2 pixel) const override;

private:
    std::unique_ptr<const Estimator> places_;
    std::uint64_t seed_;
    int count_;
};

/// A part of a picture: every `count`-th row, and every `count`-th light ray where there are such, from
/// number `index` on. Neighbouring rows cost about the same, so all parts take about as long.
struct Tile {
    int index = 0; ///< [0, count)
    int count = 1;
    int rows(int height) const { return (height - index + count - 1) / count; }
    std::int64_t photons(std::int64_t all) const { return (all - index + count - 1) / count; }
    int row(int inside) const { return index + inside * count; }
};

/// What became of light that met something refractive or mirroring, W of each colour. Every entry is counted
/// on its own; the first is the sum of the others.
struct EnergyBook {
    dvec3 incident{0};
    dvec3 received{0};  ///< by opaque surfaces
    dvec3 absorbed{0};  ///< by media and mirrors
    dvec3 reflected{0}; ///< at interfaces and not followed: the chain's simplification
    dvec3 escaped{0};   ///< left the scene
    dvec3 lost{0};      ///< given up inside

    /// An entry and its name in files.
    struct Entry {
        const char* name;
        dvec3 EnergyBook::*value;
    };
    static const std::array<Entry, 6> kEntries;
};
inline constexpr std::array<EnergyBook::Entry, 6> EnergyBook::kEntries{{{"incident", &EnergyBook::incident},
                                                                        {"received", &EnergyBook::received},
                                                                        {"absorbed", &EnergyBook::absorbed},
                                                                        {"reflected", &EnergyBook::reflected},
                                                                        {"escaped", &EnergyBook::escaped},
                                                                        {"lost", &EnergyBook::lost}}};

struct Rays;

/// A picture, or the rows of one tile.
struct Picture {
    Image values;                     ///< 4 channels: linear light and coverage
    Image errors;                     ///< 3 channels: the standard error of each value
    std::optional<EnergyBook> energy; ///< of pictures by light rays
    std::shared_ptr<Rays> rays;       ///< of tiles of such pictures: what is to be added to all rows

    Picture() = default;
    explicit Picture(ivec2 size) : values(size.x, size.y, 4), errors(size.x, size.y, 3) {}
    /// Root of the mean squared standard error over all pixels and colours: the RMSE that this picture must
    /// be expected to have against one without noise.
    double standardError() const;
};

/// How the work is done; no picture depends on it.
struct Work {
    int threads = 0; ///< 0: as many as the machine has
    /// Called now and then, always from the calling thread, with the finished share in [0,1].
    std::function<void(double)> progress = [](double) {};
};

/// Solves the rows of a tile of a picture of `size` pixels.
///
/// @param cancel  set from elsewhere to stop
/// @return        the tile's rows; Error when cancelled
Result<Picture> render(const Estimator& estimator, ivec2 size, const Tile& tile, const Work& work,
                       const std::atomic<bool>& cancel);

} // namespace lucent::truth
