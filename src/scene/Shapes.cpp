#include "scene/Mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace lucent::scene {
namespace {

using std::numbers::pi;

// Grows a mesh vertex by vertex and quadrangle by quadrangle.
class Builder {
public:
    std::uint32_t vertex(const dvec3& position, const dvec3& normal) {
        mesh_.positions.emplace_back(position);
        mesh_.normals.emplace_back(normal);
        return std::uint32_t(mesh_.positions.size() - 1);
    }
    // Left out when two corners lie at the same place: it would have no area.
    void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        const auto& p = mesh_.positions;
        if (p[a] != p[b] && p[b] != p[c] && p[c] != p[a])
            mesh_.indices.insert(mesh_.indices.end(), {a, b, c});
    }
    // Corners counter-clockwise seen from outside.
    void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
        triangle(a, b, c);
        triangle(a, c, d);
    }
    // A rectangle of cells x cells quadrangles with its own corners. `right` x `up` points outside.
    void rectangle(const dvec3& centre, const dvec3& right, const dvec3& up, int cells) {
        const dvec3 normal = glm::normalize(glm::cross(right, up));
        const auto first = std::uint32_t(mesh_.positions.size()), row = std::uint32_t(cells) + 1;
        // Whole numbers until the last division: edges of neighbouring rectangles meet to the bit.
        for (int j = 0; j <= cells; ++j)
            for (int i = 0; i <= cells; ++i)
                vertex(centre + right * (double(2 * i - cells) / cells) +
                           up * (double(2 * j - cells) / cells),
                       normal);
        for (std::uint32_t j = 0; j + 1 < row; ++j)
            for (std::uint32_t i = 0; i + 1 < row; ++i) {
                const std::uint32_t a = first + j * row + i;
                quad(a, a + 1, a + row + 1, a + row);
            }
    }
    // Joins rings of `segments` vertices each, which follow each other from `first` on, lowest first.
    void band(std::uint32_t first, int rings, int segments) {
        for (int j = 0; j + 1 < rings; ++j)
            for (int i = 0; i < segments; ++i) {
                const auto a = first + std::uint32_t(j * segments + i),
                           b = first + std::uint32_t(j * segments + (i + 1) % segments);
                quad(a, b, b + std::uint32_t(segments), a + std::uint32_t(segments));
            }
    }
    Mesh take() { return std::move(mesh_); }

private:
    Mesh mesh_;
};

// Direction around the y axis, counter-clockwise seen from above; exact on the axes.
dvec3 around(int step, int segments) {
    if (4 * step % segments == 0) { // sin(pi) is not 0 in floating point
        constexpr int kSine[] = {0, 1, 0, -1};
        const int quarter = 4 * step / segments % 4;
        return {kSine[(quarter + 1) % 4], 0, -kSine[quarter]};
    }
    const double angle = 2 * pi * step / segments;
    return {std::cos(angle), 0, -std::sin(angle)};
}

// Part of `segments` that makes quadrangles about square when this way is `share` of the way around.
int inProportion(double share, int segments, int fewest) {
    return std::clamp(int(std::lround(std::min(share, 1.0) * segments)), fewest, std::max(segments, fewest));
}

constexpr dvec3 kUp(0, 1, 0);

} // namespace

Mesh meshOf(const Plane& plane, int cells) {
    Builder builder;
    builder.rectangle(dvec3(0), {plane.size.x / 2.0, 0, 0}, {0, 0, -plane.size.y / 2.0}, cells);
    return builder.take();
}

Mesh meshOf(const Box& box, int cells) {
    Builder builder;
    const dvec3 half = dvec3(box.size) / 2.0;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            dvec3 out(0), right(0), up(0);
            const int next = (axis + 1) % 3, last = (axis + 2) % 3;
            out[axis] = side * half[axis];
            right[next] = side * half[next];
            up[last] = half[last];
            builder.rectangle(out, right, up, cells);
        }
    return builder.take();
}

Mesh meshOf(const Sphere& sphere, int segments) {
    Builder builder;
    const int rings = std::max(segments / 2, 2) - 1; // without the poles
    const auto add = [&](const dvec3& normal) {
        return builder.vertex(normal * double(sphere.radius), normal);
    };
    const std::uint32_t south = add(-kUp);
    for (int j = 1; j <= rings; ++j) {
        const double latitude = pi * (double(j) / (rings + 1) - 0.5);
        for (int i = 0; i < segments; ++i)
            add(around(i, segments) * std::cos(latitude) + kUp * std::sin(latitude));
    }
    const std::uint32_t north = add(kUp), top = north - std::uint32_t(segments);
    builder.band(south + 1, rings, segments);
    for (int i = 0; i < segments; ++i) {
        const auto here = std::uint32_t(i), next = std::uint32_t((i + 1) % segments);
        builder.triangle(south, south + 1 + next, south + 1 + here);
        builder.triangle(north, top + here, top + next);
    }
    return builder.take();
}

