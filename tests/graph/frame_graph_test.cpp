// The frame graph on a fake device: what runs, in which order, into which textures.
#include "graph/FrameGraph.h"

#include <gtest/gtest.h>

#include <set>

namespace lucent::graph {
namespace {

class FakeDevice : public Device {
public:
    TextureHandle createTexture(const TextureDesc&, std::string_view) override {
        alive.insert(++last);
        return TextureHandle(last);
    }
    void destroyTexture(TextureHandle texture) override { alive.erase(std::uint32_t(texture)); }
    IndicesHandle createIndices(std::span<const std::uint32_t>, std::string_view) override {
        indices.insert(++last);
        return IndicesHandle(last);
    }
    void destroyIndices(IndicesHandle handle) override { indices.erase(std::uint32_t(handle)); }
    void runPass(const PassTarget& target, const std::function<void(Commands&)>& body) override {
        struct Noting : Commands {
            explicit Noting(std::vector<Draw>& list) : draws(list) {}
            void draw(const Draw& draw) override { draws.push_back(draw); }
            std::vector<Draw>& draws;
        } commands(draws);
        passes.push_back(std::string(target.label));
        targets.push_back(target);
        body(commands);
    }
    std::uint32_t last = 0;
    std::set<std::uint32_t> alive, indices;
    std::vector<std::string> passes;
    std::vector<PassTarget> targets;
    std::vector<Draw> draws;
};

constexpr TextureDesc kSmall{.size = {4, 4}, .format = Format::RGBA32F};

struct FrameGraphTest : testing::Test {
    FakeDevice device;
    TexturePool pool{device};
    FrameGraph graph;
    TextureId screen = graph.import(TextureHandle::Screen, {.size = {4, 4}}, "screen");

