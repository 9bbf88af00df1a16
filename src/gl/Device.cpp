#include "gl/Device.h"

#include "gl/Gl.h"
#include "gl/Program.h"

#include <algorithm>

namespace lucent::gl {

using graph::Format;
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
    case Format::R32F:
        return {GL_R32F, GL_RED, GL_FLOAT};
    case Format::R32UI:
        return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case Format::RGBA16F:
        return {GL_RGBA16F, GL_RGBA, GL_HALF_FLOAT};
    case Format::RGBA32F:
        return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
    case Format::Depth24:
        return {GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT};
    }
    return {};
}

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

} // namespace

class Device::PassCommands : public graph::Commands {
public:
    PassCommands(Device& device, ivec2 size) : device_(device), size_(size) {}

    void draw(const graph::Draw& draw) override {
        const auto& program = static_cast<const Program&>(*draw.program);
        glUseProgram(program.id());
        if (!bindBlock(program, draw.block)) return;
        bindTextures(program, draw.textures);
        setState(GL_DEPTH_TEST, draw.depthTest);
        setState(GL_CULL_FACE, draw.cullFront);
        setState(GL_BLEND, draw.add);
        if (draw.add) glBlendFunc(GL_ONE, GL_ONE);
        glCullFace(GL_FRONT);
        const ivec4 region = draw.region.z > 0 ? draw.region : ivec4(0, 0, size_);
        glViewport(region.x, region.y, region.z, region.w);
        glDrawArrays(GL_TRIANGLES, 0, draw.vertices);
        ++device_.draws_;
    }

private:
    // A sampler that this draw does not need is unbound: what an earlier draw left there may be this pass's
    // target, and WebGL refuses the loop even when the shader never looks.
    void bindTextures(const Program& program, const std::vector<graph::Binding>& bindings) {
        for (std::size_t unit = 0; unit < program.samplers().size(); ++unit) {
            const auto bound =
                std::find_if(bindings.begin(), bindings.end(), [&](const graph::Binding& binding) {
                    return binding.sampler == program.samplers()[unit];
                });
            glActiveTexture(GLenum(GL_TEXTURE0 + unit));
            glBindTexture(GL_TEXTURE_2D, bound == bindings.end() ? 0 : device_.record(bound->texture).id);
        }
    }
    bool bindBlock(const Program& program, const graph::Block& block) {
        if (!block.layout) return true;
        if (Status status = program.checkBlock(*block.layout); !status) {
            device_.fail(status.error().message);
            return false;
        }
        glBindBuffer(GL_UNIFORM_BUFFER, device_.blockBuffer_);
        glBufferData(GL_UNIFORM_BUFFER, GLsizeiptr(block.bytes.size()), block.bytes.data(), GL_STREAM_DRAW);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, device_.blockBuffer_);
        return true;
    }
    static void setState(GLenum state, bool on) { on ? glEnable(state) : glDisable(state); }
    Device& device_;
    ivec2 size_;
};

Device::Device() {
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
    glBindTexture(GL_TEXTURE_2D, texture.id);
    glTexStorage2D(GL_TEXTURE_2D, desc.levels, glFormat(desc.format).internal, desc.size.x, desc.size.y);
    const GLint filter = desc.linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER,
                    desc.levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    const auto handle = TextureHandle(nextHandle_++);
    if (const GLenum error = glGetError())
        fail("texture \"" + texture.label + "\" of " + std::to_string(desc.size.x) + "x" +
             std::to_string(desc.size.y) + " " + graph::name(desc.format) + ": " + errorName(error));
    textureBytes_ += desc.bytes();
    textures_.emplace(handle, std::move(texture));
    return handle;
}

