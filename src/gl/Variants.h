#pragma once
/// With which feature switches a shader is compiled, as it says itself:
///
///     #pragma variants - USE_FLUX                     with the switch or without
///     #pragma variants USE_SOLID USE_BOX              with exactly one of them
///     #pragma variants FIRST=0..7                     "FIRST 0" to "FIRST 7"
///     #pragma variants - GLOBAL_BOUNDS if FROM_BITS   only where one of the switches behind `if`, which
///     stand
///                                                     in lines above, is on
///     #pragma variants - USE_BISECTION unless BESIDE  or none is

#include <string>
#include <string_view>
#include <vector>

namespace lucent::gl {

using Switches = std::vector<std::string>; ///< "USE_X", "STEPS 64"

/// All sets of switches that the lines (shaders::Stage::variants) allow; of a range its ends.
std::vector<Switches> variantsOf(std::string_view lines);

/// Whether the lines allow a set of switches, in any order.
bool isVariant(std::string_view lines, const Switches& switches);

} // namespace lucent::gl
