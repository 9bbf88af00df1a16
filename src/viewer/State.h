#pragma once
/// What a viewer holds. Private to this folder: each concern has its own file.
///   Baking.cpp    work that is done once for objects, elsewhere
///   Editing.cpp   the scene, its controls, undo
///   Hands.cpp     drags, wheel and keys on the picture
///   Panels.cpp    frames of ImGui
///   Pictures.cpp  work on the picture and the screen
///   Playing.cpp   time that runs
///   Comparing.cpp the picture beside another one, and what is said about both
///   Sides.cpp     what is drawn for the comparison alone
///   Counting.cpp  where the light of a caustic map went
///   PaintPanel.cpp  strokes of the pointer, the brush's ring and buttons

#include "scene/Load.h"
#include "technique/Technique.h"
#include "viewer/Compare.h"
#include "viewer/History.h"
#include "viewer/Interaction.h"
#include "viewer/Mode.h"
#include "viewer/Overlays.h"
#include "viewer/Painter.h"
#include "viewer/Playing.h"
#include "viewer/Report.h"
#include "viewer/Viewer.h"

#include <imgui.h>

#include <array>
#include <chrono>
#include <set>

namespace lucent::viewer {

/// Seconds of a clock that only runs forward.
inline double secondsNow() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

struct Viewer::State {
    State(gl::Context& gl, gl::ImGuiHost& host) : context(&gl), imguiHost(&host) {}

    // What the pointer has gripped, and how things were then: drags add up without drift.
    enum class Grip { None, Light, Map, Roll, Orbit, Divider, Water, Paint };
    // The picture: a preview first, so that something is seen while a hand moves; then the fine one, and
    // that by more samples of each pixel.
    enum class Phase { Preview, Refine, Smooth, Done };

    gl::Context* context;
    gl::ImGuiHost* imguiHost;
    ImGuiContext* imgui = nullptr;
    std::unique_ptr<scene::Loading> loading;   // of the scene that comes next
    std::unique_ptr<scene::Scene> coming;      // read, and not yet shown
    std::size_t bounded = 0;                   // its objects whose bounds are known
    std::unique_ptr<frame::Renderer> renderer; // made when first drawn

    std::unique_ptr<scene::Scene> scene;
    std::vector<Control> controls; // of the scene
    std::map<std::string, std::string> loaded;
    std::set<std::string> offered; // paths that the panel has shown: what is offered once stays
    History history;
    std::uint64_t revision = 0, gesture = 1;
    std::uint64_t content = 0; // changes of anything but the camera
    std::string burstPath;
    double burstTime = -1e9;

    ivec2 pixels{0};
    float scale = 1;
    bool dark = false;
    Panel panel;
    std::string message, focus;
    bool help = false, showStats = false, touch = false;
    bool bare = false;   // nothing stands over the picture
    int sceneNumber = 0; // of scenes that were adopted
    std::string failure; // why the picture could not be drawn

    scene::Scene picture; // what is being drawn: the scene as it was when this picture began
    std::uint64_t pictureNumber = 0;
    std::uint64_t pictureContent = 0, shownContent = 0; // `content` of what is being drawn; of what is shown
    std::uint64_t paintedRevision = 0;                  // of the camera that it is shown for
    ivec2 picturePixels{0};
    Phase phase = Phase::Done;
    int samples = 0;        // of each pixel of what is shown
    int stage = 0;          // frame::Progress::stage of what is shown
    int downscale = 1;      // of previews, see frame::Renderer::advance()
    double previewTook = 0; // s: smoothed over those with as many pixels; 0: there is none
    bool isTypical = true;  // of a preview: nothing is drawn that later ones keep
    double phaseBegan = 0;  // s: of a preview, and then of what follows it
    // What is done on the picture now: since when [s], how much was done then, how much is, and since when.
    struct {
        frame::Task task = frame::Task::Settings;
        double began = 0;
        std::optional<float> first; // none: nothing was done since
        float share = 0;
        double grown = 0;
    } work;
    bool stopping = false;                          // no more work on this picture
    std::optional<DrawingProgress> drawingProgress; // of work that takes long
    bool stale = false, shown = false;              // the scene changed since; there is a picture to present
    bool unseen = false;                            // work() has left a new picture
    std::vector<Figure> figures;
    std::uint64_t figuresAt = 0; // revision whose they are
    bool figuresPend = false;    // some are still to come
    bool pictureNext = false;    // the panel's turn took its time
    int shownScene = 0;          // sceneNumber of what is shown
    std::vector<Figure> allFigures() const;
    bool settled = true; // ImGui has nothing new to say
    int settling = 0;    // frames since it had
    std::uint64_t shownHash = 0,
                  lastFrame = 0; // of frames of ImGui: what is shown; the last one of those that settle
    int drawCount = 0;
    int pictureCount = 0; // of those that showed another picture, drawn or reprojected
    double frameTime = 0, hoverTime = 0;
    std::string hovered, tooltip;

