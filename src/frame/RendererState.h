#pragma once
/// What a renderer holds. Private to this folder: each concern has its own file.
///   Stages.cpp    from few light samples to all: settings, stages, slices of work
///   Pacing.cpp    how passes reach the GPU, portion by portion
///   Phases.cpp    one picture's passes: what the guests draw, phase by phase
///   Surroundings.cpp  views from mirrors and refractive objects, for what the camera does not see
///   Display.cpp   from linear light to what is shown
///   Reprojection.cpp  the last picture as another camera sees it
///   Explain.cpp   what is drawn and why, in words
///   Renderer.cpp  the calls from outside

#include "frame/Budget.h"
#include "frame/Renderer.h"
#include "gl/Fence.h"
#include "graph/FrameGraph.h"
#include "light/Occlusion.h"
#include "shaders/frame/Blocks.h"
#include "technique/Guest.h"
#include "technique/Technique.h"
#include "views/SurfaceKey.h"
#include "views/Surroundings.h"

#include <chrono>
#include <deque>
#include <functional>
#include <optional>

namespace lucent::frame {

/// Milliseconds of a clock that only runs forward.
inline double nowMs() {
    using namespace std::chrono;
    return duration<double, std::milli>(steady_clock::now().time_since_epoch()).count();
}

// A picture is made in stages: a preview, more directions of the environment, all that its settings ask
// for, and then the same once for each further sample of the pixels. A stage is summed in slices that take
// about kSliceMs each; what is shown is the last complete stage, or the mean of the samples that are there.
struct Renderer::State {
    static constexpr double kSliceMs = 40;
    static constexpr double kCompileMs = 10; // to begin with programs, where other work follows
    static constexpr int kFirstStage = 20;   // directions
    static constexpr int kFewPixels = 64;    // of a preview, along its shorter side
    static constexpr int kStageFactor = 4;

    struct Stage {
        int directions; // of the environment
        bool baked;     // they only add to what a guest has worked out once
        bool coarse;    // all knobs are turned down
        int sample = 0; // of the pixels; 0: their middles
    };

    // One preview; previews, then all; all in slices; all at once.
    enum class Effort { Coarse, Progressive, Unseen, Final };

    struct Member {
        const technique::Technique* technique;
        std::unique_ptr<technique::Guest> guest;
    };
    // One picture's view of a scene, for the time of a slice. Not to be moved: it is made of references.
    struct Moment {
        scene::Scene scene; // with the settings that this picture is made with
        views::Eye eye;
        views::Drawables drawables;
        graph::TextureHandle environment = graph::TextureHandle::None;
    };

    // Passes that run portion by portion, and what they belong to.
    struct Running {
        Running(State& state, Moment of) : moment(std::move(of)), picture(state.pictureOf(moment)) {}
        enum class Work { Slice, Rest, Again } work = Work::Slice;
        Moment moment;
        technique::Picture picture;
        int end = 0;              // of the light samples that are summed
        double ms = 0;            // that it has taken
        bool isSubmitted = false; // the GPU has all of it
        graph::FrameGraph graph;
    };
    // Portions of passes that the GPU was given and has not finished.
    struct Batch {
        struct Part {
            std::string pass;
            int pixels;
        };
        std::vector<Part> parts;
        bool hasFirst;          // a pass that was never drawn: a driver may compile it now
        double begun, expected; // ms
        gl::Fence fence;
    };
    // What a pixel of a pass takes [ms], and how many of them were drawn at once.
    struct Cost {
        double perPixel;
        int pixels;
    };
    // What views from elsewhere share with the camera's.
    struct Supplies {
        Supplies(gl::Context& gl, graph::TexturePool& pool) : images(gl), waters(gl), shadows(pool) {}
        views::ImageCache images;
        views::Waters waters;
        views::KeptShadows shadows;
        std::map<std::string, Cost> costs; // by pass
    };
    // All but the camera that a picture depends on.
    struct SceneKey {
        std::string text;
        std::vector<views::ObjectKey> objects;
        std::vector<std::shared_ptr<const void>> maps;
        std::uint64_t waters;
        bool operator==(const SceneKey&) const = default;
    };
    // One picture from elsewhere: a face of a cube view, or a flat mirror's.
    struct Aside {
        int cube = -1, face = 0, flat = -1;
        bool second = false; // what the first objects hide
    };

    /// @param of  null: it has its own
    explicit State(gl::Context& gl, Supplies* of = nullptr);