    TextureId addMaker(const std::string& name, std::vector<TextureId> reads = {}) {
        TextureId made;
        graph.addPass(name, [&](PassBuilder& pass) -> Execute {
            for (TextureId read : reads)
                pass.sample(read);
            made = pass.createColor(name + ".out", kSmall);
            return [reads](const Resources& resources, Commands&) {
                for (TextureId read : reads)
                    EXPECT_NE(resources[read], TextureHandle::None);
            };
        });
        return made;
    }
    void addWriter(const std::string& name, const std::function<void(PassBuilder&)>& declare) {
        graph.addPass(name, [&](PassBuilder& pass) -> Execute {
            declare(pass);
            return [](const Resources&, Commands&) {};
        });
    }
    std::string refusal() {
        const Status status = graph.compile();
        return status.ok() ? "" : status.error().message;
    }
    void addFinal(std::vector<TextureId> reads) {
        graph.addPass("final", [&](PassBuilder& pass) -> Execute {
            for (TextureId read : reads)
                pass.sample(read);
            pass.write(screen);
            return [](const Resources&, Commands&) {};
        });
        graph.keep(screen);
    }
};

TEST_F(FrameGraphTest, PassesThatNobodyReadsDoNotRun) {
    const TextureId used = addMaker("used");
    addMaker("unused");
    addFinal({used});
    ASSERT_TRUE(graph.compile().ok());
    graph.execute(pool);
    EXPECT_EQ(device.passes, (std::vector<std::string>{"used", "final"}));
    EXPECT_EQ(graph.livePasses(), 2);
    EXPECT_NE(graph.dump().find("culled: unused"), std::string::npos);
}

TEST_F(FrameGraphTest, WhatOnlyACulledPassReadsIsCulledToo) {
    const TextureId source = addMaker("source");
    addMaker("unused", {source});
    addFinal({});
    ASSERT_TRUE(graph.compile().ok());
    graph.execute(pool);
    EXPECT_EQ(device.passes, (std::vector<std::string>{"final"}));
}

TEST_F(FrameGraphTest, TexturesOfDifferentTimesShareMemory) {
    // a -> b -> c: while c is made a is free again, so two textures serve three passes.
    const TextureId a = addMaker("a");
    const TextureId b = addMaker("b", {a});
    const TextureId c = addMaker("c", {b});
    addFinal({c});
    ASSERT_TRUE(graph.compile().ok());
    graph.execute(pool);
    EXPECT_EQ(device.alive.size(), 2u);
    const auto made = [&](int pass) { return device.targets[std::size_t(pass)].colors.front().texture; };
    EXPECT_EQ(made(0), made(2));
    EXPECT_NE(made(0), made(1));
}

TEST_F(FrameGraphTest, TheSecondFrameMakesNoTexture) {
    for (int frame = 0; frame < 2; ++frame) {
        graph = FrameGraph();
        screen = graph.import(TextureHandle::Screen, {.size = {4, 4}}, "screen");
        addFinal({addMaker("a")});
        ASSERT_TRUE(graph.compile().ok());
        graph.execute(pool);
    }
    EXPECT_EQ(device.last, 1u);
}

TEST_F(FrameGraphTest, WhatIsHandedOverStaysAndIsGivenBackToThePool) {
    const TextureId a = addMaker("a");
    addFinal({a});
    const auto heir = std::make_shared<Texture>();
    graph.handOver(a, heir);
    ASSERT_TRUE(graph.compile().ok());
    EXPECT_FALSE(*heir);
    graph.execute(pool);
    ASSERT_TRUE(*heir);
    EXPECT_EQ(pool.bytes(), 0u);
    const TextureHandle handle = heir->handle();
    pool.give(std::move(*heir));
    const std::size_t slot = pool.acquire({.size = {4, 4}, .format = Format::RGBA32F}, "b");
    EXPECT_EQ(pool.handle(slot), handle);
    EXPECT_EQ(device.last, 1u);
}

TEST_F(FrameGraphTest, WhatAnAbandonedGraphShouldHandOverIsNotThere) {
    const TextureId a = addMaker("a");
    addFinal({a});
    const auto heir = std::make_shared<Texture>();
    graph.handOver(a, heir);
    ASSERT_TRUE(graph.compile().ok());
    const auto most = [](const std::string&) { return 4; };
    ASSERT_TRUE(graph.step(pool, most));
    graph.abandon(pool);
    EXPECT_FALSE(*heir);
}

TEST_F(FrameGraphTest, TrimDeletesWhatTheLastFramesDidNotUse) {
    addFinal({addMaker("a")});
    ASSERT_TRUE(graph.compile().ok());
    graph.execute(pool);
    EXPECT_EQ(pool.bytes(), 4u * 4u * 16u);
    pool.trim(); // used since the last trim: stays
    EXPECT_EQ(device.alive.size(), 1u);
    pool.trim();
    EXPECT_EQ(device.alive.size(), 0u);
    EXPECT_EQ(pool.bytes(), 0u);
}

TEST_F(FrameGraphTest, AReadThatNoPassWritesIsRefusedByName) {
    const TextureId nobody = graph.import(TextureHandle::None, kSmall, "caustics.flux");
    addFinal({nobody});
    const Status status = graph.compile();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "graph: pass \"final\" samples \"caustics.flux\", which no pass writes");
}

TEST_F(FrameGraphTest, APassMayNotSampleItsOwnTarget) {
    graph.addPass("loop", [&](PassBuilder& pass) -> Execute {
        pass.sample(pass.createColor("loop.out", kSmall));
        return [](const Resources&, Commands&) {};
    });
    const Status status = graph.compile();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "graph: pass \"loop\" samples \"loop.out\", which it also writes; must be another texture");
}

TEST_F(FrameGraphTest, TargetsOfDifferentSizeAreRefused) {
    graph.addPass("two", [&](PassBuilder& pass) -> Execute {
        pass.createColor("big", {.size = {8, 8}});
        pass.createColor("small", {.size = {4, 4}});
        return [](const Resources&, Commands&) {};
    });
    const Status status = graph.compile();
    ASSERT_FALSE(status.ok());
    EXPECT_EQ(status.error().message,
              "graph: pass \"two\" writes \"small\" beside a target of another size; all must have one size");
}

