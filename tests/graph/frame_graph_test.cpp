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
    void runPass(const PassTarget& target, const std::function<void(Commands&)>& body) override {
        struct Nothing : Commands {
            void draw(const Draw&) override {}
        } commands;
        passes.push_back(std::string(target.label));
        targets.push_back(target.colors.front());
        body(commands);
    }
    std::uint32_t last = 0;
    std::set<std::uint32_t> alive;
    std::vector<std::string> passes;
    std::vector<TextureHandle> targets;
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
    EXPECT_EQ(device.targets[0], device.targets[2]);
    EXPECT_NE(device.targets[0], device.targets[1]);
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

} // namespace
} // namespace lucent::graph
