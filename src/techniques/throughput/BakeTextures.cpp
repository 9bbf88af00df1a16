#include "techniques/throughput/BakeTextures.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lucent::throughput {

using graph::Format;

ivec2 listSize(std::size_t count, int width) {
    const auto row = std::size_t(width);
    return {width, std::max(1, int((count + row - 1) / row))};
}

namespace {

vec2 octahedral(vec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    const vec2 xy(n);
    if (n.z >= 0) return xy;
    return {(1 - std::abs(xy.y)) * (xy.x >= 0 ? 1.0f : -1.0f),
            (1 - std::abs(xy.x)) * (xy.y >= 0 ? 1.0f : -1.0f)};
}

// Columns as places in the atlas, and a value for all colours.
template <class Value>
Rows<vec3> overAtlas(const Rows<Value>& rows, const Texels& texels) {
    Rows<vec3> over;
    over.starts = rows.starts;
    for (std::size_t k = 0; k < rows.columns.size(); ++k) {
        const ivec2 at = texels.list[rows.columns[k]].at;
        over.columns.push_back(std::uint32_t(at.y * texels.side + at.x));
        over.values.push_back(vec3(rows.values[k]));
    }
    return over;
}

Rows<vec3> rowsOfDense(const Factors& factors) {
    Rows<vec3> rows;
    for (std::size_t j = 0; j < factors.count; ++j) {
        for (std::size_t i = 0; i < factors.count; ++i)
            rows.columns.push_back(std::uint32_t(i));
        rows.starts.push_back(std::uint32_t(rows.columns.size()));
    }
    rows.values = factors.dense;
    return rows;
}

// Puts the parts of one bake onto the GPU.
class Uploading {
public:
    Uploading(gl::Context& context, const Bake& bake, BakeTextures& gpu)
        : context_(context), bake_(bake), gpu_(gpu) {}

    void atlas() {
        const Hats& hats = surface().hats;
        std::vector<vec4> place(texels(), vec4(0)), frame = place, corners = place;
        for (const Texel& texel : surface().texels.list) {
            const std::size_t at = indexOf(texel);
            place[at] = vec4(positionAt(hats, texel.place), texel.area);
            frame[at] =
                vec4(octahedral(normalAt(hats, texel.place)), texel.place.weights.y, texel.place.weights.z);
            const auto& vertices = hats.triangles[texel.place.triangle];
            corners[at] = vec4(glm::vec3(vertices[0], vertices[1], vertices[2]), float(texel.isShown));
        }
        gpu_.place = image(place, "throughput.place");
        gpu_.frame = image(frame, "throughput.frame");
        gpu_.corners = image(corners, "throughput.corners");
    }

    void triangles() {
        const Hats& hats = surface().hats;
        std::vector<vec4> corners, places;
        for (std::size_t t = 0; t < hats.triangles.size(); ++t)
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t vertex = hats.triangles[t][i];
                corners.emplace_back(hats.positions[vertex], float(vertex));
                places.emplace_back(surface().places[t][i], 0, 0);
            }
        const ivec2 size = listSize(corners.size());
        gpu_.triangles = texture(std::move(corners), size, "throughput.triangles");
        gpu_.charts = texture(std::move(places), size, "throughput.charts");
    }

    void live() {
        constexpr int kNearEntries = 1024; // read at the nearest: off by 1e-3 where R_d is steepest
        const Response response(bake_.medium, 2.0 * double(bake_.cut), double(bake_.cut));
        std::vector<vec4> near;
        for (int i = 0; i < kNearEntries; ++i) {
            const float u = float(i) / float(kNearEntries - 1);
            near.emplace_back(response.near(vec3(0), vec3(0, 0, 1), vec3(bake_.cut * u * u, 0, 0)), 0);
        }
        gpu_.near = texture(std::move(near), {kNearEntries, 1}, "throughput.near");
        std::vector<vec4> reach(texels(), vec4(0));
        for (std::size_t t = 0; t < bake_.reach.size(); ++t) {
            const Texel& texel = surface().texels.list[t];
            reach[indexOf(texel)] = vec4(bake_.reach[t], float(texel.isShown));
        }
        gpu_.reach = image(reach, "throughput.reach");
    }

    void stored() {
        constexpr std::size_t kLayers = std::size_t(Filters::kWidth) * std::size_t(Filters::kWidth);
        gpu_.filters = graph::Texture(
            context_.device(), {.size = ivec2(side()), .format = Format::RGBA16F, .layers = int(kLayers)},
            "throughput.filters");
        for (std::size_t layer = 0; layer < kLayers; ++layer) {
            std::vector<std::uint64_t> halves(texels(), 0);
            for (std::size_t t = 0; t < surface().texels.list.size(); ++t)
                halves[indexOf(surface().texels.list[t])] =
                    glm::packHalf4x16(vec4(bake_.filters.factors[t * kLayers + layer], 0));
            context_.device().upload(gpu_.filters.handle(), 0, int(layer), halves);
        }
    }

