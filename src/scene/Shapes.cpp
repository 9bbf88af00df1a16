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

ivec2 waterCells(const Water& water) {
    const float cell = std::max(water.size.x, water.size.y) / float(water.cells);
    return glm::max(ivec2(glm::round(water.size / cell)), ivec2(1));
}

Mesh meshOf(const Water& water) {
    const ivec2 cells = waterCells(water);
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
    return out;
}

} // namespace lucent::scene
