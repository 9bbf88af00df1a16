#pragma once
/// White light as a number of wavelengths, for glass whose index of refraction depends on them.

#include "base/Math.h"

#include <vector>

namespace lucent::caustics {

/// Light of one index of refraction.
struct Tint {
    vec3 color{1};        ///< its part of white, linear Rec. 709; below 0 where no screen can show the colour
    int channel = 1;      ///< whose index of refraction it has (views::iorsOf)
    float wavelength = 0; ///< nm; above 0: it has the index of this instead
};

/// @param count  3: the channels, each with its own index. More: the middles of so many equal parts of 400 to
///               700 nm, with the CIE 1931 observer's colour of each part; the sum over all of them is white
///               in every channel
std::vector<Tint> tints(int count);

/// Index of refraction at a wavelength, by A + B / wavelength².
///
/// @param iors        views::iorsOf: at the lines C, d, F
/// @param wavelength  nm
float iorAt(vec3 iors, float wavelength);

} // namespace lucent::caustics
