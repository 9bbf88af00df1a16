#pragma once
/// Passes declare what they read and write; what nobody reads is not drawn, and textures that are not needed
/// at the same time share memory. No GL here.

#include "base/Result.h"
#include "graph/Device.h"

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lucent::graph {

/// A texture of one graph; -1 is none.
struct TextureId {
    int index = -1;
    explicit operator bool() const { return index >= 0; }
    bool operator==(const TextureId&) const = default;
};

/// Resolves ids while a pass executes. Only what the pass declared may be asked for.
class Resources {
public:
    virtual ~Resources() = default;
    virtual TextureHandle operator[](TextureId id) const = 0;
};

using Execute = std::function<void(const Resources&, Commands&)>;

/// Keeps textures between frames so that an unchanged frame makes none.
class TexturePool {
public:
    explicit TexturePool(Device& device) : device_(device) {}
    Device& device() { return device_; }
    /// A texture like `desc` that is free now.
    std::size_t acquire(const TextureDesc& desc, const std::string& label);
    void release(std::size_t slot) { slots_[slot].free = true; }
    TextureHandle handle(std::size_t slot) const { return slots_[slot].texture.handle(); }
    /// Deletes what was not used since the last trim().
    void trim();
    std::size_t bytes() const;

private:
    struct Slot {
        Texture texture;
        bool free = true;
        bool used = true;
    };
    Device& device_;
    std::vector<Slot> slots_;
};

class FrameGraph;

/// Handed to a pass's setup.
class PassBuilder {
public:
    /// Why this pass runs: what `lucent explain` prints.
    void reason(std::string text);
    /// The pass reads this texture.
    void sample(TextureId id);
    /// The pass draws into a new texture of this frame.
    TextureId createColor(std::string label, const TextureDesc& desc);
    TextureId createDepth(std::string label, ivec2 size);
    /// The pass draws into a texture that outlives the frame, or into the screen.
    void write(TextureId id);
    /// All targets are cleared to this value first.
    void clear(vec4 value);

private:
    friend class FrameGraph;
    PassBuilder(FrameGraph& graph, int pass) : graph_(graph), pass_(pass) {}
    FrameGraph& graph_;
    int pass_;
};

class FrameGraph {
public:
    /// A texture that lives outside the graph.
    TextureId import(TextureHandle handle, const TextureDesc& desc, std::string label);
    /// Adds a pass; `setup` declares and returns what draws. The lambda it returns captures by value.
    void addPass(std::string name, const std::function<Execute(PassBuilder&)>& setup);
    /// Somebody outside reads this imported texture after the frame.
    void keep(TextureId id);

    /// Checks the declarations and culls what nobody reads.
    ///
    /// @return Error naming pass and texture: a texture that is sampled but never written, or sampled by the
    ///         pass that writes it, or targets of different size
    Status compile();
    /// Runs the passes that are left, in the order they were added. After compile().
    void execute(TexturePool& pool);

    int livePasses() const;
    /// One line a pass with reason, targets, size, format and bytes; culled passes at the end.
    std::string dump() const;
    /// Bytes of the textures that live passes make.
    std::size_t transientBytes() const;

private:
    friend class PassBuilder;
    struct Resource {
        std::string label;
        TextureDesc desc;
        TextureHandle imported = TextureHandle::None;
        bool kept = false;
        int writer = -1;  ///< last pass that draws into it
        int lastUse = -1; ///< last live pass that reads or writes it
        int slot = -1;    ///< in the pool, while a pass uses it
    };
    struct Pass {
        std::string name, reason;
        std::vector<int> reads, colors;
        int depth = -1;
        std::optional<vec4> clear;
        Execute execute;
        bool live = false;
    };
    class PassResources;
    static std::vector<int> targetsOf(const Pass& pass);
    static std::vector<int> usesOf(const Pass& pass);
    Status check(const Pass& pass) const;
    void cull();
    TextureHandle handleOf(const Resource& resource, const TexturePool& pool) const;

    std::vector<Resource> resources_;
    std::vector<Pass> passes_;
};

} // namespace lucent::graph
