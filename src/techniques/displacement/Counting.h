#pragma once
/// What the ray casts of displaced surfaces cost, and what they miss.

#include "technique/Guest.h"

namespace lucent::displacement {

/// Draws how many places or cells the rays of displaced surfaces looked at above the triangle that they
/// meet, into alpha.
///
/// @param clears  nobody has drawn into the target yet
Status recordIterations(const technique::Passes& passes, gl::Context& context, graph::TextureId target,
                        bool clears);

/// Draws white where the exact ray cast meets a displaced surface and the chosen one meets nothing of it
/// within 1/256 of its highest height along the view, black on the rest of these surfaces, and nothing
/// elsewhere.
Status recordMisses(const technique::Passes& passes, gl::Context& context, graph::TextureId target);

} // namespace lucent::displacement
