#pragma once
/// Scenes in memory for the tests of this folder.

#include "base/File.h"
#include "base/Image.h"
#include "scene/Mesh.h"

#include <cmath>
#include <span>
#include <string>

namespace lucent::viewer {

/// A lamp over a small field: 1 m wide, 2 m of height shown, so that a 400 pixel high canvas has 0.005 m a
/// pixel.
inline constexpr const char* kLampScene =
    R"({"lucent": 1, "title": "Lamp", "caption": "A wave", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 0, 2], "height": 2},
 "lights": [{"type": "point", "position": [0.2, 0.1, 0.5]}],
 "environment": {"source": "uniform", "enabled": false},
 "technique": {"sampling": {"directions": 8, "pixelSamples": 1}},
 "objects": [{"name": "field", "shape": {"type": "heightfield", "heights": "wave.pfm"}}]})";

/// The same field, seen from farther off, under an environment only: more of its lights than a preview
/// takes.
inline constexpr const char* kMapScene = R"({"lucent": 1, "title": "Map", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 0, 2], "height": 4},
 "environment": {"source": "rainbow"},
 "technique": {"sampling": {"directions": 48, "pixelSamples": 1}},
 "objects": [{"name": "field", "shape": {"type": "heightfield", "heights": "wave.pfm"}}]})";

/// Glass and a moving mesh over a floor under all kinds of lights, with 2 m of height shown; nothing of it is
/// a relief, and all of it has few triangles.
inline constexpr const char* kGlassScene = R"({"lucent": 1, "title": "Glass", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 0, 2], "height": 2},
 "lights": [{"type": "spot", "position": [0.5, 0.5, 0]},
            {"type": "area", "corner": [-0.5, 0.5, 0]},
            {"type": "distant", "direction": [0, -1, -1]}],
 "environment": {"source": "sky"},
 "technique": {"sampling": {"lampSamples": 1, "pixelSamples": 1}, "caustics": {"grid": 32, "mapSize": 64}},
 "objects": [{"name": "block", "shape": {"type": "box", "size": [0.3, 0.4, 0.5]}, "material": {"transmission": 1}},
             {"name": "tent", "shape": {"type": "mesh", "source": "tent.mesh", "part": "cloth"}, "material": {},
              "wave": {"amplitude": [0.05, 0, 0]}},
             {"name": "floor", "shape": {"type": "plane"}, "transform": {"translate": [0, -0.4, 0]}}]})";

/// Still water over a floor, both 1 m wide, seen from straight above, with 2 m of height shown.
inline constexpr const char* kWaterScene = R"({"lucent": 1, "title": "Water", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 2, 0], "up": [0, 0, -1], "height": 2},
 "lights": [{"type": "distant", "direction": [0.1, -1, 0]}],
 "technique": {"sampling": {"pixelSamples": 1}, "caustics": {"grid": 32, "mapSize": 64}},
 "objects": [{"name": "floor", "shape": {"type": "plane"}, "transform": {"translate": [0, -0.3, 0]}},
             {"name": "water", "shape": {"type": "water", "cells": 32}, "material": {"transmission": 1, "ior": 1.33}}]})";

/// A ball of marble, 20 mm wide, lit from the left, with 40 mm of height shown; and a board behind it.
inline constexpr const char* kMarbleScene = R"({"lucent": 1, "title": "Marble", "size": [512, 512],
 "camera": {"type": "orthographic", "eye": [0, 0, 1], "height": 0.04},
 "lights": [{"type": "distant", "direction": [-1, -0.3, -1], "irradiance": 2}],
 "technique": {"sampling": {"pixelSamples": 1}},
 "objects": [{"name": "board", "shape": {"type": "box", "size": [0.04, 0.02, 0.001]}, "transform": {"translate": [0, 0, -0.02]}},
             {"name": "ball", "shape": {"type": "sphere", "radius": 0.01}, "material": {"preset": "marble"}}]})";

/// Two triangles of two materials, 2 m wide, 1 m high and flat in z.
inline scene::Mesh tentMesh() {
    scene::Mesh mesh{.positions = {{-1, 0, 0}, {0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                     .indices = {0, 1, 2, 1, 3, 2}};
    scene::Material glass;
    glass.kind = scene::Clear{};
    mesh.parts = {{"cloth", 0, 3, {}}, {"pane", 3, 3, glass}};
    return mesh;
}

/// 16 x 16 texels, one channel. @param value  of column and row
template <class Value>
Bytes smallMap(Value value) {
    Image image(16, 16, 1);
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x)
            *image.at(x, y) = value(x, y);
    return *encodeImage(image, "map.pfm");
}

inline Bytes waveMap() {
    return smallMap(
        [](int x, int y) { return 0.5f + 0.5f * std::sin(float(x) * 0.8f) * std::cos(float(y)); });
}

/// "scene.json" with this text, a wave of heights and an alpha with holes in its left half.
inline ReadFile sceneFiles(std::string scene) {
    return [scene](const std::string& path) -> Result<Bytes> {
        const auto text = std::as_bytes(std::span(scene));
        if (path == "scene.json") return Bytes(text.begin(), text.end());
        if (path == "wave.pfm") return waveMap();
        if (path == "tent.mesh") return scene::encodeMesh(tentMesh());
        if (path == "holes.pfm") return smallMap([](int x, int y) { return x < 8 && y % 2 ? 0.f : 1.f; });
        return Error{path + ": is not there"};
    };
}

} // namespace lucent::viewer
