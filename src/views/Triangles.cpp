#include "views/Triangles.h"

#include "views/Meshes.h"

#include <algorithm>
#include <numeric>

namespace lucent::views {

using graph::Format;

namespace {

constexpr std::uint32_t kNone = TriangleTable::kNone;

// A side of a triangle, from one place to another.
struct Side {
    std::uint32_t from, to, number;
    int side;
};

// What is done for each triangle stands apart: WebAssembly runs a function in its fast form only from a later
// call on.
[[gnu::noinline]] void addSides(const TriangleTable& table, const std::vector<std::uint32_t>& places,
                                const std::uint32_t* corner, std::vector<Side>& sides) {
    const auto place = [&](int k) { return places[table.sources[corner[k % 3]]]; };
    if (place(0) == place(1) || place(1) == place(2) || place(2) == place(0)) return;
    for (int k = 0; k < 3; ++k)
        sides.push_back({place(k), place(k + 1), corner[2], k});
}

// Sides by where they begin.
struct SidesFrom {
    SidesFrom(const std::vector<Side>& sides, std::size_t places)
        : begin(places + 1, 0), slots(sides.size()) {
        for (const Side& one : sides)
            ++begin[one.from + 1];
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
        for (std::size_t i = 0; i < sides.size(); ++i)
            slots[next[sides[i].from]++] = std::uint32_t(i);
    }
    std::vector<std::uint32_t> begin, slots;
};

// A neighbour's side begins where this one ends.
[[gnu::noinline]] void join(TriangleTable& table, const std::vector<Side>& sides, const SidesFrom& from,
                            const Side& one) {
    const auto across = [&](const Side& side) -> std::uint32_t& {
        return table.triangles[side.number].across[std::size_t(side.side)];
    };
    for (std::uint32_t i = from.begin[one.to]; i < from.begin[one.to + 1] && across(one) == kNone; ++i) {
        const Side& other = sides[from.slots[i]];
        if (other.to != one.from || across(other) != kNone) continue;
        across(one) = other.number;
        across(other) = one.number;
    }
}

void joinNeighbours(TriangleTable& table, const std::vector<vec3>& positions) {
    const std::vector<std::uint32_t> places = scene::weldedVertices(positions);
    std::vector<Side> sides;
    sides.reserve(table.indices.size());
    for (std::size_t i = 0; i < table.indices.size(); i += 3)
        addSides(table, places, &table.indices[i], sides);
    const SidesFrom from(sides, positions.size());
    for (const Side& one : sides)
        join(table, sides, from, one);
}

// A triangle's number is that of its last corner: one that no other has, or a copy.
[[gnu::noinline]] void addTriangle(TriangleTable& table, std::vector<bool>& taken,
                                   std::array<std::uint32_t, 3> corners) {
    const auto free =
        std::find_if(corners.begin(), corners.end(), [&](std::uint32_t c) { return !taken[c]; });
    if (free != corners.end()) {
        taken[*free] = true;
        std::rotate(corners.begin(), free + 1, corners.end()); // the free one comes last
    } else {
        const auto copy = std::uint32_t(table.sources.size());
        table.sources.push_back(corners[2]);
        table.triangles.emplace_back();
        corners[2] = copy;
    }
    table.triangles[corners[2]].corners = {corners[0], corners[1]};
    table.indices.insert(table.indices.end(), corners.begin(), corners.end());
}

// Five numbers of three bytes in four of four: the last one is spread over the others' highest bytes.
glm::uvec4 packed(const TriangleTable::Triangle& triangle) {
    const std::uint32_t last = triangle.across[2];
    return {triangle.corners[0] | last << 24, triangle.corners[1] | last >> 8 << 24,
            triangle.across[0] | last >> 16 << 24, triangle.across[1]};
}

} // namespace

TriangleTable tableOf(const scene::Mesh& mesh) {
    TriangleTable table;
    table.sources.resize(mesh.positions.size());
    std::iota(table.sources.begin(), table.sources.end(), 0u);
    table.triangles.resize(mesh.positions.size());
    table.indices.reserve(mesh.indices.size());
    std::vector<bool> taken(mesh.positions.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        addTriangle(table, taken, {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    joinNeighbours(table, mesh.positions);
    return table;
}

TriangleTextures::TriangleTextures(gl::Context& context, const scene::Mesh& mesh) {
    gl::Device& device = context.device();
    TriangleTable table = tableOf(mesh);
    count_ = int(table.sources.size());
    indices_ = graph::Indices(device, table.indices, "views.triangleIndices");
    const ivec2 size = vertexImageSize(table.sources.size());
    const std::size_t texels = std::size_t(size.x) * std::size_t(size.y);
    sources_ = graph::Texture(device, {.size = size, .format = Format::R32UI}, "views.triangleSources");
    links_ = graph::Texture(device, {.size = size, .format = Format::RGBA32UI}, "views.triangleLinks");
    table.sources.resize(texels, 0);
    table.triangles.resize(texels);
    std::vector<glm::uvec4> links(texels);
    std::transform(table.triangles.begin(), table.triangles.end(), links.begin(), packed);
    device.upload(sources_.handle(), 0, table.sources);
    device.upload(links_.handle(), 0, links);
}

std::size_t TriangleTextures::bytes() const {
    return sources_.desc().bytes() + links_.desc().bytes() + 4 * std::size_t(indices_.count());
}

namespace {

constexpr const char *kCornersLabel = "views.corners", *kNormalsLabel = "views.cornerNormals",
                     *kLinksLabel = "views.links";

// Brings the kept images into the graph, of the right size.
TriangleImages importKept(graph::FrameGraph& graph, gl::Context& context, KeptTriangles& kept, ivec2 size) {
    const auto import = [&](graph::Texture& texture, Format format, const char* label) {
        const graph::TextureDesc desc{.size = size, .format = format};
        if (!texture || texture.desc() != desc) {
            texture = graph::Texture(context.device(), desc, label);
            kept.current = false;
        }
        return graph.import(texture.handle(), desc, label);
    };
    return {import(kept.corners, Format::RGBA32F, kCornersLabel),
            import(kept.normals, Format::RGBA32F, kNormalsLabel),
            import(kept.links, Format::RGBA32UI, kLinksLabel)};
}

} // namespace

Status recordTriangles(graph::FrameGraph& graph, gl::Context& context, const std::vector<DrawnMesh*>& meshes,
                       KeptTriangles* kept) {
    int rows = 0;
    for (DrawnMesh* mesh : meshes) {
        mesh->firstCorner = rows * kVerticesPerRow;
        rows += mesh->textures->triangles()->sources().desc().size.y;
    }
    if (rows == 0) return Done{};
    const int most = std::min(context.caps().maxTextureSize, int(kNone) / kVerticesPerRow);
    if (rows > most)
        return Error{"views: refractive meshes of " + std::to_string(rows) + " rows of " +
                         std::to_string(kVerticesPerRow) + " corners; must be at most " +
                         std::to_string(most) + " on this GPU",
                     Fault::Machine};
    const ivec2 size(kVerticesPerRow, rows);
    TriangleImages images;
    if (kept) images = importKept(graph, context, *kept, size);
    const auto tell = [&] {
        for (DrawnMesh* mesh : meshes)
            mesh->triangles = images;
        return Done{};
    };
    if (kept && kept->current) return tell();
    const gl::Program* program = context.program("views/triangles");
    graph.addPass("views.triangles", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.reason("triangles of the refractive objects, which rays are intersected with");
        if (kept) {
            for (const graph::TextureId image : {images.corners, images.normals, images.links}) {
                pass.write(image);
                graph.keep(image);
            }
        } else {
            const graph::TextureDesc floats{.size = size, .format = Format::RGBA32F};
            images = {pass.createColor(kCornersLabel, floats), pass.createColor(kNormalsLabel, floats),
                      pass.createColor(kLinksLabel, {.size = size, .format = Format::RGBA32UI})};
        }
        std::vector<DrawnMesh> drawn;
        for (const DrawnMesh* mesh : meshes) {
            mesh->sampleFrom(pass);
            drawn.push_back(*mesh);
        }
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            for (const DrawnMesh& mesh : drawn) {
                const TriangleTextures* triangles = mesh.textures->triangles();
                const scene::Transform& transform = mesh.object->transform;
                const ivec2 part = triangles->sources().desc().size;
                commands.draw({.program = program,
                               .region = {0, mesh.firstCorner / kVerticesPerRow, part},
                               .block = TrianglesBlock{transform.worldFromObject(),
                                                       mat4(rotationFromDegrees(transform.rotate)),
                                                       mesh.firstCorner, triangles->count()},
                               .textures = {{"uPositions", resources[mesh.positions]},
                                            {"uNormals", resources[mesh.normals]},
                                            {"uSources", triangles->sources().handle()},
                                            {"uTable", triangles->links().handle()}}});
            }
        };
    });
    if (kept) kept->current = true;
    return tell();
}

void sampleTriangles(graph::PassBuilder& pass, const TriangleImages& images) {
    pass.sample(images.corners);
    pass.sample(images.normals);
    pass.sample(images.links);
}

std::vector<graph::Binding> triangleBindings(const graph::Resources& resources,
                                             const TriangleImages& images) {
    return {{"uCorners", resources[images.corners]},
            {"uCornerNormals", resources[images.normals]},
            {"uLinks", resources[images.links]}};
}

} // namespace lucent::views
