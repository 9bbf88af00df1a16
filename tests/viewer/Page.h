#pragma once
/// A page around one viewer: a canvas, files in memory, a person's hands.

#include "tests/support/Gl.h"
#include "tests/viewer/Scenes.h"
#include "tests/viewer/Window.h"
#include "viewer/Viewer.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <optional>

namespace lucent::viewer {

class Page : public support::GlTest {
protected:
    void SetUp() override {
        GlTest::SetUp();
        if (!context) return;
        host = std::make_unique<gl::ImGuiHost>(*context);
        open({800, 400});
    }
    void TearDown() override {
        viewer.reset();
        host.reset();
        GlTest::TearDown();
        window.reset();
    }

    /// A fresh viewer on a canvas of this size in CSS pixels.
    void open(ivec2 size, float scale = 1) {
        viewer.reset();
        window.reset();
        window.emplace(ivec2(vec2(size) * scale));
        ASSERT_TRUE(window->ok());
        viewer = std::make_unique<Viewer>(*context, *host);
        viewer->resize(ivec2(vec2(size) * scale), scale);
    }

    /// The same canvas with a sixteenth of its pixels: for what asks for values, not for pixels.
    void openCoarse() { open({800, 400}, 0.25f); }

    static ReadFile files(std::string scene) { return sceneFiles(std::move(scene)); }
    static Bytes wave() { return waveMap(); }
    void load(const char* scene) {
        const Status loaded = viewer->load("scene.json", files(scene));
        ASSERT_TRUE(loaded.ok()) << loaded.error().message;
        settle();
    }

    /// How long a wait may take, in true seconds: frames follow each other faster here than on a screen, and
    /// what they wait for takes its time.
    struct Deadline {
        bool passed() const { return std::chrono::steady_clock::now() > end; }
        std::chrono::steady_clock::time_point end =
            std::chrono::steady_clock::now() + std::chrono::minutes(2);
    };

    /// Draws until the viewer wants no more frames.
    void settle() {
        const Deadline deadline;
        while (viewer->draw(time += 0.02))
            ASSERT_FALSE(deadline.passed());
    }

    void move(vec2 at, Modifiers modifiers = {}) {
        viewer->pointer(PointerEvent::Move, at, 0, modifiers, false);
    }
    bool down(vec2 at, Modifiers modifiers = {}) {
        return viewer->pointer(PointerEvent::Down, at, 0, modifiers, false);
    }
    void up(vec2 at) { viewer->pointer(PointerEvent::Up, at, 0, {}, false); }
    void click(vec2 at) {
        move(at);
        down(at);
        up(at);
        settle();
    }
    void drag(vec2 from, vec2 to, Modifiers modifiers = {}) {
        move(from);
        down(from, modifiers);
        for (int i = 1; i <= 4; ++i) {
            move(glm::mix(from, to, float(i) / 4), modifiers);
            viewer->draw(time += 0.02);
        }
        up(to);
        settle();
    }

    vec3 vector(const std::string& path) const {
        vec3 value{std::nanf("")};
        std::sscanf(viewer->get(path).c_str(), "%f %f %f", &value.x, &value.y, &value.z);
        return value;
    }
    float number(const std::string& path) const { return std::strtof(viewer->get(path).c_str(), nullptr); }
    nlohmann::json stats() const { return nlohmann::json::parse(viewer->stats()); }
    vec2 dot() const { return {stats()["light"][0].get<float>(), stats()["light"][1].get<float>()}; }

    std::unique_ptr<gl::ImGuiHost> host;
    std::optional<Window> window;
    std::unique_ptr<Viewer> viewer;
    double time = 0;
};

/// Pixels of which a channel differs by more than a step of 8 bits.
inline int differences(const Image& a, const Image& b) {
    int count = 0;
    for (std::size_t i = 0; i < a.pixels.size(); i += 4) {
        bool differs = false;
        for (std::size_t c = 0; c < 4; ++c)
            differs = differs || std::abs(a.pixels[i + c] - b.pixels[i + c]) > 1.5f / 255;
        count += differs;
    }
    return count;
}

} // namespace lucent::viewer
