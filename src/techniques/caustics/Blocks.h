#pragma once
/// The uniform blocks of shaders/caustics.

#include "light/ShadowMap.h"
#include "views/Glass.h"

#include <algorithm>
#include <cstddef>

namespace lucent::caustics {

/// Mirrors struct Lamp of shaders/caustics/lamp.glsl.
struct LampBlock {
    vec4 color{0}, axis{0};
    vec2 cone{0}, grid{0};
};

inline std::vector<graph::BlockLayout::Member> viewAndLampMembers(std::size_t view, std::size_t lamp) {
    auto list = views::viewMembers(view);
    list.insert(list.end(), {{"lamp.color", lamp + offsetof(LampBlock, color)},
                             {"lamp.axis", lamp + offsetof(LampBlock, axis)},
                             {"lamp.cone", lamp + offsetof(LampBlock, cone)},
                             {"lamp.grid", lamp + offsetof(LampBlock, grid)}});
    return list;
}

struct PhotonBlock {
    views::ViewBlock view;
    LampBlock lamp;
    views::GlassBlock glass[views::kMostGlass];
    vec4 tint{1};
    int count = 0, channel = 0, border = 0;
    int padding = 0;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = viewAndLampMembers(offsetof(PhotonBlock, view), offsetof(PhotonBlock, lamp));
            const auto glass = views::glassMembers(offsetof(PhotonBlock, glass));
            list.insert(list.end(), glass.begin(), glass.end());
            list.insert(list.end(), {{"tint", offsetof(PhotonBlock, tint)},
                                     {"count", offsetof(PhotonBlock, count)},
                                     {"channel", offsetof(PhotonBlock, channel)},
                                     {"border", offsetof(PhotonBlock, border)}});
            return list;
        }();
        static const graph::BlockLayout layout{"PhotonBlock", sizeof(PhotonBlock), members};
        return layout;
    }
};

struct MirrorBlock {
    static constexpr std::size_t kMost = 32;

    views::ViewBlock view;
    LampBlock lamp;
    vec4 mirrors[kMost] = {};
    int count = 0, border = 0;
    int padding[2] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = viewAndLampMembers(offsetof(MirrorBlock, view), offsetof(MirrorBlock, lamp));
            list.insert(list.end(), {{"mirrors", offsetof(MirrorBlock, mirrors)},
                                     {"count", offsetof(MirrorBlock, count)},
                                     {"border", offsetof(MirrorBlock, border)}});
            return list;
        }();
        static const graph::BlockLayout layout{"MirrorBlock", sizeof(MirrorBlock), members};
        return layout;
    }
};

/// The views of a light as the blocks below hold them.
struct Faces {
    views::ViewBlock list[views::ShadowViews::kMost];

    explicit Faces(const views::ShadowViews& views) {
        for (std::size_t i = 0; i < views.faces.size(); ++i)
            list[i] = views::viewBlock(views.faces[i], ivec2(views.size));
    }
};

struct WaterRaysBlock {
    Faces faces;
    mat4 worldFromObject, normalFromObject;
    LampBlock lamp;
    views::GlassBlock water;
    vec4 place, tint;
    ivec2 cells, grid;
    int faceCount, channel;
    float area;
    int padding = 0;

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {
            {"faces[0].eye", offsetof(WaterRaysBlock, faces)},
            {"worldFromObject", offsetof(WaterRaysBlock, worldFromObject)},
            {"normalFromObject", offsetof(WaterRaysBlock, normalFromObject)},
            {"lamp.color", offsetof(WaterRaysBlock, lamp.color)},
            {"lamp.cone", offsetof(WaterRaysBlock, lamp.cone)},
            {"water.ior", offsetof(WaterRaysBlock, water.ior)},
            {"water.absorption", offsetof(WaterRaysBlock, water.absorption)},
            {"place", offsetof(WaterRaysBlock, place)},
            {"tint", offsetof(WaterRaysBlock, tint)},
            {"cells", offsetof(WaterRaysBlock, cells)},
            {"grid", offsetof(WaterRaysBlock, grid)},
            {"faceCount", offsetof(WaterRaysBlock, faceCount)},
            {"channel", offsetof(WaterRaysBlock, channel)},
            {"area", offsetof(WaterRaysBlock, area)}};
        static const graph::BlockLayout layout{"WaterRaysBlock", sizeof(WaterRaysBlock), members};
        return layout;
    }
};