// --- layers, levels, several targets

constexpr TextureDesc kLayered{.size = {4, 4}, .format = Format::RGBA16F, .levels = 2, .layers = 3};

TEST_F(FrameGraphTest, EveryPassThatDrawsALayerLivesWhenTheTextureIsRead) {
    const TextureId layers = graph.create("layers", kLayered);
    const TextureId unread = graph.create("unread", kLayered);
    for (int layer = 0; layer < 3; ++layer) {
        addWriter("layer" + std::to_string(layer), [&](PassBuilder& pass) { pass.write(layers, layer); });
        addWriter("unread", [&](PassBuilder& pass) { pass.write(unread, layer); });
    }
    addFinal({layers});
    addWriter("too late", [&](PassBuilder& pass) { pass.write(layers, 0); });
    ASSERT_EQ(refusal(), "");
    graph.execute(pool);
    EXPECT_EQ(device.passes, (std::vector<std::string>{"layer0", "layer1", "layer2", "final"}));
    EXPECT_EQ(device.alive.size(), 1u);
    for (int layer = 0; layer < 3; ++layer) {
        EXPECT_EQ(device.targets[std::size_t(layer)].colors.front().texture,
                  device.targets[0].colors.front().texture);
        EXPECT_EQ(device.targets[std::size_t(layer)].colors.front().layer, layer);
    }
    // (4 * 4 + 2 * 2) texels of 8 bytes in 3 layers, counted once
    EXPECT_EQ(graph.transientBytes(), 20u * 8u * 3u);
}

TEST_F(FrameGraphTest, TargetsReachTheDeviceWithLayerLevelAndClearValue) {
    const TextureId layers = graph.create("layers", kLayered);
    const TextureId ids = graph.create("ids", {.size = {2, 2}, .format = Format::RG32UI});
    addWriter("both", [&](PassBuilder& pass) {
        pass.write(layers, 2, 1); // level 1 of 4x4 is 2x2
        pass.write(ids);
        pass.clear(pass.createDepth("depth", {2, 2}, Format::Depth32F), 0.5f);
        pass.clear(ids, uvec4(7, 8, 0, 0));
    });
    addFinal({layers, ids});
    ASSERT_EQ(refusal(), "");
    graph.execute(pool);
    const PassTarget& target = device.targets.front();
    ASSERT_EQ(target.colors.size(), 2u);
    EXPECT_EQ(target.colors[0].layer, 2);
    EXPECT_EQ(target.colors[0].level, 1);
    EXPECT_FALSE(target.colors[0].clear.has_value());
    EXPECT_EQ(target.colors[1].clear, Clear(uvec4(7, 8, 0, 0)));
    EXPECT_EQ(target.depth.clear, Clear(0.5f));
}

TEST_F(FrameGraphTest, ADepthThatIsTestedAgainstKeepsThePassThatDrewIt) {
    const TextureId depth = graph.create("depth", {.size = {4, 4}, .format = Format::Depth24});
    addWriter("first", [&](PassBuilder& pass) {
        pass.write(depth);
        pass.clear(depth, 1.0f);
    });
    TextureId color;
    addWriter("second", [&](PassBuilder& pass) {
        color = pass.createColor("color", kSmall);
        pass.write(depth);
    });
    addFinal({color});
    ASSERT_EQ(refusal(), "");
    EXPECT_EQ(graph.livePasses(), 3);
}

TEST_F(FrameGraphTest, ADepthThatIsClearedKeepsNobody) {
    const TextureId depth = graph.create("depth", {.size = {4, 4}, .format = Format::Depth24});
    TextureId color;
    for (const char* name : {"first", "second"})
        addWriter(name, [&](PassBuilder& pass) {
            color = pass.createColor("color", kSmall);
            pass.write(depth);
            pass.clear(depth, 1.0f);
        });
    addFinal({color}); // of the second pass
    ASSERT_EQ(refusal(), "");
    EXPECT_EQ(graph.livePasses(), 2);
}

