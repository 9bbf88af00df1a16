#include "graph/FrameGraph.h"

#include <algorithm>

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

Texture TexturePool::take(std::size_t slot) {
    slots_[slot].free = true; // empty: like no texture that is asked for
    slots_[slot].used = false;
    return std::exchange(slots_[slot].texture, Texture());
}

void TexturePool::trim() {
    std::erase_if(slots_, [](const Slot& slot) { return slot.free && !slot.used; });
    for (Slot& slot : slots_)
        slot.used = false;
}

std::size_t TexturePool::bytes() const {
    std::size_t sum = 0;
    for (const Slot& slot : slots_)
        if (slot.texture) sum += slot.texture.desc().bytes();
    return sum;
}

// --- declaring

void PassBuilder::reason(std::string text) { graph_.passes_[pass_].reason = std::move(text); }
void PassBuilder::sample(TextureId id) { graph_.passes_[pass_].reads.push_back(id.index); }
void PassBuilder::query(Query& query) { graph_.passes_[pass_].query = &query; }

TextureId PassBuilder::createColor(std::string label, const TextureDesc& desc) {
    const TextureId id = graph_.create(std::move(label), desc);
    write(id);
    return id;
}

TextureId PassBuilder::createDepth(std::string label, ivec2 size, Format format) {
    return createColor(std::move(label), {.size = size, .format = format});
}

void PassBuilder::write(TextureId id, int layer, int level) {
    graph_.passes_[pass_].targets.push_back({id.index, layer, level, std::nullopt});
    int& writer = graph_.resources_[id.index].writer;
    if (writer < 0) writer = pass_;
}

void PassBuilder::clear(TextureId id, const Clear& value) {
    [[maybe_unused]] bool found = false;
    for (FrameGraph::Target& target : graph_.passes_[pass_].targets) {
        if (target.texture != id.index) continue;
        target.clear = value;
        found = true;
    }
    assert(found && "declare the target before its clear value");
}

TextureId FrameGraph::import(TextureHandle handle, const TextureDesc& desc, std::string label) {
    Resource resource;
    resource.label = std::move(label);
    resource.desc = desc;
    resource.imported = handle;
    resources_.push_back(std::move(resource));
    return {int(resources_.size()) - 1};
}

