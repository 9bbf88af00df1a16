#include "gl/Device.h"

#include "gl/Gl.h"
#include "gl/Program.h"
#include "gl/Query.h"

#include <algorithm>
#include <cmath>

namespace lucent::gl {

using graph::Format;
using graph::IndicesHandle;
using graph::Kind;
using graph::TextureHandle;

namespace {

struct GlFormat {
    GLenum internal, format, type;
};

GlFormat glFormat(Format format) {
    switch (format) {
    case Format::R8:
        return {GL_R8, GL_RED, GL_UNSIGNED_BYTE};
    case Format::RGBA8:
        return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Format::SRGBA8:
        return {GL_SRGB8_ALPHA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case Format::R16F:
        return {GL_R16F, GL_RED, GL_HALF_FLOAT};
    case Format::RG16F:
        return {GL_RG16F, GL_RG, GL_HALF_FLOAT};
    case Format::RGBA16F:
        return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case Format::R32F:
        return {GL_R32F, GL_RED, GL_FLOAT};
    case Format::RG32F:
        return {GL_RG32F, GL_RG, GL_FLOAT};
    case Format::RGBA32F:
        return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Format::R32UI:
        return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case Format::RG32UI:
        return {GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT};
    case Format::RGBA32UI:
        return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
    case Format::Depth24:
        return {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
    case Format::Depth32F:
        return {GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT, GL_FLOAT};
    case Format::Depth32FStencil8:
        return {GL_DEPTH32F_STENCIL8, GL_DEPTH_STENCIL, GL_FLOAT_32_UNSIGNED_INT_24_8_REV};
    }
    return {};
}

// 0 where to ask is to wait: Context::takeError() does later.
GLenum errorNow() { return kAnswersAtOnce ? glGetError() : GL_NO_ERROR; }

std::string errorName(GLenum error) {
    switch (error) {
    case GL_INVALID_ENUM:
        return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
        return "GL_OUT_OF_MEMORY";
    default:
        return "GL error " + std::to_string(error);
    }
}

GLenum textureTarget(const graph::TextureDesc& desc) {
    return desc.layers > 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
}

GLenum glTopology(graph::Topology topology) {
    constexpr GLenum kModes[] = {GL_TRIANGLES, GL_LINES, GL_POINTS};
    return kModes[int(topology)];
}

void setState(GLenum state, bool on) { on ? glEnable(state) : glDisable(state); }

void setCull(graph::Cull cull) {
    setState(GL_CULL_FACE, cull != graph::Cull::None);
    glCullFace(cull == graph::Cull::Front ? GL_FRONT : GL_BACK);
}

void setDepth(graph::DepthTest test, bool write) {
    constexpr GLenum kFunctions[] = {GL_ALWAYS, GL_LESS, GL_LEQUAL, GL_EQUAL, GL_GREATER};
    setState(GL_DEPTH_TEST, test != graph::DepthTest::None);
    glDepthFunc(kFunctions[int(test)]);
    glDepthMask(write);
}

void setStencil(graph::Stencil stencil, int counted) {
    setState(GL_STENCIL_TEST, stencil != graph::Stencil::None);
    const bool counts = stencil == graph::Stencil::Count;
    glStencilFunc(counts ? GL_ALWAYS : GL_LESS, counted, 0xff);
    const GLenum then = counts ? GL_INCR : GL_KEEP;
    glStencilOp(then, then, then);
}

void setBlend(graph::Blend blend) {
    constexpr GLenum kEquations[] = {GL_FUNC_ADD, GL_FUNC_ADD, GL_MAX, GL_MIN};
    setState(GL_BLEND, blend != graph::Blend::None);
    glBlendEquation(kEquations[int(blend)]);
    glBlendFunc(GL_ONE, GL_ONE);
}

// GL counts rows from the bottom, images from the top.
template <class Value>
void flipRows(std::vector<Value>& texels, ivec2 size) {
    const std::size_t row = std::size_t(size.x) * 4;
    for (int y = 0; y < size.y / 2; ++y)
        std::swap_ranges(texels.begin() + row * y, texels.begin() + row * (y + 1),
                         texels.begin() + row * (size.y - 1 - y));
}

} // namespace

class Device::PassCommands : public graph::Commands {
public:
    PassCommands(Device& device, const graph::PassTarget& target, ivec2 size)
        : device_(device), target_(target), size_(size) {}

    void draw(const graph::Draw& draw) override {
        const auto& program = static_cast<const Program&>(*draw.program);
        if (const Status& ready = program.ready(); !ready) return device_.fail(ready.error().message);
        glUseProgram(program.id());
        if (!bindBlock(program, draw.block) || !bindTextures(program, draw.textures) || !bindIndices(draw) ||
            !canBlend(draw.blend))
            return;
        setCull(draw.cull);
        setDepth(draw.depthTest, draw.depthWrite);
        setStencil(draw.stencil, draw.counted);
        setBlend(draw.blend);
        const ivec4 region = draw.region.z > 0 ? draw.region : ivec4(0, 0, size_);
        glViewport(region.x, region.y, region.z, region.w);
        const bool some = draw.rows.y > 0;
        setState(GL_SCISSOR_TEST, some);
        if (some) glScissor(0, draw.rows.x, size_.x, draw.rows.y - draw.rows.x);
        const ivec4 covered = some ? ivec4(0, draw.rows.x, size_.x, draw.rows.y - draw.rows.x) : region;
        if (draw.indices == IndicesHandle::None)
            glDrawArraysInstanced(glTopology(draw.topology), 0, draw.vertices, draw.instances);
        else
            glDrawElementsInstanced(glTopology(draw.topology), draw.vertices, GL_UNSIGNED_INT, nullptr,
                                    draw.instances);
        ++device_.draws_;
        if (std::find(drawn_.begin(), drawn_.end(), covered) == drawn_.end()) drawn_.push_back(covered);
    }
    /// The regions that were drawn, each once.
    const std::vector<ivec4>& drawn() const { return drawn_; }

private:
    bool refuse(const std::string& why) {
        device_.fail("pass \"" + std::string(target_.label) + "\": " + why);
        return false;
    }
    // A sampler that this draw does not need is unbound: what an earlier draw left there may be this pass's
    // target, and WebGL refuses the loop even when the shader never looks.
    bool bindTextures(const Program& program, const std::vector<graph::Binding>& bindings) {
        for (std::size_t unit = 0; unit < program.samplers().size(); ++unit) {
            const Program::Sampler& sampler = program.samplers()[unit];
            const auto bound =
                std::find_if(bindings.begin(), bindings.end(),
                             [&](const graph::Binding& binding) { return binding.sampler == sampler.name; });
            GLuint id = 0;
            if (bound != bindings.end()) {
                const Record& texture = device_.record(bound->texture);
                if (textureTarget(texture.desc) != sampler.target)
                    return refuse("binds \"" + texture.label + "\" of " + texture.desc.text() + " to " +
                                  sampler.name + "; must be " +
                                  (sampler.target == GL_TEXTURE_2D ? "a texture of one layer"
                                                                   : "a texture of several layers"));
                id = texture.id;
            }
            glActiveTexture(GLenum(GL_TEXTURE0 + unit));
            glBindTexture(sampler.target, id);
        }
        return true;
    }
    bool bindIndices(const graph::Draw& draw) {
        if (draw.indices == IndicesHandle::None) return true;
        const IndexRecord& indices = device_.indices_.at(draw.indices);
        if (draw.vertices > indices.count)
            return refuse("draws " + std::to_string(draw.vertices) + " indices of \"" + indices.label +
                          "\"; must be at most " + std::to_string(indices.count));
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices.id);
        return true;
    }
    bool canBlend(graph::Blend blend) {
        if (blend == graph::Blend::None) return true;
        for (const graph::Attachment& color : target_.colors) {
            if (color.texture == TextureHandle::Screen) continue;
            const Record& texture = device_.record(color.texture);
            const Kind kind = kindOf(texture.desc.format);
            const std::string into =
                "blends into \"" + texture.label + "\" (" + graph::name(texture.desc.format) + ")";
            if (kind == Kind::Float && !device_.caps_.floatBlend)
                return refuse(into + " without EXT_float_blend; must be 16-bit floats or summed over passes");
            if (kind == Kind::Half && !device_.caps_.halfBlend)
                return refuse(into + " on a GPU that cannot; must be summed over passes");
        }
        return true;
    }
    bool bindBlock(const Program& program, const graph::Block& block) {
        if (block.name.empty()) return true;
        if (Status status = program.checkBlock(block); !status) {
            device_.fail(status.error().message);
            return false;
        }
        glBindBuffer(GL_UNIFORM_BUFFER, device_.blockBuffer_);
        glBufferData(GL_UNIFORM_BUFFER, GLsizeiptr(block.bytes.size()), block.bytes.data(), GL_STREAM_DRAW);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, device_.blockBuffer_);
        return true;
    }
    Device& device_;
    const graph::PassTarget& target_;
    ivec2 size_;
    std::vector<ivec4> drawn_;
};

Device::Device(const Caps& caps) : caps_(caps) {
    glGenVertexArrays(1, &vertexArray_);
    glGenBuffers(1, &blockBuffer_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
}

Device::~Device() {
    for (auto& [key, framebuffer] : framebuffers_)
        glDeleteFramebuffers(1, &framebuffer);
    glDeleteVertexArrays(1, &vertexArray_);
    glDeleteBuffers(1, &blockBuffer_);
}

// --- textures

TextureHandle Device::createTexture(const graph::TextureDesc& desc, std::string_view label) {
    Record texture;
    texture.desc = desc;
    texture.label = label;
    glGenTextures(1, &texture.id);
    glActiveTexture(GL_TEXTURE0);
    const GLenum target = textureTarget(desc);
    const GLenum internal = glFormat(desc.format).internal;
    glBindTexture(target, texture.id);
    if (desc.layers > 1)
        glTexStorage3D(target, desc.levels, internal, desc.size.x, desc.size.y, desc.layers);
    else
        glTexStorage2D(target, desc.levels, internal, desc.size.x, desc.size.y);
    const GLint filter = desc.linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(target, GL_TEXTURE_MIN_FILTER, desc.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : filter);
    glTexParameteri(target, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    const auto handle = TextureHandle(nextHandle_++);
    if (const GLenum error = errorNow())
        fail("texture \"" + texture.label + "\" of " + desc.text() + ": " + errorName(error));
    textureBytes_ += desc.bytes();
    textures_.emplace(handle, std::move(texture));
    return handle;
}

void Device::destroyTexture(TextureHandle texture) {
    const auto found = textures_.find(texture);
    assert(found != textures_.end());
    std::erase_if(framebuffers_, [&](const auto& entry) {
        const FramebufferKey& key = entry.first;
        if (std::none_of(key.begin(), key.end(),
                         [texture](const auto& attached) { return std::get<0>(attached) == texture; }))
            return false;
        glDeleteFramebuffers(1, &entry.second);
        return true;
    });
    glDeleteTextures(1, &found->second.id);
    textureBytes_ -= found->second.desc.bytes();
    textures_.erase(found);
}

const Device::Record& Device::record(TextureHandle texture) const {
    const auto found = textures_.find(texture);
    assert(found != textures_.end() && "texture of another device, or destroyed");
    return found->second;
}

void Device::upload(TextureHandle texture, int level, int layer, std::span<const std::byte> rows, int first) {
    const graph::TextureDesc& desc = record(texture).desc;
    const GlFormat format = glFormat(desc.format);
    ivec2 size = desc.sizeOf(level);
    const std::size_t bytesPerRow = std::size_t(size.x) * graph::bytesPerTexel(desc.format);
    assert(rows.size() % bytesPerRow == 0 && first + int(rows.size() / bytesPerRow) <= size.y);
    assert(layer >= 0 && layer < desc.layers);
    size.y = int(rows.size() / bytesPerRow);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(textureTarget(desc), record(texture).id);
    if (desc.layers > 1)
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, first, layer, size.x, size.y, 1, format.format,
                        format.type, rows.data());
    else
        glTexSubImage2D(GL_TEXTURE_2D, level, 0, first, size.x, size.y, format.format, format.type,
                        rows.data());
}

// --- index buffers

IndicesHandle Device::createIndices(std::span<const std::uint32_t> indices, std::string_view label) {
    IndexRecord made{.id = 0, .count = int(indices.size()), .label = std::string(label)};
    glGenBuffers(1, &made.id);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, made.id);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
    if (const GLenum error = errorNow())
        fail("indices \"" + made.label + "\", " + std::to_string(made.count) + ": " + errorName(error));
    indexBytes_ += indices.size_bytes();
    const auto handle = IndicesHandle(nextHandle_++);
    indices_.emplace(handle, std::move(made));
    return handle;
}

void Device::destroyIndices(IndicesHandle indices) {
    const auto found = indices_.find(indices);
    assert(found != indices_.end());
    glDeleteBuffers(1, &found->second.id);
    indexBytes_ -= std::size_t(found->second.count) * sizeof(std::uint32_t);
    indices_.erase(found);
}

// --- passes

namespace {
bool isScreen(const graph::PassTarget& target) {
    return !target.colors.empty() && target.colors.front().texture == TextureHandle::Screen;
}
} // namespace

ivec2 Device::sizeOf(const graph::PassTarget& target) const {
    if (isScreen(target)) return screenSize_;
    const graph::Attachment& first = target.colors.empty() ? target.depth : target.colors.front();
    return record(first.texture).desc.sizeOf(first.level);
}

bool Device::hasStencil(const graph::PassTarget& target) const {
    return record(target.depth.texture).desc.format == Format::Depth32FStencil8;
}

void Device::attach(unsigned point, const graph::Attachment& attachment) const {
    const Record& texture = record(attachment.texture);
    if (texture.desc.layers > 1)
        glFramebufferTextureLayer(GL_FRAMEBUFFER, point, texture.id, attachment.level, attachment.layer);
    else
        glFramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, texture.id, attachment.level);
}

