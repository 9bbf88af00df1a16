#include "views/FieldTextures.h"

#include "views/Paint.h"

#include <algorithm>
#include <cmath>

namespace lucent::views {

using graph::Format;

HeightRange heightRange(const Image& heights) {
    const auto [lowest, highest] = std::minmax_element(heights.pixels.begin(), heights.pixels.end());
    return {*lowest, *highest};
}

namespace {

constexpr int kCoarsest = 16; // blocks on a side of the coarsest level, padding aside

int levelCount(ivec2 cells) {
    int levels = 1;
    while (std::max(cells.x, cells.y) >> levels > kCoarsest)
        ++levels;
    return levels;
}

// Heights as 16-bit numbers over a map's range.
struct Steps {
    explicit Steps(HeightRange range)
        : lowest(range.lowest), unit((double(range.highest) - range.lowest) / 65535.0) {}
    std::uint16_t below(float height) const { return std::uint16_t(std::floor(of(height))); }
    std::uint16_t above(float height) const { return std::uint16_t(std::ceil(of(height))); }
    double of(float height) const {
        return unit == 0 ? 0 : std::clamp((double(height) - lowest) / unit, 0.0, 65535.0);
    }
    double lowest, unit;
};

// One row of blocks. Apart: WebAssembly runs a function in its fast form only from a later call on.
[[gnu::noinline]] void finestRow(const Image& heights, const Steps& steps, int y, int blocks,
                                 std::uint16_t* pairs) {
    const int top = std::max(2 * y - 1, 0), bottom = std::min(2 * y + 1, heights.height - 1);
    for (int x = 0; x < blocks; ++x, pairs += 2) {
        float low = 1e38f, high = -1e38f;
        for (int j = top; j <= bottom; ++j)
            for (int i = std::max(2 * x - 1, 0); i <= std::min(2 * x + 1, heights.width - 1); ++i) {
                const float height = *heights.at(i, j);
                low = std::min(low, height);
                high = std::max(high, height);
            }
        if (low > high) continue;
        pairs[0] = steps.below(low);
        pairs[1] = steps.above(high);
    }
}

// The finest level: blocks of 2 x 2 cells, that is 3 x 3 samples, clamped at the border.
PyramidLevel finestLevel(const Image& heights, int levels) {
    const Steps steps(heightRange(heights));
    const ivec2 cells = heights.size() + 1;
    const int multiple = std::max(2, 1 << (levels - 1)); // even: the atlas is one and a half as wide
    PyramidLevel level;
    level.size = ((cells + 1) / 2 + multiple - 1) / multiple * multiple;
    level.pairs.assign(std::size_t(level.size.x) * level.size.y * 2, 0);
    const ivec2 blocks = (cells + 1) / 2;
    for (int y = 0; y < blocks.y; ++y)
        finestRow(heights, steps, y, blocks.x, &level.pairs[std::size_t(y) * level.size.x * 2]);
    return level;
}

PyramidLevel coarser(const PyramidLevel& fine) {
    PyramidLevel level;
    level.size = fine.size / 2;
    level.pairs.resize(std::size_t(level.size.x) * level.size.y * 2);
    for (int y = 0; y < level.size.y; ++y) {
        for (int x = 0; x < level.size.x; ++x) {
            const std::uint16_t* top = &fine.pairs[(std::size_t(2 * y) * fine.size.x + 2 * x) * 2];
            const std::uint16_t* down = top + std::size_t(fine.size.x) * 2;
            std::uint16_t* out = &level.pairs[(std::size_t(y) * level.size.x + x) * 2];
            out[0] = std::min({top[0], top[2], down[0], down[2]});
            out[1] = std::max({top[1], top[3], down[1], down[3]});
        }
    }
    return level;
}

} // namespace

std::vector<PyramidLevel> buildPyramid(const Image& heights) {
    std::vector<PyramidLevel> levels;
    const int count = levelCount((heights.size() + 2) / 2);
    levels.push_back(finestLevel(heights, count));
    while (int(levels.size()) < count)
        levels.push_back(coarser(levels.back()));
    return levels;
}

namespace {

struct Atlas {
    ivec2 size;
    std::vector<std::uint32_t> words; // lowest in the low half, highest in the high half
};

// The finest level at the left, the coarser ones above each other right of it.
Atlas packPyramid(const std::vector<PyramidLevel>& levels) {
    const ivec2 finest = levels[0].size;
    Atlas atlas{{finest.x * 3 / 2, finest.y}, {}};
    atlas.words.resize(std::size_t(atlas.size.x) * atlas.size.y);
    ivec2 corner(0);
    for (const PyramidLevel& level : levels) {
        for (int y = 0; y < level.size.y; ++y) {
            for (int x = 0; x < level.size.x; ++x) {
                const std::uint16_t* pair = &level.pairs[(std::size_t(y) * level.size.x + x) * 2];
                atlas.words[std::size_t(corner.y + y) * atlas.size.x + corner.x + x] =
                    std::uint32_t(pair[0]) | std::uint32_t(pair[1]) << 16;
            }
        }
        corner = corner.x ? ivec2(corner.x, corner.y + level.size.y) : ivec2(finest.x, 0);
    }
    return atlas;
}

} // namespace

FieldTextures::FieldTextures(gl::Context& context, std::shared_ptr<const Image> heights)
    : source_(std::move(heights)), range_(heightRange(*source_)) {
    gl::Device& device = context.device();
    heights_ = graph::Texture(device, {.size = source_->size(), .format = Format::R32F}, "views.heights");
    device.upload(heights_.handle(), 0, source_->pixels);
}

void FieldTextures::addPyramid(gl::Context& context) {
    gl::Device& device = context.device();
    const std::vector<PyramidLevel> levels = buildPyramid(*source_);
    levels_ = int(levels.size());
    const Atlas atlas = packPyramid(levels);
    pyramid_ = graph::Texture(device, {.size = atlas.size, .format = Format::R32UI}, "views.pyramid");
    device.upload(pyramid_.handle(), 0, atlas.words);
}

FieldBlock FieldTextures::block(const scene::HeightField& field) const {
    return {.texels = vec2(field.texels()),
            .texelSize = field.texelSize(),
            .heightScale = field.heightScale,
            .lowest = range_.lowest,
            .highest = range_.highest,
            .bottom = std::min(range_.lowest, 0.0f) * field.heightScale,
            .topLevel = float(levels_)};
}

std::vector<graph::Binding> FieldTextures::bindings() const {
    return {{"uHeights", heights_.handle()}, {"uPyramid", pyramid_.handle()}};
}

// --- cache

namespace {
std::size_t bytesOf(const graph::Texture& texture) { return texture.desc().bytes(); }
std::size_t bytesOf(const auto& textures) { return textures.bytes(); }
} // namespace

template <class Self, class Each>
void ImageCache::forEachCache(Self& self, const Each& each) {
    each(self.fields_);
    each(self.images_);
    each(self.meshes_);
    each(self.prisms_);
    each(self.paints_);
    each(self.places_);
    each(self.textures_);
}

Status ImageCache::checkSize(const Image& image) const {
    const int limit = context_.caps().maxTextureSize;
    if (image.width <= limit && image.height <= limit) return Done{};
    return Error{"image of " + std::to_string(image.width) + "x" + std::to_string(image.height) +
                     " pixels: too large for this GPU; must be at most " + std::to_string(limit) +
                     " on a side",
                 Fault::Machine};
}

Result<FieldTextures*> ImageCache::heights(const std::shared_ptr<const Image>& image) {
    if (!fields_.contains(image.get())) {
        if (Status fits = checkSize(*image); !fits) return fits.error();
        fields_[image.get()] = {std::make_unique<FieldTextures>(context_, image), image};
    }
    Entry<FieldTextures>& entry = fields_.at(image.get());
    entry.used = true;
    return entry.value.get();
}

Result<const FieldTextures*> ImageCache::field(const std::shared_ptr<const Image>& image) {
    const Result<FieldTextures*> field = heights(image);
    if (!field) return field.error();
    if (!(*field)->isWhole()) (*field)->addPyramid(context_);
    return *field;
}

Result<const MeshTextures*> ImageCache::mesh(const std::shared_ptr<const scene::Mesh>& mesh,
                                             bool refractive) {
    auto& entry = meshes_[mesh.get()];
    if (!entry.value) {
        entry.value = std::make_unique<MeshTextures>(context_, mesh);
        entry.source = mesh;
    }
    if (refractive) entry.value->addTriangles(context_);
    entry.used = true;
    return entry.value.get();
}

Result<const Prisms*> ImageCache::prisms(const std::shared_ptr<const scene::DisplacedBase>& base) {
    auto& entry = prisms_[base.get()];
    if (!entry.value) {
        const ivec2 size = Prisms::sizeFor(base->triangles.size());
        if (const int most = context_.caps().maxTextureSize; std::max(size.x, size.y) > most)
            return Error{"displacement of " + std::to_string(base->triangles.size()) +
                             " triangles: too many for this GPU; must be at most " +
                             std::to_string(base->triangles.size() / std::size_t(size.y) * std::size_t(most)),
                         Fault::Machine};
        entry.value = std::make_unique<Prisms>(context_.device(), *base);
        entry.source = base;
    }
    entry.used = true;
    return entry.value.get();
}

graph::TextureHandle ImageCache::texture(const std::shared_ptr<const scene::TextureImage>& image) {
    auto& entry = textures_[image.get()];
    if (!entry.value) {
        entry.value = std::make_unique<graph::Texture>(textureOf(context_.device(), *image));
        entry.source = image;
    }
    entry.used = true;
    return entry.value->handle();
}

bool ImageCache::takePart(const scene::Object& object) {
    if (object.isField()) return takePartOf(object.field(), object.material);
    const bool isMesh = !object.isDisplaced() && !isPainted(object); // of its own
    if (isMesh) {
        const std::shared_ptr<const scene::Mesh> source = scene::meshOf(object);
        const auto begun = meshes_.find(source.get());
        if (begun == meshes_.end()) return mesh(source, false).ok();
        const bool isTraced = object.material.isRefractive() || object.material.isMirror();
        if (isTraced && begun->second.value->addTrianglesPart(context_)) return true;
    }
    if (isPainted(object))
        for (const auto& map : {object.painting->entering, object.painting->leaving}) {
            const Result<PaintMap*> paint = begunPaint(map);
            if (!paint) return false; // who draws it says why
            if ((*paint)->takePart(context_.device())) return true;
        }
    const scene::Textures* textures = scene::texturesOf(object);
    if (!textures) return false;
    for (const scene::TextureUse* use :
         {&textures->color, &textures->emission, &textures->roughness, &textures->normal}) {
        if (use->image < 0) continue;
        const auto& image = std::get<scene::MeshShape>(object.shape).mesh->images[std::size_t(use->image)];
        if (textures_.contains(image.get())) continue;
        texture(image);
        return true;
    }
    return false;
}

bool ImageCache::takePartOf(const scene::HeightField& shape, const scene::Material& material) {
    const auto begun = fields_.find(shape.heights.get());
    if (begun == fields_.end()) return heights(shape.heights).ok();
    if (!begun->second.value->isWhole()) return field(shape.heights).ok();
    for (const auto* map : {&shape.alpha, &material.baseMap, &material.diffuseMap, &material.specularMap})
        if (*map && !images_.contains(map->get())) return image(*map).ok();
    return false;
}

Textured ImageCache::textured(const scene::Mesh& mesh, const scene::Textures& textures) {
    static const auto kWhite = [] {
        auto white = std::make_shared<scene::TextureImage>();
        white->size = {1, 1};
        white->texels.assign(4, 255);
        return std::shared_ptr<const scene::TextureImage>(white);
    }();
    const auto handleOf = [&](const scene::TextureUse& use) {
        return texture(use.image < 0 ? kWhite : mesh.images[std::size_t(use.image)]);
    };
    MeshTextures& vertices = *meshes_.at(&mesh).value;
    vertices.addCoordinates(context_);
    const auto wrap = [](const scene::TextureUse& use) {
        return float(int(use.u) + 3 * int(use.v) + (use.second ? 9 : 0));
    };
    return {.coordinates = vertices.coordinates().handle(),
            .colors = vertices.colors().handle(),
            .color = handleOf(textures.color),
            .emission = handleOf(textures.emission),
            .roughness = handleOf(textures.roughness),
            .normal = handleOf(textures.normal),
            .wraps = {wrap(textures.color), wrap(textures.emission), wrap(textures.roughness),
                      wrap(textures.normal)},
            // a white texel is no normal: of none x and y count nothing
            .normalScale = textures.normal.image < 0 ? 0 : textures.normalScale,
            .cutoff = textures.cutoff,
            .hasHoles = textures.hasHoles(),
            .isBlended = textures.isBlended()};
}

Result<graph::TextureHandle> ImageCache::image(const std::shared_ptr<const Image>& image) {
    if (Status fits = checkSize(*image); !fits) return fits.error();
    Entry<graph::Texture>& entry = images_[image.get()];
    if (!entry.value) {
        const bool scalar = image->channels == 1;
        const graph::TextureDesc desc{
            .size = image->size(), .format = scalar ? Format::R32F : Format::RGBA16F, .linear = !scalar};
        entry.value =
            std::make_unique<graph::Texture>(context_.device(), desc, scalar ? "views.alpha" : "views.map");
        entry.source = image;
        if (scalar) {
            context_.device().upload(entry.value->handle(), 0, image->pixels);
        } else {
            const std::uint16_t one = halfFrom(1);
            std::vector<std::uint16_t> halves(std::size_t(image->width) * image->height * 4, one);
            for (std::size_t i = 0; i < halves.size() / 4; ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    halves[4 * i + c] = halfFrom(image->pixels[3 * i + c]);
            context_.device().upload(entry.value->handle(), 0, halves);
        }
    }
    entry.used = true;
    return entry.value->handle();
}

Result<PaintMap*> ImageCache::begunPaint(const std::shared_ptr<const Image>& image) {
    if (Status fits = checkSize(*image); !fits) return fits.error();
    Entry<PaintMap>& entry = paints_[image.get()];
    if (!entry.value) {
        entry.value = std::make_unique<PaintMap>(context_.device(), image);
        entry.source = image;
    }
    entry.used = true;
    return entry.value.get();
}

Result<const PaintMap*> ImageCache::paintMap(const std::shared_ptr<const Image>& image) {
    const Result<PaintMap*> paint = begunPaint(image);
    if (!paint) return paint.error();
    while ((*paint)->takePart(context_.device())) {
    }
    return *paint;
}

Result<Paint> ImageCache::paint(const scene::Painting& painting,
                                const std::shared_ptr<const scene::Atlas>& atlas) {
    Result<const PaintMap*> entering = paintMap(painting.entering);
    if (!entering) return entering.error();
    Result<const PaintMap*> leaving = paintMap(painting.leaving);
    if (!leaving) return leaving.error();
    auto& places = places_[atlas.get()];
    if (!places.value) {
        places.value = std::make_unique<graph::Texture>(placeTexture(context_.device(), *atlas));
        places.source = atlas;
    }
    places.used = true;
    return Paint{(*entering)->texture(), (*leaving)->texture(), places.value->handle(), (*entering)->least(),
                 (*entering)->most()};
}

void ImageCache::trim() {
    forEachCache(*this, [](auto& cache) {
        std::erase_if(cache, [](const auto& entry) { return !entry.second.used; });
        for (auto& [key, entry] : cache)
            entry.used = false;
    });
}

void ImageCache::clear() {
    forEachCache(*this, [](auto& cache) { cache.clear(); });
}

std::size_t ImageCache::bytes() const {
    std::size_t sum = 0;
    forEachCache(*this, [&](const auto& cache) {
        for (const auto& entry : cache)
            sum += bytesOf(*entry.second.value);
    });
    return sum;
}

} // namespace lucent::views
