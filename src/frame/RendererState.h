#pragma once
/// What a renderer holds. Private to this folder: each concern has its own file.
///   Stages.cpp    from few lights to all: settings, stages, slices of work
///   Display.cpp   from linear light to what is shown
///   Explain.cpp   what is drawn and why, in words
///   Renderer.cpp  the calls from outside

#include "frame/Budget.h"
#include "frame/Compose.h"
#include "frame/GlassBudget.h"
#include "frame/Renderer.h"
#include "frame/SurfaceKey.h"
#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "techniques/brdf/Brdf.h"
#include "techniques/relief/Relief.h"
#include "techniques/relief/Transfers.h"

#include <functional>

namespace lucent::frame {

// A picture is made in stages: first with few directions of the environment, then with more. A stage is
// summed in slices that take about kSliceMs each; the last complete stage is what is shown.
struct Renderer::State {
    static constexpr double kSliceMs = 40;
    static constexpr int kFirstStage = 20; // directions
    static constexpr int kStageFactor = 4;
    static constexpr int kCoarseLampSamples = 4; // of a first look

    struct Stage {
        int directions; // of the environment
        bool transfer;  // they only light walls; the rest comes from the transfers
    };

    enum class Effort { Coarse, Progressive, Final }; // one first look; looks, then all; all at once

    explicit State(gl::Context& gl)
        : context(gl), pool(gl.device()), images(gl), relief(gl), brdf(gl), compose(gl, pool, images),
          transfers(gl), budget(gl, pool, images, relief), glassBudget(gl) {}

    gl::Context& context;
    graph::TexturePool pool;
    views::ImageCache images;
    relief::Relief relief;
    brdf::Brdf brdf;
    Compose compose;
    graph::Texture surface, shownSurface, shown, sum, scratch, lightTable;
    relief::Transfers transfers;
    Budget budget;
    GlassBudget glassBudget;
    std::optional<GlassBudget::Choice> glassChoice; // the same for what refracts and throws caustics
    std::optional<Budget::Choice> choice;           // the budget's, for the last picture that had one
    graph::Texture truth;                           // beside the picture
    std::uint64_t truthNumber = 0;

    // the picture being made
    std::uint64_t revision = 0;
    ivec2 size{0};
    bool started = false, coarse = false;
    bool dragged = false;
    bool atOnce = false;                             // nobody waits for a look before the picture is complete
    bool planning = false;                           // the settings are still to be chosen
    bool choosing = false;                           // by the budget of relief, too
    relief::Settings settings;                       // that this picture is made with
    bool composed = false;                           // the picture stands in compose.through()
    bool surfaceDrawn = false, surfaceShown = false; // of this picture
    std::optional<SurfaceKey> shownKey;              // what shownSurface was drawn for
    std::vector<Stage> stages;
    std::size_t stage = 0;
    std::vector<views::LampPoint> lights; // of this stage
    int placed = 0;                       // so many of them have a place or a direction of their own
    int next = 0;                         // light
    double msPerLight = 0;
    double workMs = 0, planMs = 0;
    int drawsBefore = 0, passes = 0;
    Stats stats;

    void start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize, Effort effort);
    void chooseSettings(const scene::Scene& scene, Effort effort);
    void addStages(const scene::Scene& scene, Effort effort);
    Status plan(const scene::Scene& scene);
    Result<Progress> advance(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                             Effort effort);
    void makeTargets();
    void startStage(const scene::Scene& scene);
    Result<bool> makeTransfers(const std::vector<views::DrawnObject>& objects);
    void lightTransfers(const scene::Scene& scene, const std::vector<views::DrawnObject>& objects);
    Result<bool> prepareTransfers(const scene::Scene& scene, const std::vector<views::DrawnObject>& objects);
    Status slice(const scene::Scene& scene);
    Status recordSlice(graph::FrameGraph& graph, const scene::Scene& scene, const views::Eye& eye,
                       const Drawn& drawn, int end);
    views::Sampling samplingOf(const scene::Scene& scene) const;
    Result<Posed> pose(graph::FrameGraph& graph, const scene::Scene& scene);
    static void recordClear(graph::FrameGraph& graph, graph::TextureId target);
    Status recordLight(graph::FrameGraph& graph, const scene::Scene& scene, const views::Eye& eye,
                       const Drawn& drawn, const Posed& posed, graph::TextureId surfaceId,
                       graph::TextureId targetId, int end);
    Result<std::vector<relief::Transferred>> recordTransferred(graph::FrameGraph& graph, const Drawn& drawn);
    Status addOthers(const scene::Scene& scene, const Drawn& drawn);
    Status settle(const scene::Scene& scene);
    Compose::Inputs composeInputs(const scene::Scene& scene, const views::Eye& eye,
                                  const Drawn& drawn) const {
        return {scene, eye, drawn, shownSurface, shown, coarse || dragged || stage + 1 < stages.size()};
    }
    // What quality.maxError chose, for people.
    std::string choiceText() const {
        const std::string relief = choice ? choice->text() : "",
                          glass = glassChoice ? glassChoice->text() : "";
        return relief + (choice && glassChoice ? "; " : "") + glass;
    }
    // The scene with the settings that this picture is made with.
    scene::Scene chosen(const scene::Scene& scene) const {
        return glassChoice ? glassChoice->applied(scene) : scene;
    }
    const graph::Texture& picture() const { return composed ? compose.through() : shown; }
    std::string leftOut(const scene::Scene& scene, const Drawn& drawn) const;
    Status runGraph(const std::function<Status(graph::FrameGraph&)>& record);
    Result<Image> display(const scene::Scene& scene, bool linear);
    Status recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene, graph::TextureId target,
                         bool linear);
    Status recordBeside(graph::FrameGraph& graph, const scene::Scene& scene, const Beside& beside,
                        const graph::Texture& linear);
    void takeTruth(const Beside& beside);
    float work(const Stage& of) const;
    float shareOfStage() const;
    bool complete() const { return started && !planning && stage >= stages.size(); }
    // A quick look is not drawn again: the picture after it is.
    bool settled(Effort effort) const {
        return effort == Effort::Coarse || !composed || !compose.unsettled();
    }
    int sliceEnd() const;
    static graph::TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    }
};

} // namespace lucent::frame