void Device::destroyTexture(TextureHandle texture) {
    const auto found = textures_.find(texture);
    assert(found != textures_.end());
    std::erase_if(framebuffers_, [&](const auto& entry) {
        if (!std::count(entry.first.begin(), entry.first.end(), std::uint32_t(texture))) return false;
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

void Device::upload(TextureHandle texture, int level, std::span<const std::byte> rows) {
    const Record& target = record(texture);
    const GlFormat format = glFormat(target.desc.format);
    const ivec2 size = glm::max(target.desc.size >> level, ivec2(1));
    assert(rows.size() == std::size_t(size.x) * size.y * graph::bytesPerTexel(target.desc.format));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, target.id);
    glTexSubImage2D(GL_TEXTURE_2D, level, 0, 0, size.x, size.y, format.format, format.type, rows.data());
}

// --- passes

ivec2 Device::sizeOf(const graph::PassTarget& target) const {
    const TextureHandle first = target.colors.front();
    return first == TextureHandle::Screen ? screenSize_ : record(first).desc.size;
}

unsigned Device::framebufferFor(const graph::PassTarget& target) {
    if (target.colors.front() == TextureHandle::Screen) return 0;
    std::vector<std::uint32_t> key;
    for (TextureHandle color : target.colors)
        key.push_back(std::uint32_t(color));
    key.push_back(0);
    key.push_back(std::uint32_t(target.depth));
    const auto [found, isNew] = framebuffers_.try_emplace(key, 0u);
    if (!isNew) return found->second;
    glGenFramebuffers(1, &found->second);
    glBindFramebuffer(GL_FRAMEBUFFER, found->second);
    std::vector<GLenum> buffers;
    for (TextureHandle color : target.colors) {
        const auto attachment = GLenum(GL_COLOR_ATTACHMENT0 + buffers.size());
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, record(color).id, 0);
        buffers.push_back(attachment);
    }
    if (target.depth != TextureHandle::None)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, record(target.depth).id,
                               0);
    glDrawBuffers(GLsizei(buffers.size()), buffers.data());
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        fail("pass \"" + std::string(target.label) + "\": its targets make no complete framebuffer");
    return found->second;
}

void Device::runPass(const graph::PassTarget& target, const std::function<void(graph::Commands&)>& body) {
    const ivec2 size = sizeOf(target);
    glBindVertexArray(vertexArray_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebufferFor(target));
    glViewport(0, 0, size.x, size.y);
    glDisable(GL_SCISSOR_TEST);
    glDepthMask(GL_TRUE);
    glDepthFunc(GL_LESS);
    if (target.clear) {
        glClearColor(target.clear->r, target.clear->g, target.clear->b, target.clear->a);
        glClear(GL_COLOR_BUFFER_BIT | (target.depth != TextureHandle::None ? GL_DEPTH_BUFFER_BIT : 0));
    }
    PassCommands commands(*this, size);
    body(commands);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glBindVertexArray(0);
    if (const GLenum error = glGetError())
        fail("pass \"" + std::string(target.label) + "\": " + errorName(error));
}

void Device::fail(const std::string& message) {
    if (error_.empty()) error_ = message;
}

std::string Device::takeError() { return std::exchange(error_, {}); }

// --- reading back

void Device::readPixels(TextureHandle texture, ivec2 size, std::vector<float>& out) {
    const bool isFloat = record(texture).desc.format != Format::RGBA8;
    const graph::PassTarget target{"read", {texture}, TextureHandle::None, {}};
    glBindFramebuffer(GL_FRAMEBUFFER, framebufferFor(target));
    out.resize(std::size_t(size.x) * size.y * 4);
    if (isFloat) {
        glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_FLOAT, out.data());
    } else {
        std::vector<std::uint8_t> bytes(out.size());
        glReadPixels(0, 0, size.x, size.y, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        std::transform(bytes.begin(), bytes.end(), out.begin(),
                       [](std::uint8_t b) { return float(b) / 255.0f; });
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (const GLenum error = glGetError())
        fail("reading \"" + record(texture).label + "\": " + errorName(error));
}

Image Device::read(TextureHandle texture) {
    const ivec2 size = record(texture).desc.size;
    Image image(size.x, size.y, 4);
    readPixels(texture, size, image.pixels);
    const std::size_t row = std::size_t(size.x) * 4;
    for (int y = 0; y < size.y / 2; ++y) // GL counts rows from the bottom
        std::swap_ranges(image.pixels.begin() + row * y, image.pixels.begin() + row * (y + 1),
                         image.pixels.begin() + row * (size.y - 1 - y));
    return image;
}

void Device::wait(TextureHandle texture) {
    std::vector<float> pixel;
    readPixels(texture, {1, 1}, pixel);
}

} // namespace lucent::gl
