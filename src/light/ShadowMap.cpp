#include "light/ShadowMap.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lucent::views {

namespace {

constexpr float kWidest =
    1.7320508f;                   // tangent of 60 degrees: beyond it a plane view wastes most of its texels
constexpr float kNearest = 1e-3f; // of the farthest depth
constexpr float kNothing = 1e30f;
// Texels by which a view that is fitted to what it shows lies beside the middle of that. Where triangles are
// cut at the border, llvmpipe's clipper may leave a sliver along the edge that two of them share, whose
// depths are 0.4 % off; it is seen only where texel centres lie just on that edge, as on the diagonal of a
// square in the middle.
constexpr vec2 kAside(0.31f, 0.17f);

bool isEmpty(const Bounds& bounds) { return glm::any(glm::lessThan(bounds.high, bounds.low)); }

std::array<vec3, 8> cornersOf(const Bounds& bounds) {
    std::array<vec3, 8> corners;
    for (int i = 0; i < 8; ++i)
        corners[std::size_t(i)] = {i & 1 ? bounds.high.x : bounds.low.x, i & 2 ? bounds.high.y : bounds.low.y,
                                   i & 4 ? bounds.high.z : bounds.low.z};
    return corners;
}

Bounds common(const Bounds& a, const Bounds& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

// A little wider, so that the texels around what lies at the border are there too.
float widened(float extent, int size) { return extent * float(size) / float(size - 4); }

struct Frame {
    vec3 right, up, forward;
    explicit Frame(const vec3& along) : forward(along) {
        const vec3 aside = std::abs(along.y) < 0.9f ? vec3(0, 1, 0) : vec3(1, 0, 0);
        right = glm::normalize(glm::cross(along, aside));
        up = glm::cross(right, along);
    }
    vec3 operator()(const vec3& v) const { return {dot(v, right), dot(v, up), dot(v, forward)}; }
    // A box in these axes around a box in the world's.
    Bounds around(const Bounds& bounds) const {
        Bounds box;
        for (const vec3& corner : cornersOf(bounds))
            box.add((*this)(corner));
        return box;
    }
};

Eye eyeOf(const Frame& frame, const vec3& position, bool perspective, vec2 halfExtent, float nearest,
          float farthest) {
    Eye eye{.position = position,
            .forward = frame.forward,
            .perspective = perspective,
            .right = frame.right,
            .up = frame.up,
            .halfExtent = halfExtent,
            .nearest = nearest,
            .farthest = farthest};
    const mat4 viewFromWorld = glm::lookAt(position, position + frame.forward, frame.up);
    const vec2 half = perspective ? nearest * halfExtent : halfExtent;
    eye.clipFromWorld = (perspective ? glm::frustum(-half.x, half.x, -half.y, half.y, nearest, farthest)
                                     : glm::ortho(-half.x, half.x, -half.y, half.y, nearest, farthest)) *
                        viewFromWorld;
    return eye;
}

// Parallel light: only lines that meet something that casts and something that receives matter, and depths
// from the first that casts to the last that receives.
std::optional<Eye> parallelEye(const vec3& toLight, const Bounds& casters, const Bounds& receivers,
                               int size) {
    const Frame frame(-toLight);
    const Bounds before = frame.around(casters), behind = frame.around(receivers);
    const Bounds both = common(before, behind);
    if (both.low.x > both.high.x || both.low.y > both.high.y || before.low.z > behind.high.z)
        return std::nullopt;
    const float length = behind.high.z - before.low.z;
    const vec3 extent = behind.high - behind.low; // boxes around height fields are drawn a little larger
    const float margin = 1e-3f * length + 4e-3f * (extent.x + extent.y) + 1e-6f; // in depth
    const vec2 texel = vec2(both.high - both.low) / float(size);
    const vec2 middle = 0.5f * vec2(both.low + both.high) + kAside * texel;
    const vec2 half = 0.501f * vec2(both.high - both.low) + 1e-6f * (1 + length); // what floats round
    const vec3 position =
        middle.x * frame.right + middle.y * frame.up + (before.low.z - margin) * frame.forward;
    return eyeOf(frame, position, false, {widened(half.x, size), widened(half.y, size)}, 0,
                 length + 2 * margin);
}

float farthestOf(const vec3& from, const Bounds& bounds) {
    float most = 0;
    for (const vec3& corner : cornersOf(bounds))
        most = std::max(most, glm::distance(corner, from));
    return 1.01f * most + 1e-6f;
}

// Half extents, for each metre of depth, of a view in which all corners of a box are; nothing when it is too
// wide.
std::optional<vec2> extentsOf(const Frame& frame, const vec3& from, const Bounds& bounds) {
    vec2 extents(0);
    for (const vec3& corner : cornersOf(bounds)) {
        const vec3 v = frame(corner - from);
        if (!(v.z > 0) || std::max(std::abs(v.x), std::abs(v.y)) > kWidest * v.z) return std::nullopt;
        extents = glm::max(extents, glm::abs(vec2(v)) / v.z);
    }
    return extents + 1e-4f;
}

Eye pointEye(const Frame& frame, const vec3& position, vec2 extents, float farthest, int size) {
    return eyeOf(frame, position, true, {widened(extents.x, size), widened(extents.y, size)},
                 kNearest * farthest, farthest);
}

// Whether a view may show something of a box: its corners do not all lie beside one of the view's sides.
bool mayShow(const Eye& eye, const Bounds& bounds) {
    bool beside[5] = {true, true, true, true, true};
    for (const vec3& corner : cornersOf(bounds)) {
        const vec3 v = corner - eye.position;
        const float depth = dot(v, eye.forward);
        const vec2 at(dot(v, eye.right), dot(v, eye.up));
        const vec2 half = (eye.perspective ? depth : 1) * eye.halfExtent;
        const bool here[5] = {depth<0, at.x> half.x, at.x<-half.x, at.y> half.y, at.y < -half.y};
        for (int side = 0; side < 5; ++side)
            beside[side] = beside[side] && here[side];
    }
    return std::none_of(std::begin(beside), std::end(beside), [](bool all) { return all; });
}

std::vector<Eye> pointEyes(const ShadowSource& source, const Bounds& receivers, int size) {
    const vec3 position(source.place);
    const float farthest = farthestOf(position, receivers);
    const vec3 towards = receivers.center() - position;
    if (glm::length(towards) > 0) {
        const Frame middle(glm::normalize(towards));
        std::optional<vec2> extents = extentsOf(middle, position, receivers);
        if (extents && std::max(extents->x, extents->y) <= source.tangent) {
            const vec2 aside = kAside * 2.0f * *extents / float(size);
            const Frame frame(glm::normalize(middle.forward + aside.x * middle.right + aside.y * middle.up));
            extents = extentsOf(frame, position, receivers);
            if (extents) return {pointEye(frame, position, *extents, farthest, size)};
        }
    }
    if (source.tangent <= kWidest)
        return {pointEye(Frame(source.axis), position, vec2(source.tangent + 1e-4f), farthest, size)};
    std::vector<Eye> faces;
    for (int axis = 0; axis < 3; ++axis)
        for (const float side : {1.0f, -1.0f}) {
            vec3 forward(0);
            forward[axis] = side;
            faces.push_back(pointEye(Frame(forward), position, vec2(1), farthest, size));
        }
    std::erase_if(faces, [&](const Eye& face) { return !mayShow(face, receivers); });
    return faces;
}

} // namespace

ivec2 ShadowViews::imageSize() const {
    const int count = int(faces.size());
    return size * ivec2(std::min(count, kColumns), (count + kColumns - 1) / kColumns);
}

std::array<ViewBlock, ShadowViews::kMost> facesOf(const ShadowViews& views) {
    std::array<ViewBlock, ShadowViews::kMost> blocks{};
    std::transform(views.faces.begin(), views.faces.end(), blocks.begin(),
                   [&](const Eye& face) { return viewBlock(face, ivec2(views.size)); });
    return blocks;
}

// Boxes sweep what lies between: from the receivers towards a direction, or shrinking to a point. Along each
// axis both sides of such a box go linearly with how far it has come.
bool mayShade(const vec4& source, const Bounds& caster, const Bounds& receivers) {
    if (isEmpty(caster) || isEmpty(receivers)) return false;
    const vec3 light(source);
    float first = 0,
          last = source.w == 0 ? std::numeric_limits<float>::infinity() : 1; // of the boxes that meet
    const auto bound = [&](float start, float rate) {                        // start + rate t >= 0
        if (rate > 0)
            first = std::max(first, -start / rate);
        else if (rate < 0)
            last = std::min(last, -start / rate);
        else if (start < 0)
            last = -1;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const float low = receivers.low[axis], high = receivers.high[axis], at = light[axis];
        bound(high - caster.low[axis], source.w == 0 ? at : at - high);
        bound(caster.high[axis] - low, source.w == 0 ? -at : low - at);
    }
    return first <= last;
}

ShadowViews shadowViews(const ShadowSource& source, const Bounds& casters, const Bounds& receivers,
                        int size) {
    ShadowViews views{.faces = {}, .size = size};
    if (isEmpty(casters) || isEmpty(receivers)) return views;
    if (source.place.w != 0)
        views.faces = pointEyes(source, receivers, size);
    else if (const std::optional<Eye> eye = parallelEye(vec3(source.place), casters, receivers, size))
        views.faces = {*eye};
    return views;
}

Result<graph::TextureId> recordShadow(graph::FrameGraph& graph, gl::Context& context,
                                      const ShadowViews& views, const Drawables& casters,
                                      const Bounds& receivers, graph::TextureId first) {
    const ivec2 imageSize = views.imageSize();
    const int most = context.caps().maxTextureSize;
    if (std::max(imageSize.x, imageSize.y) > most)
        return Error{"views: a shadow map of " + std::to_string(imageSize.x) + " x " +
                         std::to_string(imageSize.y) + " texels; must be at most " + std::to_string(most) +
                         " a side on this GPU",
                     Fault::Machine};
    std::vector<std::string> defines(first ? 1 : 0, "BEHIND");
    if (!views.faces.empty() && views.faces.front().isCut()) defines.push_back("CUT");
    std::vector<Bounds> bounds;
    for (const auto& caster : casters)
        bounds.push_back(caster->bounds());
    graph::TextureId depths;
    graph.addPass("views.shadow", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason((first ? "what lies behind what one point of a light sees, in "
                           : "what stands in the way of one point of a light, in ") +
                    std::to_string(views.faces.size()) + " view(s)");
        if (first) pass.sample(first);
        std::vector<Drawing> drawings = drawingsOf(context, pass, casters, ViewKind::Shadow, defines);
        depths = pass.createColor("views.shadow", {.size = imageSize, .format = kShadowFormat});
        pass.clear(depths, vec4(kNothing));
        pass.clear(pass.createDepth("views.shadowDepth", imageSize, graph::Format::Depth32F), 1.0f);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            std::vector<graph::Binding> before;
            if (first) before.push_back({"uFirst", resources[first]});
            for (std::size_t face = 0; face < views.faces.size(); ++face) {
                const Eye& eye = views.faces[face];
                if (!mayShow(eye, receivers)) continue;
                const graph::Draw draw{.region = ivec4(views.corner(int(face)), views.size, views.size),
                                       .depthTest = graph::DepthTest::Less,
                                       .textures = before};
                for (std::size_t i = 0; i < drawings.size(); ++i)
                    if (mayShow(eye, bounds[i]))
                        drawings[i](resources, commands, eye, ivec2(views.size), draw);
            }
        };
    });
    return depths;
}