struct SoakBlock {
    vec4 absorption;

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"absorption", offsetof(SoakBlock, absorption)}};
        static const graph::BlockLayout layout{"SoakBlock", sizeof(SoakBlock), members};
        return layout;
    }
};

struct LandBlock {
    Faces faces;
    vec4 low, high;
    int faceCount, steps;
    int padding[2] = {};

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"faces[0].eye", offsetof(LandBlock, faces)},
                                                             {"low", offsetof(LandBlock, low)},
                                                             {"high", offsetof(LandBlock, high)},
                                                             {"faceCount", offsetof(LandBlock, faceCount)},
                                                             {"steps", offsetof(LandBlock, steps)}};
        static const graph::BlockLayout layout{"LandBlock", sizeof(LandBlock), members};
        return layout;
    }
};

struct RoundBlock {
    Faces faces;
    views::ViewBlock halves[2];
    int faceCount;
    int padding[3] = {};

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {{"faces[0].eye", offsetof(RoundBlock, faces)},
                                                             {"halves[0].eye", offsetof(RoundBlock, halves)},
                                                             {"faceCount", offsetof(RoundBlock, faceCount)}};
        static const graph::BlockLayout layout{"RoundBlock", sizeof(RoundBlock), members};
        return layout;
    }
};

struct DepositBlock {
    Faces faces;
    vec4 frame;
    ivec2 grid;
    int faceCount, face;
    float unit, size;
    int first = 0, padding = 0;

    static const graph::BlockLayout& layout() {
        static const graph::BlockLayout::Member members[] = {
            {"faces[0].eye", offsetof(DepositBlock, faces)}, {"frame", offsetof(DepositBlock, frame)},
            {"grid", offsetof(DepositBlock, grid)},          {"faceCount", offsetof(DepositBlock, faceCount)},
            {"face", offsetof(DepositBlock, face)},          {"unit", offsetof(DepositBlock, unit)},
            {"size", offsetof(DepositBlock, size)},          {"first", offsetof(DepositBlock, first)}};
        static const graph::BlockLayout layout{"DepositBlock", sizeof(DepositBlock), members};
        return layout;
    }
};

struct LinesBlock {
    views::ViewBlock view;
    vec4 low, high;
    ivec2 grid;
    float unit, padding = 0;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(LinesBlock, view));
            list.insert(list.end(), {{"low", offsetof(LinesBlock, low)},
                                     {"high", offsetof(LinesBlock, high)},
                                     {"grid", offsetof(LinesBlock, grid)},
                                     {"unit", offsetof(LinesBlock, unit)}});
            return list;
        }();
        static const graph::BlockLayout layout{"LinesBlock", sizeof(LinesBlock), members};
        return layout;
    }
};

struct GatherBlock {
    views::ViewBlock view;
    float unit;
    float padding[3] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(GatherBlock, view));
            list.push_back({"unit", offsetof(GatherBlock, unit)});
            return list;
        }();
        static const graph::BlockLayout layout{"GatherBlock", sizeof(GatherBlock), members};
        return layout;
    }
};

struct LookupBlock {
    views::ViewBlock view;
    Faces faces;
    int faceCount;
    float unit;
    int padding[2] = {};

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::viewMembers(offsetof(LookupBlock, view));
            list.insert(list.end(), {{"faces[0].eye", offsetof(LookupBlock, faces)},
                                     {"faceCount", offsetof(LookupBlock, faceCount)},
                                     {"unit", offsetof(LookupBlock, unit)}});
            return list;
        }();
        static const graph::BlockLayout layout{"LookupBlock", sizeof(LookupBlock), members};
        return layout;
    }
};

} // namespace lucent::caustics