unsigned Device::framebufferFor(const graph::PassTarget& target) {
    const bool hasDepth = target.depth.texture != TextureHandle::None;
    if (isScreen(target)) {
        assert(target.colors.size() == 1 && !hasDepth && "the screen has no textures beside it");
        return 0;
    }
    FramebufferKey key;
    for (const graph::Attachment& color : target.colors)
        key.emplace_back(color.texture, color.layer, color.level);
    key.emplace_back(target.depth.texture, target.depth.layer, target.depth.level);
    const auto [found, isNew] = framebuffers_.try_emplace(key, 0u);
    if (!isNew) return found->second;
    glGenFramebuffers(1, &found->second);
    glBindFramebuffer(GL_FRAMEBUFFER, found->second);
    std::vector<GLenum> buffers;
    for (const graph::Attachment& color : target.colors) {
        buffers.push_back(GLenum(GL_COLOR_ATTACHMENT0 + buffers.size()));
        attach(buffers.back(), color);
    }
    if (hasDepth)
        attach(hasStencil(target) ? GL_DEPTH_STENCIL_ATTACHMENT : GL_DEPTH_ATTACHMENT, target.depth);
    glDrawBuffers(GLsizei(buffers.size()), buffers.data());
    // Targets of formats that made a complete framebuffer before make another one.
    // Where to ask is to wait, drawing tells: errorNow().
    if (const std::vector<int> formats = formatsOf(target); kAnswersAtOnce && !complete_.contains(formats)) {
        if (glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE)
            complete_.insert(formats);
        else
            fail("pass \"" + std::string(target.label) + "\": its targets make no complete framebuffer");
    }
    return found->second;
}

