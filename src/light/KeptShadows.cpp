#include "light/KeptShadows.h"

#include <algorithm>

namespace lucent::views {

std::size_t KeptShadows::bytesOf(const ShadowViews& views) {
    return graph::TextureDesc{.size = views.imageSize(), .format = kShadowFormat}.bytes();
}

template <class Is>
void KeptShadows::forget(const Is& is) {
    std::erase_if(kept_, [&](One& one) {
        if (!is(one)) return false;
        bytes_ -= bytesOf(one.views);
        if (*one.depths) pool_.give(std::move(*one.depths));
        return true;
    });
}

void KeptShadows::stand(const scene::Scene& scene, const Waters& waters) {
    std::vector<Standing> standing;
    for (const scene::Object& object : scene.objects) {
        const bool isSheet = waters.of(int(standing.size())) != nullptr;
        standing.push_back({objectKey(object, scene.view.time), isSheet ? waters.changes() : 0});
        standing.back().key.visible = true; // what is hidden casts its shadow still
    }
    const auto isAsBefore = [&](int object) {
        const auto i = std::size_t(object);
        return i < std::min(standing.size(), standing_.size()) && standing[i] == standing_[i];
    };
    forget([&](const One& one) { return !std::all_of(one.casters.begin(), one.casters.end(), isAsBefore); });
    standing_ = std::move(standing);
}

graph::TextureId KeptShadows::find(graph::FrameGraph& graph, const ShadowViews& views,
                                   const std::vector<int>& casters) {
    for (One& one : kept_) {
        if (!*one.depths || one.views != views || one.casters != casters) continue;
        one.used = true;
        return graph.import(one.depths->handle(), one.depths->desc(), one.depths->label());
    }
    return {};
}

void KeptShadows::keep(graph::FrameGraph& graph, const ShadowViews& views, std::vector<int> casters,
                       graph::TextureId depths) {
    // What a graph that was given up should have made.
    forget([](const One& one) { return !*one.depths && one.depths.use_count() == 1; });
    if (bytes_ + bytesOf(views) > kMostBytes) return;
    bytes_ += bytesOf(views);
    kept_.push_back({views, std::move(casters), std::make_shared<graph::Texture>()});
    graph.handOver(depths, kept_.back().depths);
}

void KeptShadows::trim() {
    forget([](const One& one) { return !one.used; });
    for (One& one : kept_)
        one.used = false;
}

void KeptShadows::clear() {
    forget([](const One&) { return true; });
}

} // namespace lucent::views
