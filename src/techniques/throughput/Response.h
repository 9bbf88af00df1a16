#pragma once
/// R_d between two places of a body: what leaves at one over the flux that entered at the other, 1/m² of each
/// colour, and its split into a part that reaches few texels and one that vertices carry.

#include "base/Math.h"
#include "diffusion/Profile.h"

#include <array>
#include <vector>

namespace lucent::throughput {

/// From where distances count on curved surfaces.
enum class DipoleGeometry : int {
    Planar, ///< from the place where light enters, by the distance alone
    Offset  ///< from sources moved along the normal there (2002 paper), but never less than so far
};

struct Medium {
    std::array<diffusion::Medium, 3> colors; ///< layers on them are not there
    DipoleGeometry geometry = DipoleGeometry::Planar;
    bool operator==(const Medium&) const = default;
};

/// The dipole's R_d, tabled over the distance to 1e-4 of its value.
///
/// It is split at a distance c into near + far: far is R_d beyond c and within it the even polynomial that
/// has R_d's value, slope and bend at c. Where distances count from sources (Offset), both are the shares
/// that they have of the profile at that distance on a plane.
class Response {
public:
    /// @param extent  m: nothing is asked for beyond
    /// @param cut     m, c; 0: all is far
    Response(const Medium& medium, double extent, double cut);

    vec3 whole(const vec3& from, const vec3& normal, const vec3& to) const;
    vec3 far(const vec3& from, const vec3& normal, const vec3& to) const;
    /// 0 from c on.
    vec3 near(const vec3& from, const vec3& normal, const vec3& to) const;

    double cut() const { return cut_; }
    /// m, of the shallowest source: R_d has no finer detail.
    double finest() const { return finest_; }
    /// Of half spaces: the share of the flux that leaves again.
    vec3 total() const;
    const diffusion::Table& nearTable() const { return near_; }

private:
    vec3 offsetProfile(const vec3& away, const vec3& normal) const;

    Medium medium_;
    double cut_, finest_ = 0;
    diffusion::Table whole_, near_; ///< near_: Offset: its share
    std::array<std::vector<diffusion::Pole>, 3> poles_;
};

} // namespace lucent::throughput
