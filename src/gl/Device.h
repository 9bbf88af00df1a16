#pragma once
/// Textures and passes on GL: what a frame graph runs on.

#include "base/Image.h"
#include "graph/Device.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace lucent::gl {

class Device : public graph::Device {
public:
    Device();
    ~Device() override;

    graph::TextureHandle createTexture(const graph::TextureDesc& desc, std::string_view label) override;
    void destroyTexture(graph::TextureHandle texture) override;
    void runPass(const graph::PassTarget& target, const std::function<void(graph::Commands&)>& body) override;

    /// Fills one level of a texture. `rows` holds its texels from the top row on, tightly packed.
    void upload(graph::TextureHandle texture, int level, std::span<const std::byte> rows);
    template <class Value>
    void upload(graph::TextureHandle texture, int level, const std::vector<Value>& values) {
        upload(texture, level, std::as_bytes(std::span(values)));
    }

    /// Reads a float or 8-bit colour texture back, top row first, 4 channels.
    Image read(graph::TextureHandle texture);
    /// Waits until everything drawn into the texture is there, by reading one pixel: times real work on every
    /// driver, software ones included.
    void wait(graph::TextureHandle texture);

    /// Size in pixels of the default framebuffer, where passes on TextureHandle::Screen draw.
    void setScreenSize(ivec2 size) { screenSize_ = size; }

    /// First error of any pass since the last call ("" if none): block layouts, incomplete targets, GL
    /// errors.
    std::string takeError();
    int drawCount() const { return draws_; }
    std::size_t textureBytes() const { return textureBytes_; }

private:
    class PassCommands;
    struct Record {
        unsigned id = 0;
        graph::TextureDesc desc;
        std::string label;
    };
    const Record& record(graph::TextureHandle texture) const;
    unsigned framebufferFor(const graph::PassTarget& target);
    ivec2 sizeOf(const graph::PassTarget& target) const;
    void readPixels(graph::TextureHandle texture, ivec2 size, std::vector<float>& out);
    void fail(const std::string& message);

    std::map<graph::TextureHandle, Record> textures_;
    std::map<std::vector<std::uint32_t>, unsigned> framebuffers_;
    std::uint32_t nextHandle_ = 1;
    unsigned vertexArray_ = 0, blockBuffer_ = 0;
    ivec2 screenSize_{0};
    std::string error_;
    int draws_ = 0;
    std::size_t textureBytes_ = 0;
};

} // namespace lucent::gl
