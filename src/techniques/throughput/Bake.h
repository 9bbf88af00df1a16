#pragma once
/// Everything that is worked out once for an object and its material, and what it makes of light: radiosity
/// from irradiance, without a GPU.

#include "techniques/throughput/Blend.h"
#include "techniques/throughput/Factors.h"

#include <array>
#include <memory>
#include <optional>

namespace lucent::throughput {

enum class Local : int {
    Live,  ///< what texels leave around them is computed where it is needed
    Stored ///< by 49 factors a texel, as the paper has it
};
enum class Blend : int {
    Fitted, ///< close light is counted once
    None    ///< and twice: to compare
};

struct BakeOptions {
    int side = 512; ///< texels of the atlas
    Local local = Local::Live;
    Blend blend = Blend::Fitted; ///< of Stored; Live needs none
    FactorOptions factors{};     ///< but for the diagonal
    bool operator==(const BakeOptions&) const = default;
};

/// What leaves of light that entered.
struct Lit {
    std::vector<vec3> local, global; ///< of each texel, W/m²: they add up
};

struct Bake {
    BakeOptions options;
    Medium medium;
    Surface surface;
    Factors factors;
    Filters filters;         ///< of Stored
    float cut = 0;           ///< m, how far texels leave light around them; of Live
    int radius = 0;          ///< texels, as far in the atlas
    std::vector<vec3> reach; ///< of Live, for each texel: integral of the near part over the surface, which
                             ///< texels around share by their near parts: what leaves of even light is
                             ///< right however coarse they are and whichever of them show the same place

    /// E_v: by the dual basis.
    std::vector<vec3> vertexIrradiance(std::span<const vec3> irradiance) const;
    /// B = local + global.
    ///
    /// @param irradiance  of each of surface.texels.list, W/m² that enters
    Lit relight(std::span<const vec3> irradiance) const;
    std::size_t bytes() const; ///< of factors and filters

    /// What vertices carry to vertices, of which `global` is read.
    std::vector<vec3> vertexRadiosity(std::span<const vec3> irradiance) const;
    vec3 globalAt(std::size_t texel, std::span<const vec3> vertexRadiosity) const;
    /// What a texel gets of those around by its filter; of Stored.
    vec3 filteredAt(std::size_t texel, std::span<const vec3> irradiance) const;

private:
    void gather(std::span<const vec3> irradiance, std::vector<vec3>& lit) const;
};

/// Works one out in slices of time.
class BakeMaking {
public:
    /// @param scale    metres a unit of the mesh
    /// @param threads  0: as many as the machine has; the bake does not depend on it
    BakeMaking(std::shared_ptr<const scene::Mesh> mesh, float scale, const Medium& medium,
               const BakeOptions& options, int threads = 0);
    ~BakeMaking();
    /// Works on for about so long. @return the bake once it is whole, or why there is none
    std::optional<Result<Bake>> advance(double ms);
    /// Works on until it is.
    Result<Bake> finish();
    double share() const; ///< of the work that is done, [0,1]

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent::throughput
