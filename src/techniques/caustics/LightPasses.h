#pragma once
/// The passes of one point of a light: its rays through glass and off mirrors, where they land, what they
/// leave there, and what pixels see of that.

#include "shaders/caustics/Blocks.h"
#include "techniques/caustics/Caustics.h"
#include "techniques/caustics/Spectrum.h"

#include <functional>
#include <string>

namespace lucent::caustics {

inline views::Drawables mirrorsOf(views::Drawables solids) {
    return filtered(std::move(solids), &views::Drawable::isMirror);
}
inline views::Drawables receiversOf(views::Drawables solids) {
    return filtered(std::move(solids), std::not_fn(&views::Drawable::isMirror));
}
/// Those of them that layers can show.
inline views::Drawables tracedMirrorsOf(views::Drawables solids) {
    return filtered(mirrorsOf(std::move(solids)),
                    [](const views::Drawable& one) { return one.mesh() != nullptr; });
}
/// Without blended meshes that stand between a lamp and all that bends its light: its view would show them
/// in the stead of what the light falls on.
///
/// @param bending  box around that
views::Drawables withoutBlendedBefore(const views::LampPoint& lamp, const views::Bounds& bending,
                                      views::Drawables receivers);

/// Standard deviation of the directions that a light sample stands for [radians], or of a point's place [m].
inline float spreadOf(const views::LampPoint& lamp) {
    return lamp.isEnvironment ? lamp.spread : 0.5f * lamp.part; // of a disc
}

/// Whether all that refracts is water that a lamp looks down on, so that rays may begin on it.
bool beginsOnWater(const Settings& settings, const views::LampPoint& lamp, const views::Drawables& glass,
                   const views::Drawables& solids);

/// Where textures of the passes come from: the graph, or from outside where somebody reads them afterwards.
class Targets {
public:
    explicit Targets(graph::FrameGraph& graph, graph::Device* device = nullptr)
        : graph_(graph), device_(device) {}
    graph::TextureId make(const char* label, const graph::TextureDesc& desc) {
        if (!device_) return graph_.create(label, desc);
        kept_.emplace_back(*device_, desc, label);
        const graph::TextureId id = graph_.import(kept_.back().handle(), desc, label);
        graph_.keep(id);
        return id;
    }
    bool keeps() const { return device_ != nullptr; }
    const std::vector<graph::Texture>& kept() const { return kept_; }

private:
    graph::FrameGraph& graph_;
    graph::Device* device_;
    std::vector<graph::Texture> kept_;
};

class LightPasses {
public:
    LightPasses(graph::FrameGraph& graph, gl::Context& context, Targets& targets, const Inputs& in,
                const Plan::Light& light, const views::PictureOf& pictureOf)
        : graph_(graph), context_(context), targets_(targets), in_(in), light_(light),
          settings_(light.settings), pictureOf_(pictureOf),
          receivers_(withoutBlendedBefore(light.lamp, bendingIn(in), receiversOf(in.solids))),
          blended_(filtered(in.solids, &views::Drawable::isBlended)),
          solids_(filtered(in.solids, std::not_fn(&views::Drawable::isBlended))) {}

    /// @param sum  of what other points left on the pixels; becomes the sum with this one
    Status record(graph::TextureId& sum);
    /// Flux on a texel of the map that the light meets undisturbed: a number that 16-bit floats hold well.
    float unit() const;
    Map map() const { return {map_, mapDepths_, mapViews().imageSize(), mapBehind_}; }
    /// Looks up what record() left in a map.
    Status lookUp(const Map& from, graph::TextureId& sum);

private:
    struct Photons {
        ivec2 count{0}; // of rays
        graph::TextureId place{}, direction{}, flux{}, landing{};
        graph::TextureId sent{}; // flux before water or mirrors absorbed of it; none where they cannot
    };
    // Which triangles between the rays of a grid are beams, and in which cells rays of their own begin for
    // the rest (shaders/caustics/lone_cells.glsl).
    struct Cells {
        graph::TextureId beams{}, index{};
    };
    // The rays of one view: those of a grid, the triangles between them that carry light, and rays of their
    // own for the rest. Splats and lines are drawn of the grid's alone.
    struct Sheet {
        views::Eye eye;   // of the light
        float within = 0; // m of the way through what bends it
        Photons grid{}, rest{};
        Cells cells{};
        graph::TextureId density{}, points{};
        graph::TextureId sides{}, shares{}; // of the rest: shaders/caustics/spread.frag
    };
    using Samples = std::vector<std::pair<const char*, graph::TextureId>>;
    // What is drawn of the rays of a sheet: the first ray, and how many vertices.
    struct Range {
        int first = 0, vertices = 0;
    };
    static Range allOf(const Sheet& sheet);
    struct Kind {
        graph::Topology topology = graph::Topology::Points;
        std::function<Range(const Sheet&)> range;
        std::function<Samples(const Sheet&)> samples;
        bool rest = false; // of what no beam carries
        const gl::Program* program = nullptr;
    };
    // Which rays a pass begins (shaders/caustics/photon.glsl).
    enum class Part { Cells, Vertices, Rests, Pixels };
    static bool isRest(Part part) { return part == Part::Rests || part == Part::Pixels; }
    struct Start {
        Part part = Part::Cells;
        Cells cells{};
        std::vector<graph::TextureId> targets{};
        bool book = false; // else the rays themselves
        std::vector<std::string> defines() const;
        bool isRest() const { return LightPasses::isRest(part); }
        Samples samples() const;
    };
    using Trace = std::function<Status(const Start&)>;
    // What a light's view of refractive objects shows; none where nothing opaque or blended stands there.
    struct GlassSeen {
        views::Layers layers;
        graph::TextureId solid, opticalDepth;
    };
    // All surfaces of mirrors that rays may meet again, seen from the light.
    struct MirrorLayers {
        const Plan::View* view = nullptr; // none: rays are not looked after
        GlassSeen seen{};
    };