Mesh meshOf(const Torus& torus, int segments) {
    Builder builder;
    const int rings = inProportion(double(torus.minor) / double(torus.major), segments, 3);
    for (int j = 0; j <= rings; ++j) // the last ring is the first one, joined below
        for (int i = 0; i < segments && j < rings; ++i) {
            const dvec3 turn = around(j, rings), normal = around(i, segments) * turn.x - kUp * turn.z;
            builder.vertex(around(i, segments) * double(torus.major) + normal * double(torus.minor), normal);
        }
    builder.band(0, rings, segments);
    for (int i = 0; i < segments; ++i) {
        const auto here = std::uint32_t(i), next = std::uint32_t((i + 1) % segments),
                   last = std::uint32_t((rings - 1) * segments);
        builder.quad(last + here, last + next, next, here);
    }
    return builder.take();
}

Mesh meshOf(const Cylinder& cylinder, int segments) {
    Builder builder;
    const double radius = double(cylinder.radius), half = double(cylinder.height) / 2;
    const int rows = inProportion(half / (pi * radius), segments, 1);
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i < segments; ++i) {
            const dvec3 normal = around(i, segments);
            builder.vertex(normal * radius + kUp * (half * (2 * j - rows) / rows), normal);
        }
    builder.band(0, rows + 1, segments);
    for (const double side : {-1.0, 1.0}) {
        if (cylinder.open) break;
        const std::uint32_t centre = builder.vertex(kUp * (side * half), kUp * side);
        for (int i = 0; i < segments; ++i)
            builder.vertex(around(i, segments) * radius + kUp * (side * half), kUp * side);
        for (int i = 0; i < segments; ++i) {
            const auto here = centre + 1 + std::uint32_t(i),
                       next = centre + 1 + std::uint32_t((i + 1) % segments);
            side > 0 ? builder.triangle(centre, here, next) : builder.triangle(centre, next, here);
        }
    }
    return builder.take();
}

ivec2 waterCells(const Water& water, int most) {
    const int cells = most > 0 ? std::min(most, water.cells) : water.cells;
    const float cell = std::max(water.size.x, water.size.y) / float(cells);
    return glm::max(ivec2(glm::round(water.size / cell)), ivec2(1));
}

