#pragma once
/// Values of parameters as people read, type and slide them.

#include "base/Param.h"

#include <string>
#include <vector>

namespace lucent::viewer {

/// With the digits of the slider's steps; a typed value may have more, of which up to two are shown.
std::string numberText(const Param& param, double value);
/// "3 m", "30°"
std::string withUnit(const Param& param, const std::string& number);

/// Where a value stands on its slider, [0,1].
double placeOf(const Param& param, double value);
/// The value at a place of the slider, as text that setText() reads.
std::string valueAt(const Param& param, double t);

/// The parts of a vector's text; one of anything else.
std::vector<std::string> componentTexts(const BoundParam& bound);
/// The text of a value of which one component is replaced; below 0: all of it is.
std::string withComponent(const BoundParam& bound, int component, const std::string& text);

/// A linear colour as displays show it, each channel in [0,1].
vec3 encoded(const BoundParam& bound);
/// "#rrggbb" of an encoded colour.
std::string hexText(vec3 color);
/// The same of a linear one; its numbers where it is brighter than white, which has no hex code.
std::string colorText(const BoundParam& bound);

} // namespace lucent::viewer