    gl::Context& context;
    graph::TexturePool pool;
    std::unique_ptr<Supplies> own;
    Supplies& supplies;
    views::ImageCache& images;
    views::Waters& waters;
    views::KeptShadows& shadows;
    std::map<std::string, Cost>& costs;
    std::vector<Member> members;
    Budget budget;
    graph::Texture surface, shownSurface, shown, sum, scratch, lightTable, through;
    graph::Texture mean;  // over the pixels' samples; none where each has one
    graph::Texture other; // beside the picture
    graph::Texture depth; // of what is seen in the picture, m along eyeShown; 0: nothing
    views::Eye eyeShown;  // that it was drawn for: of all its samples
    // The last complete picture, where it was drawn smaller or the camera has moved since; until there is one
    // of the whole size.
    struct Kept {
        graph::Texture light, depth; // linear, 4 channels; as above, or none
        views::Eye eye;
    } kept;
    bool reprojected = false; // what present() showed last
    std::uint64_t otherNumber = 0;
    views::KeptTriangles triangles;          // of refractive objects,
    std::vector<views::ObjectKey> triangled; // as they stood
    std::uint64_t watersThen = 0;            // Waters::changes()

    // what the camera does not see
    views::Surroundings surroundings; // as drawn
    views::Surroundings beyondFlat;   // what flat mirrors' pictures are drawn with: its cubes
    graph::Texture aroundRadiance, aroundSolid, flatPictures;
    std::vector<int> facesShown;      // of each cube: as in views::Surroundings::faces, when all are drawn
    std::vector<Aside> asides;        // to be drawn before the stage's picture
    std::size_t asidesAsked = 0;      // how many they were,
    float asideShare = 0;             // and how much of the last one is drawn
    bool surveyed = false;            // they are known
    std::optional<SceneKey> cubesFor; // what the cubes were drawn for
    std::optional<std::pair<SceneKey, mat4>> flatFor;
    int flatDrawn = 0;                        // bits
    std::unique_ptr<State> elsewhere;         // draws them
    std::unique_ptr<scene::Scene> asideScene; // that it draws; null: none is begun
    std::uint64_t asideRevision = 0;
    bool keepsCubes = false; // of one that draws for others: whatever settings cubes were drawn with
    float shownAspect = 0;   // of such a one: width over height of the picture that its own stand for
    vec4 cut{0, 0, 0, 1};    // of such a one: Eye::cut
    vec2 shift{0};           // Eye::shift
    float threshold = 0;     // Eye::threshold of the first sample
    bool second = false;     // Eye::second
    ivec2 lightOf{0, 1};     // of such a one: sample of a pixel, and of how many, whose light samples it has
    const views::Surroundings* given = nullptr; // of such a one: what its pictures know of their surroundings
    bool allAround = false;                     // of such a one: technique::Picture::allAround
    std::size_t probesLeft = 0;                 // cubes that were asked for and are too many

    // the picture being made
    std::unique_ptr<const scene::Scene> pictured; // passes that run later point to its objects
    std::uint64_t revision = 0, scenery = 0;
    std::optional<SceneKey> sceneryFor;
    ivec2 size{0};   // in which it is drawn,
    ivec2 screen{0}; // and in which it is shown
    bool started = false, coarse = false;
    bool dragged = false;
    bool isNew = true;                     // nothing of this scene has been shown yet
    bool runs = false;                     // time, since the picture before
    bool coarseMeshes = false;             // its objects have fewer triangles than they are
    std::vector<views::ObjectKey> objects; // of the scene as it is
    int taken = 0;                         // objects that are on the GPU: see takeObjects()
    int rested = 0;                        // places of slice() up to which it has rested: see rests()
    bool atOnce = false;                   // nobody waits for a preview before the picture is complete
    float defaultError = 0;                // of scenes that ask for none
    bool planning = false;                 // the settings are still to be chosen
    bool composed = false;                 // the picture stands in `through`
    bool averaged = false;                 // what is shown stands in `mean`
    std::unique_ptr<Running> running;      // of this picture; null: nothing
    std::deque<Batch> submitted;           // the oldest first; of a picture before this one too
    double retired = 0, looked = 0;   // ms: when the last of them was done; when one was last seen not to be
    views::Readings readings;         // what guests have asked for this picture
    std::optional<gl::Fence> earlier; // of what was given up for this picture: the GPU may still draw it
    bool presentable = true;          // picture() is not being drawn into
    bool whole = false;               // a sample is complete, and not yet in the mean
    int sample = 0;                   // of the pixels, that is being drawn
    int samples = 0;                  // of this picture, that are shown
    bool surfaceDrawn = false, surfaceShown = false; // of this picture
    std::optional<views::SurfaceKey> shownKey;       // what shownSurface was drawn for
    std::vector<Stage> stages;
    std::size_t stage = 0;
    std::vector<views::LampPoint> lights; // of this stage, where hasLights;
    bool hasLights = false;               // else of one before
    int placed = 0;                       // so many of them have a place or a direction of their own
    int next = 0;                         // light
    technique::Guest* carrier = nullptr;  // that carried light in this sum
    double recordMs = 1;                  // that it took to record what is drawn for one of them
    double sliceMs = 0;                   // that the sum took
    double lightMs = 1, restMs = 1;       // of a pixel: one of them, and the rest, of the stage before
    double stageBegan = 0;                // ms: when its first pass did
    double wholeMs = 0;                   // that the last sample of the pixels took; 0: there is none
    Progress told;                        // what advance() said last
    double workMs = 0, planMs = 0;
    int drawsBefore = 0, passes = 0;
    Stats stats;

