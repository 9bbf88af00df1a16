#pragma once
/// Textures, index buffers and passes on GL: what a frame graph runs on.

#include "base/Image.h"
#include "gl/Caps.h"
#include "graph/Device.h"

#include <map>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <vector>

namespace lucent::gl {

class Device : public graph::Device {
public:
    explicit Device(const Caps& caps);
    ~Device() override;

    graph::TextureHandle createTexture(const graph::TextureDesc& desc, std::string_view label) override;
    void destroyTexture(graph::TextureHandle texture) override;
    graph::IndicesHandle createIndices(std::span<const std::uint32_t> indices,
                                       std::string_view label) override;
    void destroyIndices(graph::IndicesHandle indices) override;
    void runPass(const graph::PassTarget& target, const std::function<void(graph::Commands&)>& body) override;

    /// Fills rows of one level of one layer, tightly packed.
    ///
    /// @param first  row of texelFetch that `rows` begin with
    void upload(graph::TextureHandle texture, int level, int layer, std::span<const std::byte> rows,
                int first = 0);
    template <class Value>
    void upload(graph::TextureHandle texture, int level, int layer, const std::vector<Value>& values) {
        upload(texture, level, layer, std::as_bytes(std::span(values)));
    }
    template <class Value>
    void upload(graph::TextureHandle texture, int level, const std::vector<Value>& values) {
        upload(texture, level, 0, values);
    }

    /// Reads one layer and level of a float or 8-bit colour texture back, top row (the last of texelFetch)
    /// first, 4 channels.
    Image read(graph::TextureHandle texture, int layer = 0, int level = 0);
    /// The same of an integer texture: 4 values a texel, absent channels 0, 0 and 1.
    std::vector<std::uint32_t> readIntegers(graph::TextureHandle texture, int layer = 0, int level = 0);
    /// Waits until everything drawn into the texture is there, by reading one pixel: times real work on every
    /// driver, software ones included.
    void wait(graph::TextureHandle texture);

    /// Size in pixels of the default framebuffer, where passes on TextureHandle::Screen draw.
    void setScreenSize(ivec2 size) { screenSize_ = size; }

    /// After each pass, reads back what it drew into floats and reports NaN and infinity as errors with the
    /// names of pass and texture. Slow; on from the start in debug builds.
    void checkTargets(bool on) { checksTargets_ = on; }
    /// Withholds the answers of queries for this many polls more: how a test makes them late.
    void delayQueries(int polls) { queryDelay_ = polls; }
    int queryDelay() const { return queryDelay_; }

    /// First error of any pass since the last call ("" if none): block layouts, incomplete targets, blending
    /// that this GPU cannot do, GL errors. In a browser none of GL's own: Context::takeError().
    std::string takeError();
    int drawCount() const { return draws_; }
    int readCount() const { return reads_; } ///< how often one was read back as floats
    std::size_t textureBytes() const { return textureBytes_; }
    std::size_t indexBytes() const { return indexBytes_; }

private:
    class PassCommands;
    struct Record {
        unsigned id = 0;
        graph::TextureDesc desc;
        std::string label;
    };
    struct IndexRecord {
        unsigned id = 0;
        int count = 0;
        std::string label;
    };
    // Texture, layer and level of each colour, then of the depth.
    using FramebufferKey = std::vector<std::tuple<graph::TextureHandle, int, int>>;
    const Record& record(graph::TextureHandle texture) const;
    unsigned framebufferFor(const graph::PassTarget& target);
    std::vector<int> formatsOf(const graph::PassTarget& target) const;
    bool hasStencil(const graph::PassTarget& target) const;
    void attach(unsigned point, const graph::Attachment& attachment) const;
    ivec2 sizeOf(const graph::PassTarget& target) const;
    void clear(const graph::PassTarget& target);
    void findBroken(const graph::PassTarget& target, const std::vector<ivec4>& drawn);
    void readTexels(const graph::Attachment& from, ivec2 size, unsigned format, unsigned type, void* out);
    void fail(const std::string& message);

    const Caps caps_;
    std::map<graph::TextureHandle, Record> textures_;
    std::map<graph::IndicesHandle, IndexRecord> indices_;
    std::map<FramebufferKey, unsigned> framebuffers_;
    std::set<std::vector<int>> complete_; // formats of framebuffers, the depth's last
    std::uint32_t nextHandle_ = 1;
    unsigned vertexArray_ = 0, blockBuffer_ = 0;
    ivec2 screenSize_{0};
    std::string error_;
    int queryDelay_ = 0;
    int draws_ = 0, reads_ = 0;
#ifdef NDEBUG
    bool checksTargets_ = false;
#else
    bool checksTargets_ = true;
#endif
    std::size_t textureBytes_ = 0, indexBytes_ = 0;
};

} // namespace lucent::gl