    // A gesture at a computed value: whose, and what it began with.
    struct Began {
        std::string path;
        std::uint64_t step = 0, revision = 0;
        std::vector<scene::Material> materials;
    } began;

    ModeSettings mode;
    float automaticError = 0; // see Viewer::setAutomaticError()
    PlaySettings play;
    double lastDraw = 0, due = 0; // s: of the page's clock; time that passed since the picture's moment
    std::optional<float>
        dropTime; // s: of the first drop that a person let fall; water then shows what no file knows

    technique::Balance balance; // of the caustic map that is shown
    std::uint64_t energyOf = 0; // picture that was measured

    CompareSettings compare;
    std::optional<Truth> truth;
    std::uint64_t freshAt = 0;         // revision at which `fresh` was found, 0: not yet
    bool fresh = false;                // the truth shows the scene as it is now
    std::optional<scene::Scene> right; // whose settings or materials the right side has
    // What is drawn for the comparison alone, and of which picture.
    struct Side {
        Image image; // linear; empty: it could not be drawn
        std::uint64_t of = 0;
        std::optional<measure::Metrics> numbers;
    };
    Side other;                             // the right side of Methods and of Materials
    std::array<Side, 2> measured;           // both of them, at the truth's size
    Image error;                            // of the left one
    std::unique_ptr<frame::Renderer> sides; // draws them
    std::uint64_t sideNumber = 0;           // of what it draws
    Side* drawing = nullptr;
    const Image* besideShown = nullptr;
    std::uint64_t besideNumber = 0;       // changes when what stands right of the divider does
    std::optional<scene::Scene> asLoaded; // whose truth lies in files
    std::optional<scene::Scene> asked;    // whose truth is being computed

    // What a technique is to work out once for an object of a scene.
    struct MissingBake {
        const technique::Technique* technique;
        std::string work; // tells it from other work
        scene::Scene scene;
        std::size_t object;
    };
    bool bakesElsewhere = false; // see Viewer::setBakesElsewhere()
    std::optional<MissingBake> missingBake;

    PaintSettings paintSettings, paintDefaults;
    Painter painter;
    std::optional<Picking> picking; // of the scene as it stands
    std::uint64_t pickingOf = 0;    // revision that it shows
    vec2 pickingSize{0};
    std::size_t paintObject = 0; // under the open stroke
    int paintBefore = 0;         // strokes on it
    vec2 dabAt{0};               // pixel of the last dab
    float pressure = 1, dabPressure = 1;
    vec2 hoverAt{-1};

    bool held = false;
    Grip grip = Grip::None;
    vec2 gripStart{0};
    std::size_t light = 0;   // the light that drags, wheel and keys move
    bool fromBorder = false; // it was gripped at its arrow: it comes to the hand
    scene::Camera gripCamera;
    vec3 gripValue{0};

    // --- sizes
    vec2 canvas() const { return vec2(pixels) / scale; }
    vec2 pictureSize() const { return glm::max(panel.pictureSize(canvas()), vec2(1)); }
    vec2 openSize() const { return panel.openSize(canvas()); }
    scene::Camera seenCamera() const { return framed(scene->camera, scene->size, pictureSize()); }
    Lens lens() const { return Lens(seenCamera(), pictureSize()); }

    // --- scene
    void adopt(scene::Scene newScene);
    void bind();
    void shineBy(const std::string& source, std::shared_ptr<const Image> map);
    Lighting lighting() const;
    void relight(const Lighting& lit);
    void beginLightingAnew();
    void offer(BoundParam bound, const std::string& before);
    void offerOfView(BoundParam bound);
    std::vector<BoundParam> bindView();
    const Control* find(const std::string& path) const;
    Status change(const std::string& path, const std::string& value, std::uint64_t step);
    void beginAt(const std::string& path, std::uint64_t step);
    std::vector<scene::Material> materials() const;
    void setMaterials(const std::vector<scene::Material>& list);
    void reset(const std::string& path);
    void offerChoices(Control& control) const;
    Status changeRight(const std::string& path, const std::string& value);
    Status changeView(const BoundParam& bound, const std::string& value);
    void assign(const void* member, vec3 value);
    void assign(const void* member, float value);
    void apply(const std::vector<Change>& changes, bool back);
    std::uint64_t burst(const std::string& path);
    void changed(bool isCamera = false);