    // Reprojection.cpp
    views::Eye middleEyeOf(const scene::Scene& scene) const;
    bool isReprojected(const scene::Scene& scene) const;
    struct Reprojecting {
        const gl::Program *mesh, *background; // null: no environment is seen behind it
    };
    Reprojecting reprojecting(const scene::Scene& scene) const;
    Status recordDepth(const technique::Passes& passes);
    Status keep(const scene::Scene& scene);
    Status keepFor(const scene::Scene& next);
    Result<graph::TextureId> recordReprojected(graph::FrameGraph& graph, const scene::Scene& scene,
                                               const views::Eye& to);

    // Stages.cpp
    void start(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize, Effort effort);
    void startChoosing(const scene::Scene& scene);
    void addStages(const scene::Scene& scene, Effort effort, bool previewed);
    void addSamples(const scene::Scene& scene);
    Status plan(const scene::Scene& scene);
    Result<Progress> advance(const scene::Scene& scene, std::uint64_t newRevision, ivec2 newSize,
                             Effort effort);
    void makeTargets();
    bool variesLight(const scene::Scene& scene) const;
    int directionsOfSample(const scene::Scene& scene) const;
    void startStage();
    void placeLights(const scene::Scene& scene);
    Status slice(const scene::Scene& scene);
    Result<bool> ready(const Moment& moment);
    Status follow();
    Status showSum(Moment moment);
    Status finishStage(const Moment& moment);
    Status settle(const scene::Scene& scene);
    Status takeSample(const scene::Scene& scene);
    scene::Scene chosen(const scene::Scene& scene) const;
    // Whether what is drawn is no part of the picture. A preview of all its pixels at its own settings is.
    bool isCoarse() const {
        const bool isSmall = dragged && (!own || size != screen);
        return coarse || isSmall || (stage < stages.size() && stages[stage].coarse);
    }
    // Whether a preview was lowered to so few that its knobs are turned down further: the device is slow.
    bool hasFewPixels() const { return dragged && size != screen && std::min(size.x, size.y) <= kFewPixels; }
    technique::Guest* baker(const scene::Scene& scene) const;
    float work(const Stage& of) const;
    float restWorth() const;
    float shareOfStage(const scene::Scene& scene) const;
    Progress progressOf(const scene::Scene& scene, Effort effort) const;
    float aspect() const { return shownAspect > 0 ? shownAspect : float(size.x) / float(size.y); }
    bool complete() const { return started && !planning && stage >= stages.size(); }
    // A preview is not drawn again: the picture after it is.
    bool settled(Effort effort) const;
    int sliceEnd() const;

    // Pacing.cpp
    Status runGraph(const std::function<Status(graph::FrameGraph&)>& record);
    Status begin(std::unique_ptr<Running> made, Running::Work work,
                 const std::function<Status(Running&)>& record);
    Status work(double until);
    bool runSome(double until);
    std::size_t mostInFlight() const;
    Cost costOf(const std::string& pass) const;
    float shareOfRunning() const;
    void submit();
    void retire(double until);
    void drop();

