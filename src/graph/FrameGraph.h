#pragma once
/// Passes declare what they read and write; what nobody reads is not drawn, and textures that are not needed
/// at the same time share memory. No GL here.

#include "base/Result.h"
#include "graph/Device.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
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
    /// Gives a texture away, or takes one that nobody else needs any more.
    Texture take(std::size_t slot);
    void give(Texture texture) { slots_.push_back({std::move(texture), true, true}); }
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
    TextureId createDepth(std::string label, ivec2 size, Format format = Format::Depth24);
    /// The pass draws into one layer and mip level of a texture: one that outlives the frame, the screen, or
    /// one that FrameGraph::create() or an earlier pass made. Colours are the shader's outputs in this order.
    void write(TextureId id, int layer = 0, int level = 0);
    /// What the pass draws into of this texture is filled first: depths with a float, integers with a uvec4,
    /// other colours with a vec4.
    void clear(TextureId id, const Clear& value);
    /// Asks whether the pass draws anything. Somebody outside waits for the answer: the pass runs even when
    /// nobody reads what it writes. The query outlives the graph.
    void query(Query& query);

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
    /// A new texture of this frame, whose layers and levels several passes write().
    TextureId create(std::string label, const TextureDesc& desc);
    const TextureDesc& descOf(TextureId id) const { return resources_[std::size_t(id.index)].desc; }
    /// Adds a pass; `setup` declares and returns what draws. The lambda it returns captures by value.
    void addPass(std::string name, const std::function<Execute(PassBuilder&)>& setup);
    /// Somebody outside reads this imported texture after the frame.
    void keep(TextureId id);
    /// A texture of this frame stays: `heir` owns it when the last pass that uses it has run, and is empty
    /// until then.
    void handOver(TextureId id, std::shared_ptr<Texture> heir);

    /// Checks the declarations and culls what nobody reads.
    ///
    /// @return Error naming pass and texture: a texture that is sampled but not written before, or sampled by
    ///         the pass that writes it (another layer or level too: WebGL2 forbids it); targets that do not
    ///         exist, stand twice or differ in size; a clear value of another kind than its target
    Status compile();
    /// Runs the passes that are left, in the order they were added. After compile().
    void execute(TexturePool& pool);

    /// What step() has run.
    struct Portion {
        const std::string& pass;
        int pixels; ///< rows of the target times its width
    };
    /// execute() by portions: a draw, or some rows of one that fills its target; a pass with a question
    /// whole.
    ///
    /// @param most  pixels that may be drawn at once, by the name of their pass
    /// @return      nothing when all passes have run
    std::optional<Portion> step(TexturePool& pool, const std::function<int(const std::string&)>& most);
    /// How much of what the passes take step() has run, [0,1]: of the one that has begun by draws and rows.
    ///
    /// @param cost  of a pixel, by the name of its pass, in any unit
    float share(const std::function<double(const std::string&)>& cost) const;
    /// Gives back the textures of passes that have not run to their end.
    void abandon(TexturePool& pool);

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
        std::shared_ptr<Texture> heir{};
        int writer = -1;  ///< first pass that draws into it
        int lastUse = -1; ///< last live pass that reads or writes it
        int slot = -1;    ///< in the pool, while a pass uses it
    };
    struct Target {
        int texture, layer, level;
        std::optional<Clear> clear;
    };
    struct Pass {
        std::string name, reason;
        std::vector<int> reads;
        std::vector<Target> targets; ///< colours in the order of the shader's outputs; depth among them
        Query* query = nullptr;
        Execute execute;
        bool live = false;
        std::size_t draws = 1; ///< known once it begins
    };
    class PassResources;
    bool isDepth(const Target& target) const;
    static std::vector<int> usesOf(const Pass& pass);
    Status check(int index) const;
    Status checkReads(int index) const;
    Status checkTarget(const Pass& pass, std::size_t index) const;
    void cull();
    PassTarget targetOf(const Pass& pass, const TexturePool& pool) const;
    TextureHandle handleOf(const Resource& resource, const TexturePool& pool) const;
    void acquire(const Pass& pass, TexturePool& pool);
    void release(int pass, TexturePool& pool);

    std::vector<Resource> resources_;
    std::vector<Pass> passes_;

    // of step()
    std::size_t next_ = 0;                   ///< pass
    std::optional<std::vector<Draw>> draws_; ///< of a pass that has begun, those that are left
    int row_ = 0;                            ///< of the first of them
};

} // namespace lucent::graph