TEST_F(FrameGraphTest, APassThatIsAskedAboutRunsThoughNobodyReadsIt) {
    struct Silent : Query {
        std::optional<bool> poll() override { return std::nullopt; }
    } query;
    addWriter("asked", [&](PassBuilder& pass) {
        pass.createColor("any", kSmall);
        pass.query(query);
    });
    addFinal({});
    ASSERT_EQ(refusal(), "");
    graph.execute(pool);
    EXPECT_EQ(device.passes, (std::vector<std::string>{"asked", "final"}));
    EXPECT_EQ(device.targets.front().query, &query);
}

TEST_F(FrameGraphTest, AReadBeforeTheWriteIsRefusedByName) {
    const TextureId later = graph.create("later", kSmall);
    addMaker("early", {later});
    addWriter("writer", [&](PassBuilder& pass) { pass.write(later); });
    EXPECT_EQ(refusal(), "graph: pass \"early\" samples \"later\", which no pass writes before it");
}

TEST_F(FrameGraphTest, AnotherLayerOfTheOwnTargetMayNotBeSampledEither) {
    const TextureId layers = graph.create("layers", kLayered);
    addWriter("first", [&](PassBuilder& pass) { pass.write(layers, 0); });
    addWriter("peel", [&](PassBuilder& pass) {
        pass.sample(layers);
        pass.write(layers, 1);
    });
    EXPECT_EQ(refusal(),
              "graph: pass \"peel\" samples \"layers\", which it also writes; must be another texture");
}

TEST_F(FrameGraphTest, LayersAndLevelsThatDoNotExistAreRefused) {
    const TextureId layers = graph.create("layers", kLayered);
    addWriter("deep", [&](PassBuilder& pass) { pass.write(layers, 3); });
    EXPECT_EQ(refusal(), "graph: pass \"deep\" writes layer 3 of \"layers\"; must be 0 to 2");
    graph = FrameGraph();
    const TextureId again = graph.create("layers", kLayered);
    addWriter("small", [&](PassBuilder& pass) { pass.write(again, 0, 2); });
    EXPECT_EQ(refusal(), "graph: pass \"small\" writes level 2 of \"layers\"; must be 0 to 1");
}

TEST_F(FrameGraphTest, ATargetThatStandsTwiceIsRefusedUnlessItIsAnotherLayer) {
    const TextureId layers = graph.create("layers", kLayered);
    addWriter("two", [&](PassBuilder& pass) {
        pass.write(layers, 0);
        pass.write(layers, 1);
    });
    EXPECT_EQ(refusal(), "");
    addWriter("same", [&](PassBuilder& pass) {
        pass.write(layers, 1);
        pass.write(layers, 1);
    });
    EXPECT_EQ(refusal(), "graph: pass \"same\" writes \"layers\" twice; must be once");
}

TEST_F(FrameGraphTest, ASecondDepthIsRefused) {
    addWriter("two", [&](PassBuilder& pass) {
        pass.createDepth("near", {4, 4});
        pass.createDepth("far", {4, 4});
    });
    EXPECT_EQ(refusal(), "graph: pass \"two\" writes \"far\" beside another depth; must be one");
}

TEST_F(FrameGraphTest, APassWithoutTargetIsRefused) {
    addWriter("idle", [](PassBuilder&) {});
    EXPECT_EQ(refusal(), "graph: pass \"idle\" writes nothing; must have a target");
}