    Status matrices() {
        const Factors& factors = bake_.factors;
        Status done =
            matrix(gpu_.duals, overAtlas(surface().duals, surface().texels), side(), "throughput.duals");
        if (done && factors.method == Global::Dense)
            done = matrix(gpu_.close, rowsOfDense(factors), kVectorWidth, "throughput.close");
        else if (done)
            done = matrix(gpu_.close, factors.close, kVectorWidth, "throughput.close");
        if (done) done = matrix(gpu_.inner, factors.inner, kVectorWidth, "throughput.inner");
        if (done) done = matrix(gpu_.outer, factors.outer, kVectorWidth, "throughput.outer");
        if (done && bake_.options.local == Local::Stored)
            done = matrix(gpu_.direct, overAtlas(bake_.filters.direct, surface().texels), side(),
                          "throughput.direct");
        return done;
    }

private:
    const Surface& surface() const { return bake_.surface; }
    int side() const { return surface().texels.side; }
    std::size_t texels() const { return std::size_t(side()) * std::size_t(side()); }
    std::size_t indexOf(const Texel& texel) const {
        return std::size_t(texel.at.y) * std::size_t(side()) + std::size_t(texel.at.x);
    }

    graph::Texture texture(std::vector<vec4> texels, ivec2 size, const char* label) {
        texels.resize(std::size_t(size.x) * std::size_t(size.y), vec4(0));
        graph::Texture texture(context_.device(), {.size = size, .format = Format::RGBA32F}, label);
        context_.device().upload(texture.handle(), 0, texels);
        return texture;
    }
    graph::Texture image(const std::vector<vec4>& texels, const char* label) {
        return texture(texels, ivec2(side()), label);
    }

    // width: texels a row of the vector that it is multiplied with
    Status matrix(Matrix& made, const Rows<vec3>& rows, int width, const char* label) {
        if (rows.count() == 0) return Done{};
        const ivec2 size = listSize(rows.columns.size());
        if (size.y > context_.caps().maxTextureSize)
            return Error{std::string(label) + ": has " + std::to_string(rows.columns.size()) +
                             " factors, more than a texture of this GPU holds; must be hierarchical, or of "
                             "fewer vertices",
                         Fault::Machine};
        using Entry = glm::uvec4;
        std::vector<Entry> entries(std::size_t(size.x) * std::size_t(size.y), Entry(0));
        for (std::size_t k = 0; k < rows.columns.size(); ++k) {
            const std::uint32_t x = rows.columns[k] % std::uint32_t(width),
                                y = rows.columns[k] / std::uint32_t(width);
            entries[k] = Entry(x | y << 16, glm::floatBitsToUint(rows.values[k]));
        }
        std::vector<std::uint32_t> starts = rows.starts;
        const ivec2 startsSize = listSize(starts.size());
        starts.resize(std::size_t(startsSize.x) * std::size_t(startsSize.y), 0);
        made = {{context_.device(), {.size = startsSize, .format = Format::R32UI}, label},
                {context_.device(), {.size = size, .format = Format::RGBA32UI}, label},
                int(rows.count())};
        context_.device().upload(made.starts.handle(), 0, starts);
        context_.device().upload(made.entries.handle(), 0, entries);
        return Done{};
    }

    gl::Context& context_;
    const Bake& bake_;
    BakeTextures& gpu_;
};

} // namespace

void BakeTextures::addBytes(std::map<std::string, std::size_t>& bytes) const {
    const auto add = [&](const graph::Texture& texture) {
        if (texture) bytes[texture.label()] += texture.desc().bytes();
    };
    for (const graph::Texture* texture :
         {&place, &frame, &corners, &triangles, &charts, &near, &reach, &filters})
        add(*texture);
    for (const Matrix* matrix : {&duals, &close, &inner, &outer, &direct}) {
        add(matrix->starts);
        add(matrix->entries);
    }
}

Result<std::shared_ptr<const BakeTextures>> upload(gl::Context& context, std::shared_ptr<const Bake> bake) {
    const auto gpu = std::make_shared<BakeTextures>();
    gpu->bake = std::move(bake);
    Uploading uploading(context, *gpu->bake, *gpu);
    uploading.atlas();
    uploading.triangles();
    if (gpu->bake->options.local == Local::Live)
        uploading.live();
    else
        uploading.stored();
    if (Status done = uploading.matrices(); !done) return done.error();
    return std::shared_ptr<const BakeTextures>(gpu);
}

} // namespace lucent::throughput