    // --- lights and gestures
    bool mapShines() const { return scene->environment && scene->environment->enabled; }
    bool inMapMode() const { return mapShines() && scene->lights.empty(); }
    bool hasField() const;
    // Where a light stands; null when there is no such light, or a distant one.
    const vec3* lightPlace(std::size_t index) const {
        return index < scene->lights.size() ? placeOf(scene->lights[index]) : nullptr;
    }
    LightHandle handleOf(std::size_t index) const {
        return viewer::handleOf(scene->lights[index], lens(), openSize());
    }
    float pickLight(vec2 position);
    bool nextLight();
    Grip gripAt(vec2 position, int button, Modifiers modifiers);
    void startGrip(Grip wanted, vec2 position);
    void drag(vec2 position);
    void moveLight(vec2 from, vec2 to, vec2 turns);
    void nearer(float factor);
    void lift(float factor);
    void zoom(float factor);
    void resetPose();
    bool fall(WaterPlace place, float depth = 0.3f);
    bool fallInTheMiddle();
    void nextCompareMode();
    bool toggleMatt();
    bool shortcut(const std::string& key, Modifiers modifiers);
    bool arrow(vec2 step, Modifiers modifiers);

    // --- paint
    bool painting() const { return scene && mode.mode == paintMode() && !divided(); }
    std::optional<PaintPlace> paintPlaceAt(vec2 position);
    bool startStroke(vec2 position);
    void dabTo(vec2 position);
    void dabOnce(vec2 position, float withPressure);
    void endStroke();
    void noteUndrawn(const scene::Stroke& stroke);
    void painted();
    bool preparePaint();
    Status addStrokes(std::size_t object, std::span<const scene::Stroke> strokes);
    void fillWith(const scene::Brush& brush);
    std::span<const Action> actions() const;
    Status act(std::string_view path);
    bool paintKey(const std::string& key);
    void paintOverlay();

    void leaveOutMissing(scene::Scene& drawn);

    // --- time
    void tick(double now);
    bool togglePlaying();

    // --- another picture beside it
    // Whether the picture ends at a divider.
    bool divided() const {
        return scene && (drawsRight(compare.mode) || (truth && compare.mode != CompareMode::Off));
    }
    bool truthIsFresh();
    void takeTruth(Truth newTruth);
    void dropTruth();
    Rect besidePlace() const;
    float dividerPlace() const;
    void moveDivider(float x);
    const Image* besideImage();
    std::optional<frame::Beside> beside();
    std::string besideName();
    std::string differenceText(bool ofRight) const;
    std::string numbersText(const measure::Metrics& numbers) const;
    std::string compareText();
    void compareOverlay();
    std::optional<float> cardTop; // CSS pixels: of numbers at the bottom of the picture
    ComparisonReport comparison();
    Side* nextSide();
    scene::Scene sceneOf(const Side& side);
    void drawSides();
    void finishSide(Side& side);
    void dropSides();
    void measureEnergy();
    std::string energyText() const;
    void energyOverlay();

    // --- ImGui
    void frame();
    void overlays();
    void settle(double until);
    void mouse(vec2 position) { ImGui::GetIO().MousePos = {position.x, position.y}; }
    void typeKey(const std::string& key, Modifiers modifiers);
    void useImGui(Modifiers modifiers);
    double tooltipWait(double now);
    std::uint64_t frameHash() const;

    // --- drawing
    bool advance();
    void begin();
    int mostDownscale() const;
    void learnDownscale(double took);
    void estimate(const frame::Progress& progress);
    std::optional<scene::Camera> movedCamera() const;
    Status paint();
    // While time runs, a picture is as good as the next moment lets it be.
    bool complete() const {
        const bool seen = play.playing && phase == Phase::Refine && shown;
        return scene && !stale && (phase == Phase::Smooth || phase == Phase::Done || seen);
    }
    float defaultError() const { return mode.accuracy == Accuracy::Automatic ? automaticError : 0; }
    bool canPresent() const { return !renderer || renderer->canPresent(); }
    // A hand is on a picture that a preview shows.
    bool rests() const { return (phase == Phase::Refine || phase == Phase::Smooth) && held && canPresent(); }
    bool working() { return scene && (stale || (phase != Phase::Done && !rests()) || nextSide()); }
};

} // namespace lucent::viewer