TEST_F(FrameGraphTest, ClearValuesOfAnotherKindAreRefused) {
    const struct {
        Format format;
        Clear value;
        const char* message;
    } cases[] = {
        {Format::R32UI, vec4(0), "graph: pass \"p\" clears \"t\" (R32UI) with a vec4; must be a uvec4"},
        {Format::Depth24, vec4(1), "graph: pass \"p\" clears \"t\" (Depth24) with a vec4; must be a float"},
        {Format::R16F, 0.0f, "graph: pass \"p\" clears \"t\" (R16F) with a float; must be a vec4"}};
    for (const auto& [format, value, message] : cases) {
        graph = FrameGraph();
        addWriter("p", [&](PassBuilder& pass) {
            const TextureId texture = graph.create("t", {.size = {4, 4}, .format = format});
            pass.write(texture);
            pass.clear(texture, value);
        });
        EXPECT_EQ(refusal(), message);
    }
}

TEST_F(FrameGraphTest, DumpNamesLayerAndLevelWhereThereAreSeveral) {
    const TextureId layers = graph.create("views.layers", kLayered);
    addWriter("peel", [&](PassBuilder& pass) { pass.write(layers, 2, 1); });
    addFinal({layers});
    ASSERT_EQ(refusal(), "");
    EXPECT_NE(graph.dump().find("      -> views.layers 4x4x3 RGBA16F, layer 2, level 1, 480 bytes\n"),
              std::string::npos)
        << graph.dump();
}

TEST_F(FrameGraphTest, DumpNamesReasonTargetSizeFormatAndBytes) {
    graph.addPass("views.surface", [&](PassBuilder& pass) -> Execute {
        pass.reason("the camera looks");
        pass.write(screen);
        return [](const Resources&, Commands&) {};
    });
    graph.keep(screen);
    ASSERT_TRUE(graph.compile().ok());
    EXPECT_EQ(graph.dump(), "  views.surface: the camera looks\n      -> screen 4x4 RGBA8, 64 bytes\n");
}

TEST(TextureDesc, BytesCountEveryLevelRoundedDown) {
    // 5x3 + 2x1 + 1x1 texels of 4 bytes
    EXPECT_EQ((TextureDesc{.size = {5, 3}, .format = Format::R32UI, .levels = 3}).bytes(),
              (15u + 2u + 1u) * 4u);
}

TEST(TextureDesc, BytesCountEveryLayerOfEveryLevel) {
    // (4x2 + 2x1) texels of 2 bytes, 5 times
    EXPECT_EQ((TextureDesc{.size = {4, 2}, .format = Format::R16F, .levels = 2, .layers = 5}).bytes(),
              (8u + 2u) * 2u * 5u);
}

TEST(TextureDesc, FormatsHaveNameBytesAndKind) {
    const struct {
        Format format;
        const char* name;
        int bytes; // channels times bits / 8
        Kind kind;
    } cases[] = {{Format::R16F, "R16F", 2, Kind::Half},
                 {Format::RG16F, "RG16F", 4, Kind::Half},
                 {Format::RGBA16F, "RGBA16F", 8, Kind::Half},
                 {Format::R32F, "R32F", 4, Kind::Float},
                 {Format::RG32F, "RG32F", 8, Kind::Float},
                 {Format::RGBA32F, "RGBA32F", 16, Kind::Float},
                 {Format::R32UI, "R32UI", 4, Kind::Integer},
                 {Format::RG32UI, "RG32UI", 8, Kind::Integer},
                 {Format::RGBA32UI, "RGBA32UI", 16, Kind::Integer},
                 {Format::RGBA8, "RGBA8", 4, Kind::Fraction},
                 {Format::Depth24, "Depth24", 4, Kind::Depth},
                 {Format::Depth32F, "Depth32F", 4, Kind::Depth}};
    for (const auto& [format, text, bytes, kind] : cases) {
        EXPECT_STREQ(name(format), text);
        EXPECT_EQ(bytesPerTexel(format), bytes) << text;
        EXPECT_EQ(kindOf(format), kind) << text;
    }
}

