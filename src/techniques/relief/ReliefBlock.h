#pragma once
/// The uniform block of the relief shaders (shaders/relief/model.glsl).

#include "techniques/relief/Relief.h"

#include <cstddef>

namespace lucent::relief {

struct ReliefBlock {
    views::FieldBlock field;
    vec4 eye, base, diffuse, specular, falloffs;
    mat4 objectFromWorld, worldFromObject;
    float metres, radius;
    int object, firstLight, endLight, isFirst, exponential, steps, placed, padding[3];
    ivec4 tile;
    vec2 grid;
    ivec2 viewSize;
    int columns;
    float share, factor;
    int padding2;

    static const graph::BlockLayout& layout() {
        static const auto members = [] {
            auto list = views::fieldMembers(offsetof(ReliefBlock, field));
            list.insert(list.end(), {{"eye", offsetof(ReliefBlock, eye)},
                                     {"base", offsetof(ReliefBlock, base)},
                                     {"diffuse", offsetof(ReliefBlock, diffuse)},
                                     {"specular", offsetof(ReliefBlock, specular)},
                                     {"falloffs", offsetof(ReliefBlock, falloffs)},
                                     {"objectFromWorld", offsetof(ReliefBlock, objectFromWorld)},
                                     {"worldFromObject", offsetof(ReliefBlock, worldFromObject)},
                                     {"metres", offsetof(ReliefBlock, metres)},
                                     {"radius", offsetof(ReliefBlock, radius)},
                                     {"object", offsetof(ReliefBlock, object)},
                                     {"firstLight", offsetof(ReliefBlock, firstLight)},
                                     {"endLight", offsetof(ReliefBlock, endLight)},
                                     {"isFirst", offsetof(ReliefBlock, isFirst)},
                                     {"exponential", offsetof(ReliefBlock, exponential)},
                                     {"steps", offsetof(ReliefBlock, steps)},
                                     {"placed", offsetof(ReliefBlock, placed)},
                                     {"tile", offsetof(ReliefBlock, tile)},
                                     {"grid", offsetof(ReliefBlock, grid)},
                                     {"viewSize", offsetof(ReliefBlock, viewSize)},
                                     {"columns", offsetof(ReliefBlock, columns)},
                                     {"share", offsetof(ReliefBlock, share)},
                                     {"factor", offsetof(ReliefBlock, factor)}});
            return list;
        }();
        static const graph::BlockLayout layout{"ReliefBlock", sizeof(ReliefBlock), members};
        return layout;
    }
};

/// The block for one object with everything that is the object's own. World space is the object's own unless
/// the caller says otherwise.
ReliefBlock makeBlock(const views::DrawnObject& drawn, const Settings& settings);

} // namespace lucent::relief
