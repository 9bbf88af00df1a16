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

struct TriangleMaking::State {
    explicit State(std::shared_ptr<const scene::Mesh> of)
        : mesh(std::move(of)), taken(mesh->positions.size()) {
        table.sources.resize(mesh->positions.size());
        std::iota(table.sources.begin(), table.sources.end(), 0u);
        table.triangles.resize(mesh->positions.size());
        table.indices.reserve(mesh->indices.size());
    }
    // Numbers the triangles, then joins those that share a side.
    std::optional<TriangleTable> advance() {
        const std::size_t corners = mesh->indices.size() / 3 * 3;
        const auto goOn = [&](std::size_t& next, std::size_t end, std::size_t step, const auto& work) {
            for (std::size_t left = kPiece; left > 0 && next < end; --left, next += step)
                work(next);
        };
        if (numbered < corners) {
            const std::vector<std::uint32_t>& of = mesh->indices;
            goOn(numbered, corners, 3, [&](std::size_t i) {
                addTriangle(table, taken, {of[i], of[i + 1], of[i + 2]});
            });
        } else if (places.empty() && !mesh->positions.empty()) {
            places = scene::weldedVertices(mesh->positions);
            sides.reserve(table.indices.size());
        } else if (sided < table.indices.size()) {
            goOn(sided, table.indices.size(), 3,
                 [&](std::size_t i) { addSides(table, places, &table.indices[i], sides); });
        } else if (!from) {
            from.emplace(sides, mesh->positions.size());
        } else if (joined < sides.size()) {
            goOn(joined, sides.size(), 1, [&](std::size_t i) { join(table, sides, *from, sides[i]); });
        } else {
            return std::move(table);
        }
        return std::nullopt;
    }

    static constexpr std::size_t kPiece = 20'000; // some milliseconds
    std::shared_ptr<const scene::Mesh> mesh;
    std::vector<bool> taken;
    TriangleTable table{};
    std::vector<std::uint32_t> places{};
    std::vector<Side> sides{};
    std::optional<SidesFrom> from{};
    std::size_t numbered = 0, sided = 0, joined = 0;
};

TriangleMaking::TriangleMaking(std::shared_ptr<const scene::Mesh> mesh)
    : state_(std::make_unique<State>(std::move(mesh))) {}
TriangleMaking::~TriangleMaking() = default;

std::optional<TriangleTable> TriangleMaking::advance() { return state_->advance(); }

TriangleTable tableOf(const scene::Mesh& mesh) {
    TriangleMaking making(std::shared_ptr<const scene::Mesh>(&mesh, [](const auto*) {}));
    for (;;)
        if (std::optional<TriangleTable> table = making.advance()) return std::move(*table);
}

TriangleTextures::TriangleTextures(gl::Context& context, TriangleTable table) {
    gl::Device& device = context.device();
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
