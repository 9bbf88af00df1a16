#pragma once
/// Shadow views that stay: further samples of the pixels, other directions from the same place and further
/// previews of a drag read them again.

#include "graph/FrameGraph.h"
#include "light/ShadowMap.h"
#include "views/ObjectKey.h"
#include "views/Water.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace lucent::views {

class KeptShadows {
public:
    /// So many are kept; others are drawn each time.
    static constexpr std::size_t kMostBytes = std::size_t(96) << 20;

    explicit KeptShadows(graph::TexturePool& pool) : pool_(pool) {}

    /// Forgets the shadows of objects that are not as they were.
    void stand(const scene::Scene& scene, const Waters& waters);
    /// The depths that these objects of the scene have in these views; none where they are not there.
    graph::TextureId find(graph::FrameGraph& graph, const ShadowViews& views,
                          const std::vector<int>& casters);
    /// Keeps them when the graph has run.
    void keep(graph::FrameGraph& graph, const ShadowViews& views, std::vector<int> casters,
              graph::TextureId depths);
    /// Gives back what was not asked for since the last trim().
    void trim();
    void clear();
    std::size_t bytes() const { return bytes_; }

private:
    struct Standing {
        ObjectKey key;
        std::uint64_t water; // Waters::changes(), of sheets: another sheet may have had as many of its own
        bool operator==(const Standing&) const = default;
    };
    struct One {
        ShadowViews views;
        std::vector<int> casters;
        std::shared_ptr<graph::Texture> depths;
        bool used = true;
    };
    static std::size_t bytesOf(const ShadowViews& views);
    template <class Is>
    void forget(const Is& is);

    graph::TexturePool& pool_;
    std::vector<Standing> standing_; // by the object's number in the scene
    std::vector<One> kept_;
    std::size_t bytes_ = 0;
};

} // namespace lucent::views
