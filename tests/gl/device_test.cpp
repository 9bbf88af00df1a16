// Layers, targets, topologies, blending, depth and queries on a real driver.
#include "gl/Query.h"
#include "graph/FrameGraph.h"
#include "shaders/Shaders.h"
#include "tests/support/Gl.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <limits>
#include <memory>

namespace lucent::gl {
namespace {

using graph::Attachment;
using graph::Format;
using graph::Texture;
using graph::TextureDesc;
using graph::uvec4;

// What a draw needs besides textures, in one block.
struct TestBlock {
    static constexpr std::string_view kName = "TestBlock";
    vec4 value{0}, place{0};
};

const std::string kBlock = "layout(std140) uniform TestBlock { vec4 value; vec4 place; } test;\n";
const std::string kCorner =
    "vec2 corner() { return vec2((gl_VertexID & 1) << 2, (gl_VertexID & 2) << 1) - 1.0; }\n";
// The whole target, at depth 0.5 or at any depth.
const std::string kScreen = kCorner + "void main() { gl_Position = vec4(corner(), 0.0, 1.0); }\n";
const std::string kPlane =
    kBlock + kCorner + "void main() { gl_Position = vec4(corner(), test.place.z, 1.0); }\n";
const std::string kValue =
    kBlock + "layout(location = 0) out vec4 oValue;\nvoid main() { oValue = test.value; }\n";
const std::string kOne = "layout(location = 0) out vec4 oValue;\nvoid main() { oValue = vec4(1.0); }\n";

struct DeviceTest : support::GlTest {
    Device& device() { return context->device(); }

    const Program* program(const std::string& vertex, const std::string& fragment) {
        const shaders::Piece vertexPiece{"test.vert", 1, vertex.c_str()};
        const shaders::Piece fragmentPiece{"test.frag", 1, fragment.c_str()};
        const shaders::Piece *const ofVertex = &vertexPiece, *const ofFragment = &fragmentPiece;
        programs.push_back(std::make_unique<Program>("test", shaders::Stage{"test.vert", &ofVertex, 1},
                                                     shaders::Stage{"test.frag", &ofFragment, 1},
                                                     std::vector<std::string>{}));
        programs.back()->compile(); // while its source is here
        return programs.back().get();
    }
    Texture texture(const TextureDesc& desc, const std::string& label = "test") {
        return Texture(device(), desc, label);
    }
    void draw(const std::vector<Attachment>& colors, const graph::Draw& one, const Attachment& depth = {}) {
        device().runPass({.label = "test.pass", .colors = colors, .depth = depth},
                         [&](graph::Commands& commands) { commands.draw(one); });
    }
    void clear(const Attachment& color) {
        device().runPass({.label = "test.clear", .colors = {color}}, [](graph::Commands&) {});
    }

