#pragma once
/// Normals and colours of a surface from photographs of it, each under one lamp far away whose direction is
/// known.

#include "base/Image.h"
#include "base/Math.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lucent::scene {

/// A photograph and where its light comes from: unit, x to the right, y up, z to the camera.
struct LitPhoto {
    std::string file; ///< as the light file names it, with / between folders
    dvec3 light;
};

/// Reads a light file (.lp): the number of photographs, then a line "FILE X Y Z" for each.
///
/// @return  Error "NAME:LINE: what was found; what was expected"; there must be 3 to 512 photographs, whose
///          directions do not lie in one plane
Result<std::vector<LitPhoto>> parseLightFile(std::span<const std::byte> bytes, const std::string& name);

/// What photographs tell of a surface.
struct SurfaceMaps {
    Image normals;     ///< 3 channels, stored c = (n + 1) / 2
    Image albedo;      ///< 3 channels, linear, relative to the brightest (its 99.9th percentile is 1), [0,1]
    Image residual;    ///< 1 channel: root mean square of what the model leaves over, per albedo; 0.01 is 1 %
    float rms = 0;     ///< of the residual, over all pixels that are not black
    float leftOut = 0; ///< share of their values that are shadows or highlights
};

/// Solves I_k = rho n . l_k for rho n, pixel by pixel, by least squares over the values that a matt surface
/// explains (Woodham 1980).
///
/// Values below a tenth of the pixel's bright ones begin as shadows. The rest is fitted by least absolute
/// deviations (reweighted least squares), which highlights of less than half of the values do not move. Then
/// every value within 3 standard deviations (from the median; 2 to 10 % of the brightness) of the fit counts
/// as matt, and the fit is repeated with those alone. Cast shadows, interreflection and lamps nearby are not
/// modelled: they show in the residual. Normals face the camera: n.z is at least 0.05.
class PhotometricStereo {
public:
    /// @param lights     unit, one a photograph, not all in a plane
    /// @param mostBytes  that photographs may take: larger ones are made smaller by a whole factor
    PhotometricStereo(std::vector<dvec3> lights, std::size_t mostBytes);

    /// Takes the next photograph. Error when its size is not that of the first.
    /// @param photo  linear
    Status add(const Image& photo, const std::string& name);

    /// Works for about that long when all photographs are there. Returns the share that is done, [0,1].
    double step(double seconds);

    /// Once step() has returned 1.
    const SurfaceMaps& maps() const { return maps_; }
    /// How many pixels of a photograph are one of the maps, along a side.
    int reduction() const { return reduction_; }

private:
    struct Pixel;
    void begin(const Image& photo, const std::string& name);
    void solveRow(int y);
    void finish();

    std::vector<dvec3> lights_;
    std::size_t mostBytes_;
    std::string first_; ///< name of the first photograph
    ivec2 photoSize_{0};
    int reduction_ = 1, row_ = 0;
    std::vector<std::uint16_t> values_; ///< half floats: of each pixel all photographs, of each three colours
    std::size_t added_ = 0;
    SurfaceMaps maps_;
    double squares_ = 0;
    std::size_t lit_ = 0, left_ = 0;
};

} // namespace lucent::scene
