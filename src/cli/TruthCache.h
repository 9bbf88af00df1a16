#pragma once
/// Exact solutions kept in a folder under a name made of everything they depend on.

#include "base/Result.h"
#include "scene/Scene.h"
#include "truth/Picture.h"

#include <functional>
#include <string>

namespace lucent::cli {

/// Where the exact solution of a scene with this many directions lies in `folder`: its name changes with the
/// scene, its images and the sources of the solver.
std::string truthPath(const std::string& folder, const scene::Scene& scene, int directions);

/// The picture of `path`, or what `solve` gives, which is kept there for the next time.
Result<truth::Picture> cachedTruth(const std::string& path,
                                   const std::function<Result<truth::Picture>()>& solve);

} // namespace lucent::cli