    std::vector<std::unique_ptr<Program>> programs;
};

// First channels of all texels, top row first.
std::vector<float> firstChannels(const Image& image) {
    std::vector<float> values;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4)
        values.push_back(image.pixels[i]);
    return values;
}

// --- formats

TEST_F(DeviceTest, EveryFloatFormatComesBackAsSentAndAbsentChannelsAreZeroAndOne) {
    const struct {
        Format format;
        int channels;
    } cases[] = {{Format::R16F, 1}, {Format::RG16F, 2}, {Format::RGBA16F, 4},
                 {Format::R32F, 1}, {Format::RG32F, 2}, {Format::RGBA32F, 4}};
    for (const auto& [format, channels] : cases) {
        const Texture sent = texture({.size = {2, 1}, .format = format});
        std::vector<float> values; // eighths: exact in 16 bits
        for (int i = 0; i < 2 * channels; ++i)
            values.push_back(float(i + 1) / 8);
        if (kindOf(format) == graph::Kind::Half) {
            std::vector<std::uint16_t> halves(values.size());
            std::transform(values.begin(), values.end(), halves.begin(), glm::packHalf1x16);
            device().upload(sent.handle(), 0, halves);
        } else {
            device().upload(sent.handle(), 0, values);
        }
        const Image back = device().read(sent.handle());
        for (int x = 0; x < 2; ++x)
            for (int c = 0; c < 4; ++c)
                EXPECT_EQ(back.at(x, 0)[c],
                          c < channels ? values[std::size_t(x * channels + c)] : float(c == 3))
                    << graph::name(format);
    }
}

TEST_F(DeviceTest, EveryIntegerFormatComesBackAsSentAndAbsentChannelsAreZeroAndOne) {
    const struct {
        Format format;
        std::size_t channels;
    } cases[] = {{Format::R32UI, 1}, {Format::RG32UI, 2}, {Format::RGBA32UI, 4}};
    for (const auto& [format, channels] : cases) {
        const Texture sent = texture({.size = {1, 1}, .format = format});
        const std::vector<std::uint32_t> values{0xffffffffu, 0x80000001u, 16777217u,
                                                7}; // no float holds them
        device().upload(sent.handle(), 0, std::vector(values.begin(), values.begin() + channels));
        const std::vector<std::uint32_t> back = device().readIntegers(sent.handle());
        for (std::size_t c = 0; c < 4; ++c)
            EXPECT_EQ(back[c], c < channels ? values[c] : std::uint32_t(c == 3)) << graph::name(format);
    }
}

// --- layers and levels

TEST_F(DeviceTest, LayersAreDrawnAndReadBackEachByItself) {
    const Texture layers = texture({.size = {2, 2}, .format = Format::RGBA32F, .layers = 3});
    for (int layer = 0; layer < 3; ++layer)
        clear({layers.handle(), layer, 0, vec4(float(layer + 1))});
    for (int layer = 0; layer < 3; ++layer)
        EXPECT_EQ(firstChannels(device().read(layers.handle(), layer)),
                  std::vector<float>(4, float(layer + 1)));
}

TEST_F(DeviceTest, LayersThatWereUploadedAreFetchedFromAnArraySampler) {
    const Texture layers = texture({.size = {1, 1}, .format = Format::R32F, .layers = 3});
    for (int layer = 0; layer < 3; ++layer)
        device().upload(layers.handle(), 0, layer, std::vector<float>{float(layer + 1)});
    const Program* fetch =
        program(kScreen, "uniform sampler2DArray uLayers;\n"
                         "layout(location = 0) out vec4 oValue;\n"
                         "float layer(int i) { return texelFetch(uLayers, ivec3(0, 0, i), 0).r; }\n"
                         "void main() { oValue = vec4(layer(0), layer(1), layer(2), 0.0); }\n");
    const Texture out = texture({.size = {1, 1}, .format = Format::RGBA32F});
    draw({{.texture = out.handle()}}, {.program = fetch, .textures = {{"uLayers", layers.handle()}}});
    const Image read = device().read(out.handle());
    EXPECT_EQ(std::vector(read.pixels.begin(), read.pixels.begin() + 3), (std::vector<float>{1, 2, 3}));
}

TEST_F(DeviceTest, MipLevelsAreDrawnAndReadBackEachByItself) {
    // 5x2 -> 2x1 -> 1x1, in the second layer only
    const Texture levels = texture({.size = {5, 2}, .format = Format::RGBA16F, .levels = 3, .layers = 2});
    for (int level = 0; level < 3; ++level)
        clear({levels.handle(), 1, level, vec4(float(level + 1))});
    for (int level = 0; level < 3; ++level) {
        const Image read = device().read(levels.handle(), 1, level);
        EXPECT_EQ(read.size(), levels.desc().sizeOf(level));
        EXPECT_EQ(firstChannels(read),
                  std::vector<float>(std::size_t(read.size().x) * read.size().y, float(level + 1)));
    }
}

TEST_F(DeviceTest, MoreLayersThanTheGpuHasAreReported) {
    const int layers = context->caps().maxArrayLayers + 1;
    const Texture deep = texture({.size = {1, 1}, .format = Format::R8, .layers = layers}, "deep");
    EXPECT_EQ(device().takeError(),
              "texture \"deep\" of 1x1x" + std::to_string(layers) + " R8: GL_INVALID_VALUE");
    context->takeError();
}

TEST_F(DeviceTest, ATextureOfOneLayerBoundToAnArraySamplerIsRefused) {
    const Program* fetch = program(kScreen, "uniform sampler2DArray uLayers;\n"
                                            "layout(location = 0) out vec4 oValue;\n"
                                            "void main() { oValue = texelFetch(uLayers, ivec3(0), 0); }\n");
    const Texture flat = texture({.size = {2, 2}}, "flat"), out = texture({.size = {1, 1}});
    draw({{.texture = out.handle()}}, {.program = fetch, .textures = {{"uLayers", flat.handle()}}});
    EXPECT_EQ(device().takeError(), "pass \"test.pass\": binds \"flat\" of 2x2 RGBA8 to uLayers; must be a "
                                    "texture of several layers");
}

TEST_F(DeviceTest, AFrameGraphDrawsLayersInPassesOfTheirOwn) {
    graph::FrameGraph frame;
    const Program* value = program(kScreen, kValue);
    const Program* sum = program(kScreen, "uniform sampler2DArray uLayers;\n"
                                          "layout(location = 0) out vec4 oValue;\n"
                                          "void main() { oValue = texelFetch(uLayers, ivec3(0, 0, 0), 0)\n"
                                          "+ texelFetch(uLayers, ivec3(0, 0, 1), 0); }\n");
    const graph::TextureId layers =
        frame.create("layers", {.size = {1, 1}, .format = Format::RGBA32F, .layers = 2});
    for (int layer = 0; layer < 2; ++layer)
        frame.addPass("layer", [&](graph::PassBuilder& pass) -> graph::Execute {
            pass.write(layers, layer);
            return [=](const graph::Resources&, graph::Commands& commands) {
                commands.draw({.program = value, .block = TestBlock{.value = vec4(layer ? 20.f : 3.f)}});
            };
        });
    const Texture out = texture({.size = {1, 1}, .format = Format::RGBA32F});
    const graph::TextureId target = frame.import(out.handle(), out.desc(), "out");
    frame.addPass("sum", [&](graph::PassBuilder& pass) -> graph::Execute {
        pass.sample(layers);
        pass.write(target);
        return [=](const graph::Resources& resources, graph::Commands& commands) {
            commands.draw({.program = sum, .textures = {{"uLayers", resources[layers]}}});
        };
    });
    frame.keep(target);
    graph::TexturePool pool(device());
    ASSERT_TRUE(frame.compile().ok());
    frame.execute(pool);
    EXPECT_EQ(device().read(out.handle()).pixels[0], 23);
}

// --- several targets

TEST_F(DeviceTest, OnePassFillsTargetsOfDifferentFormatsAndClearsEachToItsOwnValue) {
    const Texture position = texture({.size = {2, 1}, .format = Format::RGBA32F}),
                  color = texture({.size = {2, 1}, .format = Format::RGBA8}),
                  id = texture({.size = {2, 1}, .format = Format::RG32UI}),
                  depth = texture({.size = {2, 1}, .format = Format::R16F});
    const Program* all = program(kScreen, "layout(location = 0) out vec4 oPosition;\n"
                                          "layout(location = 1) out vec4 oColor;\n"
                                          "layout(location = 2) out uvec2 oId;\n"
                                          "layout(location = 3) out float oDepth;\n"
                                          "void main() { oPosition = vec4(1e6, 2.0, 3.0, 4.0);\n"
                                          "oColor = vec4(1.0, 0.0, 1.0, 0.0);\n"
                                          "oId = uvec2(4294967295u, 5u); oDepth = 0.25; }\n");
    // The left pixel is drawn, the right one keeps what the clear put there.
    draw({{.texture = position.handle(), .clear = vec4(-1, -2, -3, -4)},
          {.texture = color.handle(), .clear = vec4(0, 1, 0, 1)},
          {.texture = id.handle(), .clear = uvec4(4294967294u, 7, 0, 0)},
          {.texture = depth.handle(), .clear = vec4(0.5f)}},
         {.program = all, .region = {0, 0, 1, 1}});
    EXPECT_EQ(device().read(position.handle()).pixels, (std::vector<float>{1e6f, 2, 3, 4, -1, -2, -3, -4}));
    EXPECT_EQ(device().read(color.handle()).pixels, (std::vector<float>{1, 0, 1, 0, 0, 1, 0, 1}));
    EXPECT_EQ(device().readIntegers(id.handle()),
              (std::vector<std::uint32_t>{4294967295u, 5, 0, 1, 4294967294u, 7, 0, 1}));
    EXPECT_EQ(firstChannels(device().read(depth.handle())), (std::vector<float>{0.25f, 0.5f}));
}

// --- blending

TEST_F(DeviceTest, BlendingAddsAndKeepsTheLargerOrTheSmaller) {
    const Program* value = program(kScreen, kValue);
    const struct {
        graph::Blend blend;
        vec4 expected;
    } cases[] = {{graph::Blend::None, vec4(2, -1, 0.25f, 8)},
                 {graph::Blend::Add, vec4(3, 2, 0.75f, 6)},
                 {graph::Blend::Max, vec4(2, 3, 0.5f, 8)},
                 {graph::Blend::Min, vec4(1, -1, 0.25f, -2)}};
    for (Format format : {Format::RGBA16F, Format::RGBA32F}) {
        if (format == Format::RGBA32F && !context->caps().floatBlend) continue; // refused: see below
        for (const auto& [blend, expected] : cases) {
            const Texture target = texture({.size = {1, 1}, .format = format});
            draw({{.texture = target.handle(), .clear = vec4(1, 3, 0.5f, -2)}},
                 {.program = value, .blend = blend, .block = TestBlock{.value = vec4(2, -1, 0.25f, 8)}});
            const Image read = device().read(target.handle());
            for (int c = 0; c < 4; ++c)
                EXPECT_EQ(read.pixels[std::size_t(c)], expected[c]) << int(blend) << graph::name(format);
        }
    }
}

TEST_F(DeviceTest, BlendingOverwritesIntegersBesideBlendedTargets) {
    const Texture sum = texture({.size = {1, 1}, .format = Format::R16F}),
                  id = texture({.size = {1, 1}, .format = Format::R32UI});
    const Program* both = program(kScreen, "layout(location = 0) out float oSum;\n"
                                           "layout(location = 1) out uint oId;\n"
                                           "void main() { oSum = 2.0; oId = 5u; }\n");
    draw({{.texture = sum.handle(), .clear = vec4(1)}, {.texture = id.handle(), .clear = uvec4(9)}},
         {.program = both, .blend = graph::Blend::Add});
    EXPECT_EQ(device().read(sum.handle()).pixels[0], 3);
    EXPECT_EQ(device().readIntegers(id.handle())[0], 5u);
}

TEST_F(DeviceTest, BlendingIntoFloatsThatTheGpuCannotBlendIsRefused) {
    Caps poor = context->caps();
    poor.floatBlend = poor.halfBlend = false;
    Device device(poor);
    const Program* value = program(kScreen, kValue);
    const auto add = [&](const Texture& target) {
        device.runPass({.label = "splat", .colors = {{.texture = target.handle(), .clear = vec4(1)}}},
                       [&](graph::Commands& commands) {
                           commands.draw({.program = value,
                                          .blend = graph::Blend::Add,
                                          .block = TestBlock{.value = vec4(1)}});
                       });
        EXPECT_EQ(device.read(target.handle()).pixels[0], 1); // cleared, not drawn
        return device.takeError();
    };
    EXPECT_EQ(
        add(Texture(device, {.size = {1, 1}, .format = Format::RG32F}, "flux")),
        "pass \"splat\": blends into \"flux\" (RG32F) without EXT_float_blend; must be 16-bit floats or "
        "summed over passes");
    EXPECT_EQ(add(Texture(device, {.size = {1, 1}, .format = Format::R16F}, "flux")),
              "pass \"splat\": blends into \"flux\" (R16F) on a GPU that cannot; must be summed over passes");
}

// --- what is drawn

TEST_F(DeviceTest, IndicesChooseTheVerticesThatAShaderFetches) {
    // Two triangles over the left half of 4x4 pixels; vertex 1 is nobody's and would cover the right half.
    const std::vector<float> positions{-1, -1, 0,  1, /**/ 5, 0, 0,      1, /**/ 0, -1,
                                       0,  1,  -1, 1, 0,      1, /**/ 0, 1, 0,      1};
    const Texture vertices = texture({.size = {5, 1}, .format = Format::RGBA32F});
    device().upload(vertices.handle(), 0, positions);
    const graph::Indices indices(device(), std::vector<std::uint32_t>{0, 2, 3, 3, 2, 4}, "quad");
    EXPECT_EQ(indices.count(), 6);
    const Program* mesh =
        program("uniform sampler2D uPosition;\n"
                "void main() { gl_Position = texelFetch(uPosition, ivec2(gl_VertexID, 0), 0); }\n",
                kOne);
    const Texture out = texture({.size = {4, 4}, .format = Format::R32F});
    draw({{.texture = out.handle(), .clear = vec4(0)}}, {.program = mesh,
                                                         .indices = indices.handle(),
                                                         .vertices = indices.count(),
                                                         .textures = {{"uPosition", vertices.handle()}}});
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            EXPECT_EQ(device().read(out.handle()).at(x, y)[0], x < 2) << x << ", " << y;
}

TEST_F(DeviceTest, MoreIndicesThanThereAreAreRefused) {
    const graph::Indices indices(device(), std::vector<std::uint32_t>{0, 1, 2}, "mesh");
    const Texture out = texture({.size = {1, 1}});
    draw({{.texture = out.handle()}},
         {.program = program(kScreen, kOne), .indices = indices.handle(), .vertices = 4});
    EXPECT_EQ(device().takeError(), "pass \"test.pass\": draws 4 indices of \"mesh\"; must be at most 3");
}

TEST_F(DeviceTest, IndexBytesAreCountedAndGivenBack) {
    const std::size_t before = device().indexBytes();
    {
        const graph::Indices indices(device(), std::vector<std::uint32_t>(30), "mesh");
        EXPECT_EQ(device().indexBytes(), before + 30 * 4);
    }
    EXPECT_EQ(device().indexBytes(), before);
}

TEST_F(DeviceTest, PointsHaveTheSizeThatTheShaderSetsAndInstancesTheirNumber) {
    // Points 3 wide around the centres of the pixels (2, 2), (6, 2) and (2, 6), (6, 6) of 9x9: the vertex
    // chooses the column, the instance the row.
    const Program* points = program("void main() { gl_PointSize = 3.0;\n"
                                    "vec2 pixel = vec2(gl_VertexID, gl_InstanceID) * 4.0 + 2.5;\n"
                                    "gl_Position = vec4(pixel / 4.5 - 1.0, 0.0, 1.0); }\n",
                                    kOne);
    const Texture out = texture({.size = {9, 9}, .format = Format::R16F});
    draw({{.texture = out.handle(), .clear = vec4(0)}},
         {.program = points, .vertices = 2, .instances = 2, .topology = graph::Topology::Points});
    const Image read = device().read(out.handle());
    const auto near = [](int at) { return (at >= 1 && at <= 3) || (at >= 5 && at <= 7); };
    for (int y = 0; y < 9; ++y)
        for (int x = 0; x < 9; ++x) // rows from the top: the picture is its own mirror image
            EXPECT_EQ(read.at(x, y)[0], near(x) && near(8 - y)) << x << ", " << y;
}

TEST_F(DeviceTest, LinesCoverOnePixelOfEachColumn) {
    const Program* line =
        program("void main() { gl_Position = vec4(gl_VertexID == 0 ? -1.0 : 1.0, 0.25, 0.0, 1.0); }\n", kOne);
    const Texture out = texture({.size = {8, 4}, .format = Format::R8});
    draw({{.texture = out.handle(), .clear = vec4(0)}},
         {.program = line, .vertices = 2, .topology = graph::Topology::Lines});
    // 0.25 is row 2.5 of 4 from the bottom: the second from the top
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            EXPECT_EQ(device().read(out.handle()).at(x, y)[0], y == 1) << x << ", " << y;
}

TEST_F(DeviceTest, CullingLeavesOutFrontOrBackFaces) {
    const Program* one = program(kScreen, kOne); // counterclockwise: a front face
    const struct {
        graph::Cull cull;
        float expected;
    } cases[] = {{graph::Cull::None, 1}, {graph::Cull::Back, 1}, {graph::Cull::Front, 0}};
    for (const auto& [cull, expected] : cases) {
        const Texture out = texture({.size = {1, 1}});
        draw({{.texture = out.handle(), .clear = vec4(0)}}, {.program = one, .cull = cull});
        EXPECT_EQ(device().read(out.handle()).pixels[0], expected) << int(cull);
    }
}

// --- depth

TEST_F(DeviceTest, DepthTestsCompareWithTheClearValueAndWriteOnlyWhenAsked) {
    const Program* plane = program(kPlane, kValue);
    const Texture out = texture({.size = {1, 1}}),
                  depth = texture({.size = {1, 1}, .format = Format::Depth32F});
    // z in clip space, -1 to 1, stands at 0.5 z + 0.5 in the depth target.
    const auto passes = [&](graph::DepthTest test, float z, bool write, std::optional<graph::Clear> start) {
        draw({{.texture = out.handle(), .clear = vec4(0)}},
             {.program = plane,
              .depthTest = test,
              .depthWrite = write,
              .block = TestBlock{.value = vec4(1), .place = vec4(0, 0, z, 0)}},
             {.texture = depth.handle(), .clear = start});
        return device().read(out.handle()).pixels[0] == 1;
    };
    using graph::DepthTest;
    EXPECT_TRUE(passes(DepthTest::Less, 0.0f, true, 1.0f)); // leaves 0.5
    EXPECT_FALSE(passes(DepthTest::Less, 0.0f, true, {}));
    EXPECT_TRUE(passes(DepthTest::LessEqual, 0.0f, true, {}));
    EXPECT_TRUE(passes(DepthTest::Equal, 0.0f, true, {}));
    EXPECT_FALSE(passes(DepthTest::Equal, -0.5f, true, {}));
    EXPECT_TRUE(passes(DepthTest::Less, -0.5f, false, {}));  // 0.25 passes, 0.5 stays
    EXPECT_TRUE(passes(DepthTest::Less, -0.25f, false, {})); // as 0.375 shows
    EXPECT_TRUE(passes(DepthTest::None, 0.5f, true, {}));
    EXPECT_FALSE(passes(DepthTest::Less, -0.5f, false, 0.25f)); // the next clear is not masked
}

TEST_F(DeviceTest, AStencilCountsFragmentsThatDepthHidesToo) {
    const Program* plane = program(kPlane, kValue);
    const Texture out = texture({.size = {1, 1}}),
                  depth = texture({.size = {1, 1}, .format = Format::Depth32FStencil8});
    const auto count = [&](float z, std::optional<graph::Clear> start) {
        draw({{.texture = out.handle()}},
             {.program = plane,
              .depthTest = graph::DepthTest::Less,
              .stencil = graph::Stencil::Count,
              .block = TestBlock{.place = vec4(0, 0, z, 0)}},
             {.texture = depth.handle(), .clear = start});
    };
    const auto areMoreThan = [&](int counted) {
        draw({{.texture = out.handle(), .clear = vec4(0)}},
             {.program = plane,
              .stencil = graph::Stencil::More,
              .counted = counted,
              .block = TestBlock{.value = vec4(1)}},
             {.texture = depth.handle()});
        return device().read(out.handle()).pixels[0] == 1;
    };
    count(0.0f, 1.0f);
    count(0.5f, {}); // behind
    count(-0.5f, {});
    EXPECT_TRUE(areMoreThan(2));
    EXPECT_TRUE(areMoreThan(2)) << "asking counts nothing";
    EXPECT_FALSE(areMoreThan(3));
    count(0.0f, 1.0f);
    EXPECT_TRUE(areMoreThan(0));
    EXPECT_FALSE(areMoreThan(1)) << "clearing begins anew";
}

TEST_F(DeviceTest, ADepthTextureWithoutColoursIsDrawnAndSampled) {
    for (Format format : {Format::Depth24, Format::Depth32F, Format::Depth32FStencil8}) {
        const Texture depth = texture({.size = {2, 2}, .format = format, .layers = 2});
        draw({},
             {.program = program(kPlane, kValue),
              .depthTest = graph::DepthTest::Less,
              .block = TestBlock{.place = vec4(0, 0, -0.5f, 0)}},
             {.texture = depth.handle(), .layer = 1, .clear = 1.0f});
        const Program* fetch =
            program(kScreen, "uniform sampler2DArray uDepth;\n"
                             "layout(location = 0) out vec4 oValue;\n"
                             "void main() { oValue = texelFetch(uDepth, ivec3(1, 1, 1), 0); }\n");
        const Texture out = texture({.size = {1, 1}, .format = Format::R32F});
        draw({{.texture = out.handle()}}, {.program = fetch, .textures = {{"uDepth", depth.handle()}}});
        EXPECT_NEAR(device().read(out.handle()).pixels[0], 0.25, 1e-7)
            << graph::name(format); // 2^-24: one step
    }
}

// --- queries

struct QueryTest : DeviceTest {
    void TearDown() override {
        if (context) device().delayQueries(0);
        DeviceTest::TearDown();
    }
    // Asks about a triangle that the depth target hides or not.
    void ask(Query& query, bool hidden) {
        const Texture depth = texture({.size = {4, 4}, .format = Format::Depth24});
        const graph::Draw one{.program = program(kScreen, kOne), .depthTest = graph::DepthTest::Less};
        device().runPass({.label = "test.ask",
                          .depth = {.texture = depth.handle(), .clear = hidden ? 0.0f : 1.0f},
                          .query = &query},
                         [&](graph::Commands& commands) { commands.draw(one); });
    }
    // Polls until there is an answer; the count of polls without one goes into `waited`.
    bool answer(Query& query, int* waited = nullptr) {
        const Texture target = texture({.size = {1, 1}});
        for (int poll = 0; poll < 1000; ++poll) {
            if (const std::optional<bool> any = query.poll()) {
                if (waited) *waited = poll;
                return *any;
            }
            device().wait(target.handle());
        }
        ADD_FAILURE() << "no answer";
        return false;
    }
};

TEST_F(QueryTest, TellsWhetherAPassDrewAnySample) {
    Query query(device());
    ask(query, false);
    EXPECT_TRUE(answer(query));
    EXPECT_EQ(query.poll(), true); // the answer stays
    ask(query, true);
    EXPECT_FALSE(answer(query)); // and belongs to the last pass
}

TEST_F(QueryTest, HasNoAnswerBeforeThereWasAPass) {
    Query query(device());
    EXPECT_EQ(query.poll(), std::nullopt);
}

TEST_F(QueryTest, ClearingIsNotDrawing) {
    Query query(device());
    const Texture target = texture({.size = {4, 4}});
    device().runPass(
        {.label = "test.clear", .colors = {{.texture = target.handle(), .clear = vec4(1)}}, .query = &query},
        [](graph::Commands&) {});
    EXPECT_FALSE(answer(query));
}

TEST_F(QueryTest, AnswersComeAsLateAsATestWantsThem) {
    device().delayQueries(5);
    Query first(device()), second(device());
    ask(first, false);
    ask(second, true);
    int waited = 0;
    EXPECT_TRUE(answer(first, &waited));
    EXPECT_GE(waited, 5);
    EXPECT_FALSE(answer(second, &waited));
    EXPECT_GE(waited, 5);
    ask(first, true); // an old answer is not given for a new question
    EXPECT_EQ(first.poll(), std::nullopt);
}

// --- broken values

struct BrokenTest : DeviceTest {
    void SetUp() override {
        DeviceTest::SetUp();
        if (context) device().checkTargets(true);
    }
    void TearDown() override {
#ifdef NDEBUG
        if (context) device().checkTargets(false);
#endif
        DeviceTest::TearDown();
    }
};

TEST_F(BrokenTest, NanThatAPassLeavesIsReportedWithPassTextureAndTexel) {
    const Texture first = texture({.size = {4, 3}, .format = Format::RGBA16F}, "first"),
                  flux = texture({.size = {4, 3}, .format = Format::R32F, .layers = 2}, "caustics.flux");
    const Program* broken = program(kScreen, "layout(location = 0) out vec4 oFirst;\n"
                                             "layout(location = 1) out float oFlux;\n"
                                             "void main() { oFirst = vec4(1.0);\n"
                                             "bool here = ivec2(gl_FragCoord.xy) == ivec2(2, 1);\n"
                                             "oFlux = here ? uintBitsToFloat(0x7fc00000u) : 0.0; }\n");
    draw({{.texture = first.handle()}, {.texture = flux.handle(), .layer = 1}}, {.program = broken});
    EXPECT_EQ(device().takeError(),
              "pass \"test.pass\": leaves NaN in \"caustics.flux\" at texel 2, 1, layer 1; "
              "must be finite");
}

TEST_F(BrokenTest, InfinityIsFoundWhereThePassDrewAndNowhereElse) {
    const Texture sum = texture({.size = {4, 4}, .format = Format::RGBA32F}, "sum");
    const Program* value = program(kScreen, kValue);
    const auto drawAt = [&](ivec4 region, float drawn) {
        draw({{.texture = sum.handle()}},
             {.program = value, .region = region, .block = TestBlock{.value = vec4(drawn)}});
        return device().takeError();
    };
    EXPECT_EQ(drawAt({0, 0, 4, 4}, 1), "");
    EXPECT_EQ(drawAt({1, 2, 1, 1}, -std::numeric_limits<float>::infinity()),
              "pass \"test.pass\": leaves infinity in \"sum\" at texel 1, 2, layer 0; must be finite");
    EXPECT_EQ(drawAt({2, 2, 2, 2}, 1), ""); // the infinity beside it is another pass's
}

// --- what the device can do

TEST_F(DeviceTest, CapsHoldAtLeastWhatTheStandardAsksFor) {
    const Caps& caps = context->caps(); // OpenGL ES 3.0, tables 6.28 and 6.31
    EXPECT_GE(caps.maxArrayLayers, 256);
    EXPECT_GE(caps.maxVertexTextureUnits, 16);
    EXPECT_GE(caps.maxPointSize, 1);
    EXPECT_TRUE(caps.halfBlend); // comes with EXT_color_buffer_float, without which there is no Context
    for (const char* key : {"maxArrayLayers", "maxVertexTextureUnits", "maxPointSize", "halfBlend"})
        EXPECT_NE(caps.json().find("\"" + std::string(key) + "\": "), std::string::npos) << key;
}

} // namespace
} // namespace lucent::gl