TextureId FrameGraph::create(std::string label, const TextureDesc& desc) {
    return import(TextureHandle::None, desc, std::move(label));
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

void FrameGraph::handOver(TextureId id, std::shared_ptr<Texture> heir) {
    assert(resources_[id.index].imported == TextureHandle::None && "what outlives the frame has an owner");
    resources_[id.index].kept = true;
    resources_[id.index].heir = std::move(heir);
}

// --- compiling

namespace {
const char* clearName(const Clear& value) {
    constexpr const char* kNames[] = {"a vec4", "a uvec4", "a float"};
    return kNames[value.index()];
}

// Of the alternatives of Clear, the one that fills a format.
Clear neededClear(Format format) {
    if (kindOf(format) == Kind::Depth) return 0.0f;
    if (kindOf(format) == Kind::Integer) return uvec4(0);
    return vec4(0);
}

std::string quoted(const std::string& label) { return "\"" + label + "\""; }
} // namespace

bool FrameGraph::isDepth(const Target& target) const {
    return kindOf(resources_[target.texture].desc.format) == Kind::Depth;
}

Status FrameGraph::checkReads(int index) const {
    const Pass& pass = passes_[index];
    const std::string samples = "graph: pass " + quoted(pass.name) + " samples ";
    for (int read : pass.reads) {
        const Resource& resource = resources_[read];
        if (std::any_of(pass.targets.begin(), pass.targets.end(),
                        [read](const Target& target) { return target.texture == read; }))
            return Error{samples + quoted(resource.label) + ", which it also writes; must be another texture",
                         Fault::Machine};
        if (resource.imported != TextureHandle::None) continue;
        if (resource.writer < 0)
            return Error{samples + quoted(resource.label) + ", which no pass writes", Fault::Machine};
        if (resource.writer > index)
            return Error{samples + quoted(resource.label) + ", which no pass writes before it",
                         Fault::Machine};
    }
    return Done{};
}

Status FrameGraph::checkTarget(const Pass& pass, std::size_t index) const {
    const Target& target = pass.targets[index];
    const Resource& resource = resources_[target.texture];
    const TextureDesc& desc = resource.desc;
    const auto error = [&](const std::string& what) {
        return Error{"graph: pass " + quoted(pass.name) + " " + what, Fault::Machine};
    };
    if (target.layer < 0 || target.layer >= desc.layers)
        return error("writes layer " + std::to_string(target.layer) + " of " + quoted(resource.label) +
                     "; must be 0 to " + std::to_string(desc.layers - 1));
    if (target.level < 0 || target.level >= desc.levels)
        return error("writes level " + std::to_string(target.level) + " of " + quoted(resource.label) +
                     "; must be 0 to " + std::to_string(desc.levels - 1));
    if (target.clear && target.clear->index() != neededClear(desc.format).index())
        return error("clears " + quoted(resource.label) + " (" + graph::name(desc.format) + ") with " +
                     clearName(*target.clear) + "; must be " + clearName(neededClear(desc.format)));
    for (std::size_t i = 0; i < index; ++i) {
        const Target& other = pass.targets[i];
        if (other.texture == target.texture && other.layer == target.layer && other.level == target.level)
            return error("writes " + quoted(resource.label) + " twice; must be once");
        if (isDepth(other) && isDepth(target))
            return error("writes " + quoted(resource.label) + " beside another depth; must be one");
        if (resources_[other.texture].desc.sizeOf(other.level) != desc.sizeOf(target.level))
            return error("writes " + quoted(resource.label) +
                         " beside a target of another size; all must have one size");
    }
    return Done{};
}

Status FrameGraph::check(int index) const {
    const Pass& pass = passes_[index];
    if (Status status = checkReads(index); !status) return status;
    if (pass.targets.empty())
        return Error{"graph: pass " + quoted(pass.name) + " writes nothing; must have a target",
                     Fault::Machine};
    for (std::size_t target = 0; target < pass.targets.size(); ++target)
        if (Status status = checkTarget(pass, target); !status) return status;
    return Done{};
}

std::vector<int> FrameGraph::usesOf(const Pass& pass) {
    std::vector<int> uses = pass.reads;
    for (const Target& target : pass.targets)
        uses.push_back(target.texture);
    return uses;
}

// A texture that is read keeps every pass before that draws into it: they may have drawn other layers, or
// only a part.
void FrameGraph::cull() {
    std::vector<bool> wanted(resources_.size());
    for (std::size_t i = 0; i < resources_.size(); ++i)
        wanted[i] = resources_[i].kept;
    for (int i = int(passes_.size()) - 1; i >= 0; --i) {
        Pass& pass = passes_[i];
        pass.live = pass.query || std::any_of(pass.targets.begin(), pass.targets.end(),
                                              [&](const Target& t) { return wanted[t.texture]; });
        if (!pass.live) continue;
        for (int read : pass.reads)
            wanted[read] = true;
        for (const Target& target : pass.targets) // a depth that stays is tested against
            if (isDepth(target) && !target.clear) wanted[target.texture] = true;
        for (int used : usesOf(pass))
            resources_[used].lastUse = std::max(resources_[used].lastUse, i);
    }
}

Status FrameGraph::compile() {
    for (int i = 0; i < int(passes_.size()); ++i)
        if (Status status = check(i); !status) return status;
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

PassTarget FrameGraph::targetOf(const Pass& pass, const TexturePool& pool) const {
    PassTarget target;
    target.label = pass.name;
    target.query = pass.query;
    for (const Target& one : pass.targets) {
        const Attachment attachment{handleOf(resources_[one.texture], pool), one.layer, one.level, one.clear};
        if (isDepth(one))
            target.depth = attachment;
        else
            target.colors.push_back(attachment);
    }
    return target;
}

void FrameGraph::acquire(const Pass& pass, TexturePool& pool) {
    for (const Target& target : pass.targets) {
        Resource& resource = resources_[target.texture];
        if (resource.imported == TextureHandle::None && resource.slot < 0)
            resource.slot = int(pool.acquire(resource.desc, resource.label));
    }
}

void FrameGraph::release(int pass, TexturePool& pool) {
    for (int used : usesOf(passes_[pass])) {
        Resource& resource = resources_[used];
        if (resource.slot < 0 || resource.lastUse > pass) continue;
        if (resource.heir)
            *resource.heir = pool.take(std::size_t(resource.slot));
        else
            pool.release(resource.slot);
        resource.slot = -1;
    }
}

void FrameGraph::execute(TexturePool& pool) {
    for (int i = 0; i < int(passes_.size()); ++i) {
        const Pass& pass = passes_[i];
        if (!pass.live) continue;
        acquire(pass, pool);
        pool.device().runPass(targetOf(pass, pool), [&](Commands& commands) {
            pass.execute(PassResources(*this, pass, pool), commands);
        });
        release(i, pool);
    }
}

namespace {
// Keeps draws in place of drawing.
struct Recorder : Commands {
    std::vector<Draw> draws;
    void draw(const Draw& draw) override { draws.push_back(draw); }
};

// Its pixels do not know of each other, and its triangle costs nothing.
bool fillsTarget(const Draw& draw) {
    return draw.vertices == 3 && draw.instances == 1 && draw.indices == IndicesHandle::None &&
           draw.topology == Topology::Triangles && draw.region.z == 0;
}
} // namespace

std::optional<FrameGraph::Portion> FrameGraph::step(TexturePool& pool,
                                                    const std::function<int(const std::string&)>& most) {
    while (next_ < passes_.size() && !passes_[next_].live)
        ++next_;
    if (next_ == passes_.size()) return std::nullopt;
    Pass& pass = passes_[next_];
    const bool begins = !draws_;
    if (begins) {
        acquire(pass, pool);
        Recorder recorder;
        pass.execute(PassResources(*this, pass, pool), recorder);
        draws_ = std::move(recorder.draws);
        pass.draws = std::max<std::size_t>(1, draws_->size());
        row_ = 0;
    }
    PassTarget target = targetOf(pass, pool);
    if (!begins) {
        target.depth.clear.reset();
        for (Attachment& color : target.colors)
            color.clear.reset();
    }
    const Target& first = pass.targets.front();
    const ivec2 size = resources_[first.texture].desc.sizeOf(first.level);
    std::size_t drawn = pass.query ? draws_->size() : std::min<std::size_t>(1, draws_->size());
    int rows = size.y;
    if (drawn == 1 && !pass.query && fillsTarget(draws_->front())) {
        rows = std::clamp(most(pass.name) / size.x, 1, size.y - row_);
        if (rows < size.y) draws_->front().rows = {row_, row_ + rows};
    }
    pool.device().runPass(target, [&](Commands& commands) {
        for (std::size_t i = 0; i < drawn; ++i)
            commands.draw((*draws_)[i]);
    });
    row_ += rows;
    if (row_ < size.y)
        drawn = 0;
    else
        row_ = 0;
    draws_->erase(draws_->begin(), draws_->begin() + std::ptrdiff_t(drawn));
    if (draws_->empty()) {
        draws_.reset();
        release(int(next_++), pool);
    }
    return Portion{pass.name, rows * size.x};
}

float FrameGraph::share(const std::function<double(const std::string&)>& cost) const {
    double done = 0, all = 0;
    for (std::size_t i = 0; i < passes_.size(); ++i) {
        const Pass& pass = passes_[i];
        if (!pass.live) continue;
        const Target& target = pass.targets.front();
        const ivec2 size = resources_[std::size_t(target.texture)].desc.sizeOf(target.level);
        const double ofDraw = cost(pass.name) * size.x * size.y, draws = double(pass.draws);
        all += draws * ofDraw;
        if (i < next_)
            done += draws * ofDraw;
        else if (i == next_ && draws_)
            done += (draws - double(draws_->size()) + double(row_) / size.y) * ofDraw;
    }
    return next_ < passes_.size() && all > 0 ? float(done / all) : 1;
}

void FrameGraph::abandon(TexturePool& pool) {
    for (Resource& resource : resources_) {
        if (resource.slot >= 0) pool.release(std::size_t(resource.slot));
        resource.slot = -1;
    }
    draws_.reset();
    next_ = passes_.size();
}

// --- telling

int FrameGraph::livePasses() const {
    return int(std::count_if(passes_.begin(), passes_.end(), [](const Pass& pass) { return pass.live; }));
}

std::size_t FrameGraph::transientBytes() const {
    std::size_t sum = 0;
    for (const Resource& resource : resources_)
        if (resource.imported == TextureHandle::None && resource.lastUse >= 0) sum += resource.desc.bytes();
    return sum;
}

std::string FrameGraph::dump() const {
    std::string text;
    const auto line = [&](const Pass& pass) {
        text += (pass.live ? "  " : "  culled: ") + pass.name + ": " + pass.reason + "\n";
        if (!pass.live) return;
        for (const Target& target : pass.targets) {
            const TextureDesc& desc = resources_[target.texture].desc;
            text += "      -> " + resources_[target.texture].label + " " + desc.text() + ", ";
            if (desc.layers > 1) text += "layer " + std::to_string(target.layer) + ", ";
            if (desc.levels > 1) text += "level " + std::to_string(target.level) + ", ";
            text += std::to_string(desc.bytes()) + " bytes\n";
        }
    };
    for (const Pass& pass : passes_)
        if (pass.live) line(pass);
    for (const Pass& pass : passes_)
        if (!pass.live) line(pass);
    return text;
}

} // namespace lucent::graph