namespace {

// Sides of a view: places in it are not below 0 of any.
std::array<float, 6> depthsWithin(const Eye& eye, const vec3& place) {
    const vec3 v = place - eye.position;
    const float depth = dot(v, eye.forward);
    const vec2 at(dot(v, eye.right), dot(v, eye.up)), half = (eye.perspective ? depth : 1) * eye.halfExtent;
    return {depth - eye.nearest, eye.farthest - depth, half.x - at.x,
            half.x + at.x,       half.y - at.y,        half.y + at.y};
}

// The part of a convex polygon that a view shows (Sutherland, Hodgman 1974).
std::vector<vec3> shownOf(const Eye& eye, std::vector<vec3> polygon) {
    for (std::size_t side = 0; side < 6; ++side) {
        std::vector<vec3> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
            const float within = depthsWithin(eye, a)[side], next = depthsWithin(eye, b)[side];
            if (within >= 0) kept.push_back(a);
            if ((within >= 0) != (next >= 0)) kept.push_back(glm::mix(a, b, within / (within - next)));
        }
        polygon = std::move(kept);
    }
    return polygon;
}

} // namespace

Bounds seenBy(const Eye& eye, const Bounds& bounds) {
    constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}};
    Bounds shown;
    const std::array<vec3, 8> corners = cornersOf(bounds);
    for (const auto& face : kFaces) {
        std::vector<vec3> polygon;
        for (const int corner : face)
            polygon.push_back(corners[std::size_t(corner)]);
        for (const vec3& place : shownOf(eye, std::move(polygon)))
            shown.add(place);
    }
    for (const float depth : {eye.nearest, eye.farthest}) // corners of the view inside the box
        for (const float x : {-1.0f, 1.0f})
            for (const float y : {-1.0f, 1.0f}) {
                const vec2 at = eye.halfExtent * vec2(x, y) * (eye.perspective ? depth : 1.0f);
                const vec3 place = eye.position + at.x * eye.right + at.y * eye.up + depth * eye.forward;
                if (glm::clamp(place, bounds.low, bounds.high) == place) shown.add(place);
            }
    return shown;
}

} // namespace lucent::views
