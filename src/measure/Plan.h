#pragma once
/// What a benchmark measures, as data: a case, a method or a setting is one line.

#include "measure/BenchReport.h"
#include "measure/Stopwatch.h"
#include "scene/Scene.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lucent::measure {

/// A method with its knobs: parameters of its technique, as a scene file spells them, or of another table
/// ("sampling.directions"). The method is one of
/// the choices of its technique's "method", or of the first of its parameters that offers it; else a mere
/// name.
struct Setting {
    std::string method;
    std::vector<std::pair<std::string, std::string>> knobs{};
    bool ownModel = false; ///< solves another model: its distance from ours is model error, and it runs in no
                           ///< race
    bool isPhysics = false; ///< solves the physics itself: its distance from that is model error, and it runs
                            ///< in no race
    bool bakes = false;     ///< prepares a field before its first picture: that time is measured apart

    /// "march steps=256"
    std::string name() const;
    /// Sets the method and the knobs in a scene. Error of the parameter that refuses.
    Status putInto(scene::Scene& scene, const std::string& technique) const;
};

/// Scenes are made when their turn comes: large fields need not be in memory together.
struct MakeScene {
    std::function<Result<scene::Scene>()> make;
    double rays = 0; ///< about its pixels times lights: only for the share of the work that is done

    Result<scene::Scene> operator()() const { return make(); }
};

/// What a time is of: a picture less another one of the same scene.
struct Timed {
    std::function<void(scene::Scene&)> with, without;
};
/// What the scene shows, less the same without light.
Timed timedLight();

/// One scene on which every setting is measured against the exact solution.
struct Case {
    std::string technique, name;
    MakeScene scene; ///< view.show is the quantity that is compared
    std::vector<Setting> settings;
    /// Makes the scene whose exact solution is the physics behind the model; empty: none is known.
    std::function<void(scene::Scene&)> toPhysics;
    /// Of scenes that show directions, instead: makes the one whose exact solution counts the layers of
    /// glass.
    std::function<void(scene::Scene&)> toLayers{};
    Timed timed = timedLight();
    /// Compares light that a floor receives by way of something: what the timed pictures differ by.
    bool comparesTimed = false;
    /// The exact picture of that, where a closed form of it is known; empty: it is solved.
    std::function<Image()> closedForm{};
};

/// One setting on scenes of growing size.
struct Series {
    std::string technique, over;
    Setting setting;
    struct Point {
        double x;
        MakeScene scene;
    };
    std::vector<Point> points;
    Timed timed = timedLight();
    std::string part{}; ///< of the picture that is timed; empty: all of it

    /// "march steps=256, views"
    std::string name() const;
};

/// A scene on which methods tend to break.
struct HardCase {
    std::string name;
    MakeScene scene;                    ///< or the message by which the scene must be refused
    std::optional<MakeScene> reference; ///< the scene whose exact solution counts; nothing: the same
};

/// Such scenes of one technique, each drawn with every setting.
struct HardTable {
    std::string technique;
    std::vector<HardCase> cases;
    std::vector<Setting> settings;
    /// A method passes where 99 % of the pixels are as near: within one step of an 8-bit display.
    double tolerance = 1.0 / 255;
};

/// Reads a figure off a report; nothing when what it needs was not measured.
using RatioRule = std::function<std::optional<Ratio>(const BenchReport&)>;

/// What was measured of a setting on a case; null when there is no time or no error of it.
const Measurement* measured(const BenchReport& report, std::string_view technique, const std::string& scene,
                            const Setting& setting);

struct Plan {
    bool quick = false;
    int directions = 4096; ///< of an exact environment
    int truthParts = 32; ///< steps in which an exact solution is made, so that a page stays alive; 1: at once
    Repeats repeats;
    std::vector<Case> cases;
    std::vector<Series> series;
    std::vector<HardTable> hard;
    std::vector<RatioRule> ratios;
};

} // namespace lucent::measure