std::vector<int> Device::formatsOf(const graph::PassTarget& target) const {
    std::vector<int> formats;
    for (const graph::Attachment& color : target.colors)
        formats.push_back(int(record(color.texture).desc.format));
    const bool hasDepth = target.depth.texture != TextureHandle::None;
    formats.push_back(hasDepth ? int(record(target.depth.texture).desc.format) : -1);
    return formats;
}

void Device::clear(const graph::PassTarget& target) {
    for (std::size_t i = 0; i < target.colors.size(); ++i) {
        const auto& value = target.colors[i].clear;
        if (!value) continue;
        if (const vec4* color = std::get_if<vec4>(&*value)) glClearBufferfv(GL_COLOR, GLint(i), &color->x);
        if (const auto* whole = std::get_if<graph::uvec4>(&*value))
            glClearBufferuiv(GL_COLOR, GLint(i), &whole->x);
    }
    if (!target.depth.clear) return;
    glDepthMask(GL_TRUE); // the mask holds for clearing too
    const float depth = std::get<float>(*target.depth.clear);
    if (hasStencil(target))
        glClearBufferfi(GL_DEPTH_STENCIL, 0, depth, 0);
    else
        glClearBufferfv(GL_DEPTH, 0, &depth);
}

void Device::runPass(const graph::PassTarget& target, const std::function<void(graph::Commands&)>& body) {
    const ivec2 size = sizeOf(target);
    auto* query = static_cast<Query*>(target.query);
    glBindVertexArray(vertexArray_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebufferFor(target));
    glDisable(GL_SCISSOR_TEST);
    clear(target);
    PassCommands commands(*this, target, size);
    if (query) query->begin();
    body(commands);
    if (query) query->end();
    if (checksTargets_ && !isScreen(target)) findBroken(target, commands.drawn());
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    if (const GLenum error = errorNow())
        fail("pass \"" + std::string(target.label) + "\": " + errorName(error));
}