    const gl::Program* program(const char* stem, std::vector<std::string> defines = {}) {
        return context_.program(stem, defines);
    }
    ivec2 viewSize() const { return ivec2(light_.viewSize); }
    LampBlock lampBlock() const;
    /// @param picture    that the lamp projects, or None
    /// @param otherwise  any texture of two dimensions
    static graph::Binding pictureBinding(graph::TextureHandle picture, graph::TextureHandle otherwise) {
        return {"uPicture", picture == graph::TextureHandle::None ? otherwise : picture};
    }

    PhotonBlock photonBlock(const Plan::View& view, const Tint& tint) const;
    struct MirrorsSeen {
        graph::TextureId surface, opticalDepth;
    };
    static views::Bounds bendingIn(const Inputs& in) {
        views::Bounds box = boundsOfAll(in.glass);
        box.add(boundsOfAll(mirrorsOf(in.solids)));
        return box;
    }
    Result<GlassSeen> glassFrom(const Plan::View& view, const views::Drawables& glass,
                                const views::Drawables& solids);
    Result<MirrorsSeen> mirrorsFrom(const views::Eye& eye);
    Result<graph::TextureId> opticalDepth(const views::Eye& eye, graph::TextureId first,
                                          const std::vector<std::string>& defines);
    Status trace(const Plan::View& view, const Tint& tint, const GlassSeen& seen, const Start& start);
    MirrorBlock mirrorBlock(const Plan::View& view) const;
    Status reflect(const Plan::View& view, const MirrorsSeen& seen, const Start& start);
    Result<MirrorLayers> layersOf(const Plan::View& view);
    Status bounce(Photons& photons);
    Status keepAbsorbed(const Photons& photons, graph::TextureId incident);

    Status carry(const views::Eye& eye, float within, const Trace& trace);
    Result<Photons> send(Part part, const Cells& cells, const Trace& trace);
    Status keepBook(Part part, const Cells& cells, const Photons& photons, const Trace& trace);
    static graph::Draw drawOf(Part part);
    Status land(Photons& photons, Part part, const Cells& cells);
    Status recordBack();
    Status recordRound();
    Result<graph::TextureId> beamsOf(const Photons& photons, float cell);
    Result<graph::TextureId> recordCells(const char* stem, const char* reason, const graph::TextureDesc& desc,
                                         const Samples& samples);
    Status pack(Sheet& sheet);
    Status weigh(Sheet& sheet);
    Status weighOnce(Sheet& sheet, bool sharpen);

    WaterRaysBlock waterBlock(const Tint& tint, ivec2 rays) const;
    Status beginOnWater(const Tint& tint, ivec2 rays, graph::TextureId shadow,
                        const std::vector<graph::TextureId>& targets, bool book);
    bool absorbs() const;
    Status absorb(Photons& photons);
    Status leaveAlone(Sheet& sheet);
    Status carryFromWater(const Tint& tint);

    float splatSize(const views::Eye& glass) const;
    DepositBlock depositBlock(const Photons& photons, float size) const;
    Status spread(Sheet& sheet);
    const views::ShadowViews& mapViews() const {
        return light_.halves.faces.empty() ? light_.receivers : light_.halves;
    }
    ivec2 mapSize() const { return mapViews().imageSize() * ivec2(1, light_.hasBehind ? 2 : 1); }
    // Of a program that knows where the map's texels lie.
    const gl::Program* programOnMap(const char* stem, std::vector<std::string> defines = {}) {
        if (!light_.halves.faces.empty()) defines.push_back("PARABOLOIDS");
        if (mapViews().faces.size() == 1) defines.push_back("ONE_VIEW");
        return program(stem, std::move(defines));
    }
    Status addKind(const char* stem, std::vector<std::string> defines, Kind kind, std::vector<Kind>& kinds);
    Status addBeams(std::vector<Kind>& kinds);
    Status addSplats(std::vector<Kind>& kinds);
    Status deposit();
    bool isSpread() const { return spreadOf(light_.lamp) > 0; }
    void blur(graph::TextureId target, ivec2 along);

    // Lines are drawn in the camera's picture; where that is not asked for, their rays are splats.
    // The points of a lamp with a size blur each other's edges.
    bool refines() const { return settings_.refine && !light_.lamp.isPart && !light_.water; }
    bool isInPicture() const { return settings_.deposit == Deposit::Lines && in_.surface; }
    Status drawLines(graph::TextureId& sum);
    Status gather(graph::TextureId flux, graph::TextureId& sum);

    views::Bounds boxOfReceivers() const;
    // In which light adds up.
    graph::Format sumFormat() const {
        return context_.caps().floatBlend ? graph::Format::RGBA32F : graph::Format::RGBA16F;
    }

    graph::FrameGraph& graph_;
    gl::Context& context_;
    Targets& targets_;
    const Inputs& in_;
    const Plan::Light& light_;
    const Settings& settings_;
    const views::PictureOf& pictureOf_;
    graph::TextureHandle picture_ = graph::TextureHandle::None; // that the lamp projects
    views::Drawables receivers_;
    views::Drawables blended_, solids_; // what weakens light on its way, and what ends it
    MirrorLayers mirrors_{};            // of the rays that are sent
    std::vector<Sheet> sheets_;
    graph::TextureId depths_, map_;
    graph::TextureId behind_, back_;         // none where no receiver lies behind another
    graph::TextureId mapDepths_, mapBehind_; // `depths_` and `behind_` as the map's texels lie
};

} // namespace lucent::caustics