    // Surroundings.cpp
    Status survey(const Moment& moment);
    void surveyCubes(const Moment& moment, std::vector<views::Probe> asked);
    void makeCubes(int side);
    void surveyFlat(const Moment& moment, std::vector<views::FlatMirror> asked);
    Result<bool> lookAround(const Moment& moment);
    scene::Scene sceneFor(const Moment& moment, const Aside& aside) const;
    Status keepAside(const scene::Scene& scene, const Aside& aside);
    SceneKey sceneKey(scene::Scene scene) const;
    SceneKey sceneryKey(scene::Scene scene) const; // whatever it is drawn with
    std::vector<std::string> aroundLines() const;

    // Phases.cpp
    int pixelSamples(const scene::Scene& scene) const;
    views::Eye eyeOf(const scene::Scene& scene) const;
    views::SurfaceKey surfaceKeyOf(const scene::Scene& scene) const {
        return views::surfaceKey(scene, eyeOf(scene), size, waters.changes());
    }
    Result<Moment> momentOf(const scene::Scene& scene);
    Result<Moment> readyMoment(const scene::Scene& scene);
    technique::Picture pictureOf(const Moment& moment) {
        return {.scene = moment.scene,
                .waters = waters,
                .eye = moment.eye,
                .size = size,
                .drawables = moment.drawables,
                .readings = readings,
                .environment = moment.environment,
                .surroundings = given ? given : &surroundings,
                .scenery = scenery,
                .allAround = fitsAll(),
                .isPreview = isCoarse()};
    }
    // Whether maps of light are fitted to all that there is: previews turn with the hand that drags.
    bool fitsAll() const { return allAround || isCoarse(); }
    // Whether pictures follow in which only the place of a sample in its pixel, the direction or, while it is
    // dragged, one light differs.
    bool repeats(const scene::Scene& scene) const { return fitsAll() || pixelSamples(scene) > 1; }
    bool rests(int place, double since);
    bool canPreview();
    Result<bool> takeObjects(const scene::Scene& scene);
    std::vector<technique::Guest*> needed(const scene::Scene& scene) const;
    technique::Guest* replacing(const technique::Picture& picture) const;
    bool replaces(const technique::Picture& picture) const;
    bool carriesEnvironment(const scene::Scene& scene) const;
    std::optional<light::FlatWaterBlock> bendingWater(const scene::Scene& scene) const;
    Result<bool> prepare(const technique::Picture& picture);
    Status recordSlice(graph::FrameGraph& graph, const technique::Picture& picture, int end);
    Status recordLight(const technique::Passes& passes, graph::TextureId target, int end);
    Status recordRest(graph::FrameGraph& graph, const technique::Picture& picture);
    Status recordBackground(const technique::Passes& passes, graph::TextureId shownId,
                            graph::TextureId target);
    Result<views::Drawables> poseKeeping(graph::FrameGraph& graph, const technique::Picture& picture);
    Status beginRest(Moment moment, Running::Work work);
    Status recordMean(graph::FrameGraph& graph, graph::TextureId target);

    std::vector<std::string> leftOut(const technique::Picture& picture) const;
    Result<Image> display(const scene::Scene& scene, bool linear);
    const gl::Program* displayProgram(bool linear, bool composes) const;
    const gl::Program* scaledProgram() const { return context.program("frame/scaled"); }
    Status recordDisplay(graph::FrameGraph& graph, const scene::Scene& scene, graph::TextureId target,
                         bool linear, const views::Eye* from = nullptr);
    void recordScaled(graph::FrameGraph& graph, graph::TextureId small, graph::TextureId target);
    Status recordBeside(graph::FrameGraph& graph, const scene::Scene& scene, const Beside& beside);
    void takeOther(const Beside& beside);
    const graph::Texture& picture() const { return composed ? through : shown; }
    const graph::Texture& finished() const { return averaged ? mean : picture(); }
    graph::TextureId importScreen(graph::FrameGraph& graph) const {
        return graph.import(graph::TextureHandle::Screen, {.size = screen, .format = graph::Format::RGBA8},
                            "screen");
    }
    static graph::TextureId import(graph::FrameGraph& graph, const graph::Texture& texture) {
        return graph.import(texture.handle(), texture.desc(), texture.label());
    }
};

/// How shaders look up the environment that stands behind a picture.
BackgroundBlock backgroundBlock(const scene::Environment& light, const views::Eye& eye, ivec2 size);

} // namespace lucent::frame