void Device::findBroken(const graph::PassTarget& target, const std::vector<ivec4>& drawn) {
    const ivec4 whole(0, 0, sizeOf(target));
    std::vector<float> values;
    for (std::size_t i = 0; i < target.colors.size(); ++i) {
        const graph::Attachment& color = target.colors[i];
        const Record& texture = record(color.texture);
        if (const Kind kind = kindOf(texture.desc.format); kind != Kind::Half && kind != Kind::Float)
            continue;
        glReadBuffer(GLenum(GL_COLOR_ATTACHMENT0 + i));
        // What was neither cleared nor drawn may be undefined.
        for (const ivec4& region : color.clear ? std::vector{whole} : drawn) {
            const ivec2 low = glm::max(ivec2(region), ivec2(0));
            const ivec2 size =
                glm::min(ivec2(region) + ivec2(region.z, region.w), ivec2(whole.z, whole.w)) - low;
            if (size.x <= 0 || size.y <= 0) continue;
            values.resize(std::size_t(size.x) * size.y * 4);
            glReadPixels(low.x, low.y, size.x, size.y, GL_RGBA, GL_FLOAT, values.data());
            const auto broken =
                std::find_if(values.begin(), values.end(), [](float v) { return !std::isfinite(v); });
            if (broken == values.end()) continue;
            const int texel = int(broken - values.begin()) / 4;
            fail("pass \"" + std::string(target.label) + "\": leaves " +
                 (std::isnan(*broken) ? "NaN" : "infinity") + " in \"" + texture.label + "\" at texel " +
                 std::to_string(low.x + texel % size.x) + ", " + std::to_string(low.y + texel / size.x) +
                 ", layer " + std::to_string(color.layer) + "; must be finite");
        }
    }
}

