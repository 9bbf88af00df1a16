#pragma once
/// How far the surfaces of refractive objects lie behind each other, without normals and objects: by slices
/// whose bits are added up in two passes over the triangles (multiple-refractions thesis 2008, 3.3 to 3.7),
/// or of peeled layers. It is what the thesis traces rays through.

#include "views/Layers.h"

#include <string>
#include <vector>

namespace lucent::views {

struct VoxelSettings {
    int slices = 256;       ///< 256 or 512, between the bounds
    bool local = true;      ///< between a pixel's own first and last surface; else between those of all
    bool onTheFly = false;  ///< set bits are looked for whenever a depth is, not once in a pass of its own
    int targets = 8;        ///< images that a pass draws into, at most; fewer on a GPU that has fewer
    bool floatBlend = true; ///< 32-bit floats are drawn with MAX where the GPU can; else in two passes
};

/// Depths of surfaces behind each other, ready to be traced (shaders/views/depth_layers.glsl).
struct DepthLayers {
    enum class From { Peel, Voxels, Bits, Bounds };
    From from = From::Peel;
    VoxelSettings voxels;     ///< of From::Voxels and Bits
    int count = 0;            ///< surfaces behind each other, at most kMostLayers
    vec2 bounds{0};           ///< nearest and farthest depth of all, m
    graph::TextureId images;  ///< what `from` says: peeled layers, depths, or the images of bits and counts
    graph::TextureId extreme; ///< R32F, layer 0: nearest depth, negated; layer 1: farthest; not of From::Peel
    graph::TextureId deepest; ///< the farthest depth of each layer, shaders/views/deepest.frag
};

/// Puts the surfaces into slices and finds their depths. Surfaces past 15 in eight slices of a pixel are
/// miscounted.
///
/// @param count  layers that are found, nearest first, at most kMostLayers
Result<DepthLayers> recordVoxels(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                 const Drawables& glass, ivec2 size, int count,
                                 const VoxelSettings& settings);
/// Only the first and the last surface of each pixel: the two faces of earlier methods.
Result<DepthLayers> recordFrontBack(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                    const Drawables& glass, ivec2 size);
/// The depths of peeled layers.
Result<DepthLayers> recordDepths(graph::FrameGraph& graph, gl::Context& context, const Eye& eye,
                                 const Drawables& glass, ivec2 size, const Layers& layers);

/// What slices can tell apart, summed over a picture.
struct VoxelCount {
    long surfaces = 0;  ///< in all pixels
    long sharing = 0;   ///< of them in groups of eight slices where two or more lie in one slice
    long saturated = 0; ///< such groups whose eight bits all came out set, with fewer surfaces
};
/// Draws slices once and reads back how many surfaces share one. Such surfaces keep their number, so that
/// those behind them stay what they are, and lie at the slice; of more than two that share one some may lie a
/// slice off, and of a saturated group up to seven.
Result<VoxelCount> countVoxels(graph::TexturePool& pool, gl::Context& context, const Eye& eye,
                               const Drawables& glass, float time, ivec2 size, const VoxelSettings& settings);

/// What shaders/views/depth_layers.glsl is compiled with and samples.
std::vector<std::string> depthDefines(const DepthLayers& depths);
void sampleDepths(graph::PassBuilder& pass, const DepthLayers& depths);
std::vector<graph::Binding> depthBindings(const graph::Resources& resources, const DepthLayers& depths);

} // namespace lucent::views
