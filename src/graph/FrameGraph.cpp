#include "graph/FrameGraph.h"

#include <algorithm>
#include <cstdio>

namespace lucent::graph {

// --- pool

std::size_t TexturePool::acquire(const TextureDesc& desc, const std::string& label) {
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        Slot& slot = slots_[i];
        if (!slot.free || slot.texture.desc() != desc) continue;
        slot.free = false;
        slot.used = true;
        return i;
    }
    slots_.push_back({Texture(device_, desc, label), false, true});
    return slots_.size() - 1;
}

void TexturePool::trim() {
    std::erase_if(slots_, [](const Slot& slot) { return slot.free && !slot.used; });
    for (Slot& slot : slots_)
        slot.used = false;
}

std::size_t TexturePool::bytes() const {
    std::size_t sum = 0;
    for (const Slot& slot : slots_)
        sum += slot.texture.desc().bytes();
    return sum;
}

// --- declaring

void PassBuilder::reason(std::string text) { graph_.passes_[pass_].reason = std::move(text); }
void PassBuilder::sample(TextureId id) { graph_.passes_[pass_].reads.push_back(id.index); }
void PassBuilder::clear(vec4 value) { graph_.passes_[pass_].clear = value; }

TextureId PassBuilder::createColor(std::string label, const TextureDesc& desc) {
    const TextureId id = graph_.import(TextureHandle::None, desc, std::move(label));
    write(id);
    return id;
}

TextureId PassBuilder::createDepth(std::string label, ivec2 size) {
    const TextureId id =
        graph_.import(TextureHandle::None, {.size = size, .format = Format::Depth24}, std::move(label));
    write(id);
    return id;
}

void PassBuilder::write(TextureId id) {
    FrameGraph::Resource& resource = graph_.resources_[id.index];
    if (resource.desc.format == Format::Depth24)
        graph_.passes_[pass_].depth = id.index;
    else
        graph_.passes_[pass_].colors.push_back(id.index);
    resource.writer = pass_;
}

TextureId FrameGraph::import(TextureHandle handle, const TextureDesc& desc, std::string label) {
    Resource resource;
    resource.label = std::move(label);
    resource.desc = desc;
    resource.imported = handle;
    resources_.push_back(std::move(resource));
    return {int(resources_.size()) - 1};
}

void FrameGraph::addPass(std::string name, const std::function<Execute(PassBuilder&)>& setup) {
    passes_.emplace_back();
    passes_.back().name = std::move(name);
    PassBuilder builder(*this, int(passes_.size()) - 1);
    Execute execute = setup(builder); // may grow resources_, never passes_
    passes_.back().execute = std::move(execute);
}

void FrameGraph::keep(TextureId id) {
    assert(resources_[id.index].imported != TextureHandle::None &&
           "only what outlives the frame can be kept");
    resources_[id.index].kept = true;
}

// --- compiling

Status FrameGraph::check(const Pass& pass) const {
    for (int read : pass.reads) {
        const Resource& resource = resources_[read];
        if (std::count(pass.colors.begin(), pass.colors.end(), read) || read == pass.depth)
            return Error{"graph: pass \"" + pass.name + "\" samples \"" + resource.label +
                             "\", which it also writes; must be another texture",
                         Fault::Machine};
        if (resource.writer < 0 && resource.imported == TextureHandle::None)
            return Error{"graph: pass \"" + pass.name + "\" samples \"" + resource.label +
                             "\", which no pass writes",
                         Fault::Machine};
    }
    for (int color : pass.colors) {
        if (resources_[color].desc.size == resources_[pass.colors.front()].desc.size) continue;
        return Error{"graph: pass \"" + pass.name + "\" writes \"" + resources_[color].label +
                         "\" beside a target of another size; all must have one size",
                     Fault::Machine};
    }
    return Done{};
}

std::vector<int> FrameGraph::targetsOf(const Pass& pass) {
    std::vector<int> targets = pass.colors;
    if (pass.depth >= 0) targets.push_back(pass.depth);
    return targets;
}