void Device::fail(const std::string& message) {
    if (error_.empty()) error_ = message;
}

std::string Device::takeError() { return std::exchange(error_, {}); }

// --- reading back

void Device::readTexels(const graph::Attachment& from, ivec2 size, unsigned format, unsigned type,
                        void* out) {
    glBindFramebuffer(GL_FRAMEBUFFER, framebufferFor({.label = "read", .colors = {from}}));
    glReadPixels(0, 0, size.x, size.y, format, type, out);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (const GLenum error = glGetError())
        fail("reading \"" + record(from.texture).label + "\": " + errorName(error));
}

Image Device::read(TextureHandle texture, int layer, int level) {
    const graph::TextureDesc& desc = record(texture).desc;
    const ivec2 size = desc.sizeOf(level);
    ++reads_;
    Image image(size.x, size.y, 4);
    if (kindOf(desc.format) == Kind::Fraction) {
        std::vector<std::uint8_t> bytes(image.pixels.size());
        readTexels({texture, layer, level, {}}, size, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        std::transform(bytes.begin(), bytes.end(), image.pixels.begin(),
                       [](std::uint8_t b) { return float(b) / 255.0f; });
    } else {
        readTexels({texture, layer, level, {}}, size, GL_RGBA, GL_FLOAT, image.pixels.data());
    }
    flipRows(image.pixels, size);
    return image;
}

std::vector<std::uint32_t> Device::readIntegers(TextureHandle texture, int layer, int level) {
    const ivec2 size = record(texture).desc.sizeOf(level);
    std::vector<std::uint32_t> texels(std::size_t(size.x) * size.y * 4);
    readTexels({texture, layer, level, {}}, size, GL_RGBA_INTEGER, GL_UNSIGNED_INT, texels.data());
    flipRows(texels, size);
    return texels;
}

void Device::wait(TextureHandle texture) {
    const Kind kind = kindOf(record(texture).desc.format);
    std::uint32_t pixel[4];
    if (kind == Kind::Integer)
        readTexels({texture, 0, 0, {}}, {1, 1}, GL_RGBA_INTEGER, GL_UNSIGNED_INT, pixel);
    else
        readTexels({texture, 0, 0, {}}, {1, 1}, GL_RGBA, kind == Kind::Fraction ? GL_UNSIGNED_BYTE : GL_FLOAT,
                   pixel);
}

} // namespace lucent::gl