Mesh meshOf(const Water& water, int most) {
    const ivec2 cells = waterCells(water, most);
    const vec2 cell = water.size / vec2(cells);
    Mesh mesh;
    const auto number = [&](int x, int z) { return std::uint32_t(z * (cells.x + 1) + x); };
    for (int z = 0; z <= cells.y; ++z)
        for (int x = 0; x <= cells.x; ++x)
            mesh.positions.push_back(
                {float(x) * cell.x - 0.5f * water.size.x, 0, float(z) * cell.y - 0.5f * water.size.y});
    mesh.normals.assign(mesh.positions.size(), {0, 1, 0});
    for (int z = 0; z < cells.y; ++z)
        for (int x = 0; x < cells.x; ++x) {
            const std::uint32_t a = number(x, z), b = number(x, z + 1), c = number(x + 1, z + 1),
                                d = number(x + 1, z);
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

Mesh partOf(const Mesh& mesh, const Mesh::Part& part) {
    constexpr std::uint32_t kUnused = ~0u;
    std::vector<std::uint32_t> placeOf(mesh.positions.size(), kUnused), kept;
    Mesh out;
    for (const std::uint32_t index : std::span(mesh.indices).subspan(part.firstIndex, part.indexCount)) {
        if (placeOf[index] == kUnused) {
            placeOf[index] = std::uint32_t(kept.size());
            kept.push_back(index);
        }
        out.indices.push_back(placeOf[index]);
    }
    const auto keep = [&]<class T>(const std::vector<T>& all) {
        std::vector<T> some;
        for (const std::uint32_t index : kept)
            if (!all.empty()) some.push_back(all[index]);
        return some;
    };
    out.positions = keep(mesh.positions);
    out.normals = keep(mesh.normals);
    out.joints = keep(mesh.joints);
    out.jointWeights = keep(mesh.jointWeights);
    out.coordinates = keep(mesh.coordinates);
    out.secondCoordinates = keep(mesh.secondCoordinates);
    out.colors = keep(mesh.colors);
    out.rig = {.nodes = mesh.rig.nodes,
               .joints = mesh.rig.joints,
               .jointFromMesh = mesh.rig.jointFromMesh,
               .targets = {},
               .weights = mesh.rig.weights,
               .channels = mesh.rig.channels,
               .duration = mesh.rig.duration};
    for (const MorphTarget& target : mesh.rig.targets)
        out.rig.targets.push_back({keep(target.positions), keep(target.normals)});
    out.parts.push_back(part);
    out.parts[0].firstIndex = 0;
    out.images = mesh.images;
    return out;
}

namespace {

// The body of a height field: its top's grid, one vertex a texel centre and a ring of them on the border, and
// below each of those one of the bottom.
class FieldBody {
public:
    explicit FieldBody(const HeightField& field)
        : field_(field), texels_(field.texels()), across_(texels_ + 2), scale_(double(field.heightScale)) {
        double lowest = 0;
        for (int y = 0; y < texels_.y; ++y)
            for (int x = 0; x < texels_.x; ++x)
                if (!isHole(x, y)) lowest = std::min(lowest, double(*field.heights->at(x, y)));
        bottom_ = lowest;
    }

    Mesh make() {
        const auto cells = [this](auto visit) {
            for (int j = 0; j + 1 < across_.y; ++j)
                for (int i = 0; i + 1 < across_.x; ++i)
                    visit(ivec2(i, j + 1), ivec2(i + 1, j + 1), ivec2(i + 1, j), ivec2(i, j));
        };
        const auto size = std::uint32_t(across_.x * across_.y);
        for (const bool isTop : {true, false})
            for (int j = 0; j < across_.y; ++j)
                for (int i = 0; i < across_.x; ++i)
                    builder_.vertex({place(i, j), scale_ * (isTop ? height(i, j) : bottom_)},
                                    isTop ? normal(i, j) : dvec3(0, 0, -1));
        const auto both = [&](ivec2 a, ivec2 b, ivec2 c) {
            if (isHollow(a) && isHollow(b) && isHollow(c)) return;
            builder_.triangle(number(a), number(b), number(c));
            builder_.triangle(size + number(a), size + number(c), size + number(b));
        };
        cells([&](ivec2 a, ivec2 b, ivec2 c, ivec2 d) {
            both(a, b, c);
            both(a, c, d);
        });
        const ivec2 last = across_ - 1;
        wall({0, last.y}, {1, 0}, last.x, {0, -1, 0});
        wall({last.x, last.y}, {0, -1}, last.y, {1, 0, 0});
        wall({last.x, 0}, {-1, 0}, last.x, {0, 1, 0});
        wall({0, 0}, {0, 1}, last.y, {-1, 0, 0});
        return builder_.take();
    }

private:
    // Where the loader has dug (HeightField::alphaIsSolid).
    bool isHole(int x, int y) const {
        if (field_.alphaIsSolid || !field_.alpha) return false;
        const Image& alpha = *field_.alpha;
        return *alpha.at((2 * x + 1) * alpha.width / (2 * texels_.x),
                         (2 * y + 1) * alpha.height / (2 * texels_.y)) < 0.5f;
    }
    ivec2 texel(int i, int j) const { return glm::clamp(ivec2(i - 1, j - 1), ivec2(0), texels_ - 1); }
    double stored(int x, int y) const { return std::max(double(*field_.heights->at(x, y)), bottom_); }
    double height(int i, int j) const {
        const ivec2 at = texel(i, j);
        return stored(at.x, at.y);
    }
    bool isHollow(ivec2 at) const { return height(at.x, at.y) == bottom_; }
    std::uint32_t number(ivec2 at) const { return std::uint32_t(at.y * across_.x + at.x); }
    dvec2 place(int i, int j) const {
        const dvec2 along = glm::clamp(dvec2(i, j) - 0.5, dvec2(0), dvec2(texels_)) - 0.5 * dvec2(texels_);
        return double(field_.texelSize()) * dvec2(along.x, -along.y);
    }
    // Central differences, one-sided at the border.
    dvec3 normal(int i, int j) const {
        const ivec2 at = texel(i, j), low = glm::max(at - 1, ivec2(0)), high = glm::min(at + 1, texels_ - 1);
        const auto slope = [&](double from, double to, int steps) {
            return steps > 0 ? scale_ * (to - from) / (steps * double(field_.texelSize())) : 0.0;
        };
        return glm::normalize(dvec3(-slope(stored(low.x, at.y), stored(high.x, at.y), high.x - low.x),
                                    slope(stored(at.x, low.y), stored(at.x, high.y), high.y - low.y), 1));
    }
    // From a corner, counter-clockwise around the body seen from above.
    void wall(ivec2 from, ivec2 step, int count, const dvec3& outside) {
        std::uint32_t before[2] = {};
        for (int k = 0; k <= count; ++k) {
            const ivec2 at = from + k * step;
            const dvec2 here = place(at.x, at.y);
            const std::uint32_t now[2] = {builder_.vertex({here, scale_ * bottom_}, outside),
                                          builder_.vertex({here, scale_ * height(at.x, at.y)}, outside)};
            if (k > 0) builder_.quad(before[0], now[0], now[1], before[1]);
            std::copy(std::begin(now), std::end(now), before);
        }
    }

    const HeightField& field_;
    ivec2 texels_, across_;
    double scale_, bottom_ = 0;
    Builder builder_;
};

} // namespace

Mesh meshOf(const HeightField& field) { return FieldBody(field).make(); }

} // namespace lucent::scene
