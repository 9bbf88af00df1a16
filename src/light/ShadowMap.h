#pragma once
/// What a light sees of the things that stand in its way: depths by which a place is lit or not
/// (shaders/views/shadow.glsl).

#include "views/Drawable.h"

#include <array>
#include <limits>

namespace lucent::views {

/// One point of a light, or one direction.
struct ShadowSource {
    vec4 place{0, 1, 0, 0}; ///< world: the point, and 1; or the unit direction to the light, and 0
    vec3 axis{0};           ///< unit: the middle of the cone into which a point shines
    float tangent = std::numeric_limits<float>::infinity(); ///< of half the cone; infinite: all around
    bool operator==(const ShadowSource&) const = default;
};

/// Square views from a light side by side in one image, three to a row.
struct ShadowViews {
    static constexpr int kMost = 6;
    static constexpr int kColumns = 3;

    std::vector<Eye> faces; ///< one, or faces of a cube, at most six; none: nothing can lie in shadow
    int size = 0;           ///< pixels a side of each
    ivec2 imageSize() const;
    ivec2 corner(int face) const { return size * ivec2(face % kColumns, face / kColumns); }
    bool operator==(const ShadowViews&) const = default;
};

/// What recordShadow() draws.
inline constexpr graph::Format kShadowFormat = graph::Format::R32F;

/// The views as blocks of shaders hold them; the rest of the six is 0.
std::array<ViewBlock, ShadowViews::kMost> facesOf(const ShadowViews& views);

/// Where to look from a light: as narrow as what casts shadows and what receives them allow. Parallel light
/// and a point that has everything before it within 60 degrees need one view, other points those of a cube's
/// six faces in which receivers may be.
///
/// @param casters    box around all that casts shadows
/// @param receivers  box around all on which they fall
/// @param size       pixels a side of each view, at least 16
ShadowViews shadowViews(const ShadowSource& source, const Bounds& casters, const Bounds& receivers, int size);

/// Whether something in a box can stand between a light and a place in another box.
///
/// @param source  world: a point, and 1; or the unit direction to the light, and 0
bool mayShade(const vec4& source, const Bounds& caster, const Bounds& receivers);

/// Draws the depths of what casts shadows, R32F, 1e30 where there is nothing.
///
/// @param receivers  as in shadowViews(): views in which none of them can be are not drawn
/// @param first      none, or such depths: then those of the next surfaces behind them that face the light
/// @return           Error (Fault::Machine) when the image is larger than this GPU's textures
Result<graph::TextureId> recordShadow(graph::FrameGraph& graph, gl::Context& context,
                                      const ShadowViews& views, const Drawables& casters,
                                      const Bounds& receivers, graph::TextureId first = {});

/// The box around the part of a box that a view shows.
Bounds seenBy(const Eye& eye, const Bounds& bounds);

} // namespace lucent::views