TEST(Indices, AreDestroyedOnceWhenMoved) {
    FakeDevice device;
    {
        const std::vector<std::uint32_t> three{0, 1, 2};
        Indices a(device, three, "a");
        Indices b = std::move(a);
        EXPECT_FALSE(a);
        EXPECT_EQ(b.count(), 3);
        EXPECT_EQ(device.indices.size(), 1u);
        b = Indices();
        EXPECT_EQ(device.indices.size(), 0u);
    }
}

TEST(Texture, IsDestroyedOnceWhenMoved) {
    FakeDevice device;
    {
        Texture a(device, kSmall, "a");
        Texture b = std::move(a);
        EXPECT_FALSE(a);
        EXPECT_TRUE(b);
        EXPECT_EQ(device.alive.size(), 1u);
        b = Texture();
        EXPECT_EQ(device.alive.size(), 0u);
    }
}

TEST_F(FrameGraphTest, StepsRunDrawsOneByOneAndRowsOfThoseThatFillTheirTarget) {
    const TextureId kept = graph.import(TextureHandle(77), {.size = {10, 7}}, "kept");
    graph.addPass("mixed", [&](PassBuilder& pass) -> Execute {
        pass.write(kept);
        pass.clear(kept, vec4(0));
        return [](const Resources&, Commands& commands) {
            commands.draw({.vertices = 36});
            commands.draw({});
            commands.draw({.region = {1, 2, 3, 4}});
        };
    });
    graph.keep(kept);
    ASSERT_TRUE(graph.compile().ok());
    std::vector<int> pixels;
    const auto same = [](const std::string&) { return 1.0; };
    std::vector<float> shares{graph.share(same)};
    while (const auto portion = graph.step(pool, [](const std::string&) { return 35; })) { // three rows
        EXPECT_EQ(portion->pass, "mixed");
        pixels.push_back(portion->pixels);
        shares.push_back(graph.share(same));
    }
    const std::vector<float> expected{0, 1 / 3.f, (1 + 3 / 7.f) / 3, (1 + 6 / 7.f) / 3, 2 / 3.f, 1};
    ASSERT_EQ(shares.size(), expected.size());
    for (std::size_t i = 0; i < shares.size(); ++i)
        EXPECT_FLOAT_EQ(shares[i], expected[i]) << i;
    EXPECT_EQ(pixels, (std::vector<int>{70, 30, 30, 10, 70}));
    ASSERT_EQ(device.draws.size(), 5u);
    const ivec2 rows[] = {{0, 0}, {0, 3}, {3, 6}, {6, 7}, {0, 0}};
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(device.draws[i].rows, rows[i]) << i;
        EXPECT_EQ(device.targets[i].colors[0].clear.has_value(), i == 0) << i; // once
    }
}

TEST_F(FrameGraphTest, StepsEndWhereExecuteEndsAndHoldNoTexture) {
    const TextureId a = addMaker("a");
    addFinal({addMaker("b", {a})});
    ASSERT_TRUE(graph.compile().ok());
    const auto all = [](const std::string&) { return 1 << 20; };
    const auto cost = [](const std::string& pass) { return pass == "a" ? 6.0 : 1.0; };
    ASSERT_TRUE(graph.step(pool, all).has_value());
    EXPECT_FLOAT_EQ(graph.share(cost), 6 / 8.f) << "of three passes that are as large";
    graph.abandon(pool);
    EXPECT_FALSE(graph.step(pool, all).has_value());
    pool.trim();
    pool.trim(); // what was not used since
    EXPECT_TRUE(device.alive.empty());

    FrameGraph whole;
    std::swap(graph, whole);
    screen = graph.import(TextureHandle::Screen, {.size = {4, 4}}, "screen");
    device.passes.clear();
    addFinal({addMaker("b", {addMaker("a")})});
    ASSERT_TRUE(graph.compile().ok());
    while (graph.step(pool, all)) {
    }
    EXPECT_EQ(device.passes, (std::vector<std::string>{"a", "b", "final"}));
    pool.trim();
    pool.trim();
    EXPECT_TRUE(device.alive.empty());
}

} // namespace
} // namespace lucent::graph