std::vector<int> FrameGraph::usesOf(const Pass& pass) {
    std::vector<int> uses = targetsOf(pass);
    uses.insert(uses.end(), pass.reads.begin(), pass.reads.end());
    return uses;
}

void FrameGraph::cull() {
    std::vector<bool> wanted(resources_.size());
    for (std::size_t i = 0; i < resources_.size(); ++i)
        wanted[i] = resources_[i].kept;
    for (int i = int(passes_.size()) - 1; i >= 0; --i) {
        Pass& pass = passes_[i];
        pass.live = std::any_of(pass.colors.begin(), pass.colors.end(), [&](int c) { return wanted[c]; });
        if (!pass.live) continue;
        for (int read : pass.reads)
            wanted[read] = true;
        for (int used : usesOf(pass))
            resources_[used].lastUse = std::max(resources_[used].lastUse, i);
    }
}

Status FrameGraph::compile() {
    for (const Pass& pass : passes_)
        if (Status status = check(pass); !status) return status;
    cull();
    return Done{};
}

// --- executing

class FrameGraph::PassResources : public Resources {
public:
    PassResources(const FrameGraph& graph, const Pass& pass, const TexturePool& pool)
        : graph_(graph), pass_(pass), pool_(pool) {}
    TextureHandle operator[](TextureId id) const override {
        assert(std::count(pass_.reads.begin(), pass_.reads.end(), id.index) &&
               "pass did not declare this read");
        return graph_.handleOf(graph_.resources_[id.index], pool_);
    }

private:
    const FrameGraph& graph_;
    [[maybe_unused]] const Pass& pass_; // only asserted on
    const TexturePool& pool_;
};

TextureHandle FrameGraph::handleOf(const Resource& resource, const TexturePool& pool) const {
    return resource.imported != TextureHandle::None ? resource.imported : pool.handle(resource.slot);
}

void FrameGraph::execute(TexturePool& pool) {
    for (int i = 0; i < int(passes_.size()); ++i) {
        const Pass& pass = passes_[i];
        if (!pass.live) continue;
        for (int target : targetsOf(pass)) {
            Resource& resource = resources_[target];
            if (resource.imported == TextureHandle::None && resource.slot < 0)
                resource.slot = int(pool.acquire(resource.desc, resource.label));
        }
        PassTarget target{
            .label = pass.name, .colors = {}, .depth = TextureHandle::None, .clear = pass.clear};
        for (int color : pass.colors)
            target.colors.push_back(handleOf(resources_[color], pool));
        if (pass.depth >= 0) target.depth = handleOf(resources_[pass.depth], pool);
        pool.device().runPass(
            target, [&](Commands& commands) { pass.execute(PassResources(*this, pass, pool), commands); });
        for (int used : usesOf(pass)) {
            Resource& resource = resources_[used];
            if (resource.slot < 0 || resource.lastUse > i) continue;
            pool.release(resource.slot);
            resource.slot = -1;
        }
    }
}

// --- telling

int FrameGraph::livePasses() const {
    return int(std::count_if(passes_.begin(), passes_.end(), [](const Pass& pass) { return pass.live; }));
}

std::size_t FrameGraph::transientBytes() const {
    std::size_t sum = 0;
    for (const Resource& resource : resources_)
        if (resource.imported == TextureHandle::None && resource.writer >= 0 && passes_[resource.writer].live)
            sum += resource.desc.bytes();
    return sum;
}

std::string FrameGraph::dump() const {
    std::string text;
    const auto line = [&](const Pass& pass) {
        text += (pass.live ? "  " : "  culled: ") + pass.name + ": " + pass.reason + "\n";
        if (!pass.live) return;
        for (int target : targetsOf(pass)) {
            const Resource& resource = resources_[target];
            char size[96];
            std::snprintf(size, sizeof size, " %dx%d %s, %zu bytes", resource.desc.size.x,
                          resource.desc.size.y, graph::name(resource.desc.format), resource.desc.bytes());
            text += "      -> " + resource.label + size + "\n";
        }
    };
    for (const Pass& pass : passes_)
        if (pass.live) line(pass);
    for (const Pass& pass : passes_)
        if (!pass.live) line(pass);
    return text;
}

} // namespace lucent::graph
