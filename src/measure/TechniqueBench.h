#pragma once
/// What techniques have measured: the parts of `lucent bench`.

#include "measure/Fields.h"
#include "measure/MeshSeries.h"
#include "measure/Plan.h"
#include "measure/Sweep.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::measure {

/// What is measured on beside synthetic things: of all that is asked for what is there, which here is
/// nothing.
class BenchAssets {
public:
    using Names = std::initializer_list<std::string_view>;
    virtual ~BenchAssets() = default;
    /// First height fields of scenes ("elevation"), halved until they have at most `side` texels a side.
    virtual Result<std::vector<BenchField>> fields(Names, int /*side*/) const {
        return std::vector<BenchField>();
    }
    /// Maps by their files ("sunset.hdr").
    virtual Result<std::vector<BenchEnvironment>> environments(Names) const {
        return std::vector<BenchEnvironment>();
    }
    /// First meshes of models ("bunny").
    virtual Result<std::vector<BenchMesh>> meshes(Names) const { return std::vector<BenchMesh>(); }
};

/// The dragon in three numbers of triangles, for overTriangles(); nothing where one of them is missing.
Result<std::vector<BenchMesh>> dragonsOf(const BenchAssets& assets);

/// What figures are found with that no sweep finds.
struct BenchRun {
    gl::Context& context;
    const BenchAssets& assets;
    const SolveTruth& solve;
    const Say& say;
    bool quick;
};

/// Figures that no sweep finds.
struct Proof {
    std::vector<Ratio> ratios;
    std::string text{}; ///< of each that was measured, for people
    std::string json{}; ///< the same as a file; "": there is none
};

/// A part of the benchmark.
struct BenchPart {
    std::string_view name; ///< as `lucent bench` takes it
    std::string_view help;
    bool isUsual = false;                                ///< measured where nobody names any
    Status (*plan)(Plan&, const BenchAssets&) = nullptr; ///< adds what the sweep measures; null: nothing
    Result<Proof> (*prove)(const BenchRun&) = nullptr;   ///< null: there is nothing else
};

struct TechniqueBench {
    std::span<const BenchPart> parts;
};
/// Those of all techniques that are built in; the list is made by CMake.
std::span<const TechniqueBench* const> benches();

/// All parts, technique by technique.
std::vector<const BenchPart*> benchParts();
/// The part of a name, or of "all" the usual ones; empty when there is none.
std::vector<const BenchPart*> benchParts(std::string_view name);

/// What the sweep measures of some parts.
///
/// @param quick  smaller scenes, fewer settings and repeats: a few minutes on two cores without a GPU
Result<Plan> planOf(std::span<const BenchPart* const> parts, const BenchAssets& assets, bool quick);

} // namespace lucent::measure
