#pragma once
/// Everything on everything: each kind of lamp, past each kind of object, on each kind of receiver, against
/// the exact solution.

#include "base/Image.h"
#include "base/Result.h"
#include "gl/Context.h"
#include "scene/Scene.h"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::measure {

/// One cell of the matrix.
struct ComposeCell {
    std::string lamp, between, receiver;
    std::string message{};    ///< why there is no figure; "": there is one
    double misplaced = 0;     ///< half the summed absolute difference over the light there is
    double byNoise = 0;       ///< what of that is to be expected from the truth's noise alone
    double flux = 0;          ///< picture's light over the truth's
    double target = 0;        ///< of misplaced
    double seconds = 0;       ///< that the picture took
    Image picture{}, truth{}; ///< linear

    bool isMeasured() const { return message.empty(); }
    bool isMet() const { return isMeasured() && misplaced <= target && std::abs(flux - 1) <= 0.01; }
    std::string name() const { return lamp + " / " + between + " / " + receiver; }
};

std::span<const std::string_view> composeLamps();
std::span<const std::string_view> composeBetween();
std::span<const std::string_view> composeReceivers();

/// The scene of a cell: a receiver of 1 m around the origin, seen straight from above, or so in a mirror;
/// what stands between hides from the camera and hangs over its middle.
///
/// @param lamp, between, receiver  of the lists above
scene::Scene composeScene(std::string_view lamp, std::string_view between, std::string_view receiver);

/// Draws and solves one cell.
ComposeCell measureCompose(gl::Context& context, std::string_view lamp, std::string_view between,
                           std::string_view receiver);

/// The matrix as JSON: one object a cell.
std::string composeJson(std::span<const ComposeCell> cells);

} // namespace lucent::measure
