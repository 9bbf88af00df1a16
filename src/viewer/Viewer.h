#pragma once
/// What a person does with a scene: look, drag the light, turn knobs. No window system: events come in as
/// plain values, pictures go to the default framebuffer.

#include "base/File.h"
#include "frame/Renderer.h"
#include "gl/ImGuiHost.h"
#include "scene/Scene.h"

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lucent::viewer {

enum class PointerEvent { Down, Move, Up, Leave };
struct Modifiers {
    bool shift = false, control = false, alt = false;
};

/// One viewer on a page. The GL context and its ImGui host are the page's and outlive it.
class Viewer {
public:
    Viewer(gl::Context& context, gl::ImGuiHost& imgui);
    ~Viewer();

    /// Loads a scene file through `read`. On error the scene that was showing stays and the message is shown
    /// on the canvas until dismissed.
    Status load(const std::string& path, const ReadFile& read);
    /// The same step by step; another that begins ends this one.
    void beginLoad(const std::string& path, const ReadFile& read);
    /// Works on for some `ms`. @return nothing while there is more to do
    std::optional<Status> advanceLoad(double ms);
    /// A picture becomes the environment of the scene that is showing.
    Status openEnvironment(const std::string& name, std::span<const std::byte> bytes);
    /// Shows what another viewer shows, as it stands now, with steps and controls of its own: for pictures of
    /// other sizes. What drops have left on water is not taken over.
    void copy(const Viewer& other);
    /// Counts the scenes that were shown: another number is another scene, not one that was changed.
    int sceneNumber() const;
    /// Error that pictures are drawn to on this device where the scene and its person ask for none, [0,1); 0:
    /// they are drawn in full.
    void setAutomaticError(float error);
    /// Objects are drawn without what techniques work out once for them until takeBake() brings it; stats()
    /// says what is missing. Otherwise it is worked out in draw(), which takes that long.
    void setBakesElsewhere(bool elsewhere);
    /// Files of a scene of the object of which something is missing, "scene.json" first; none: nothing is.
    std::vector<std::pair<std::string, Bytes>> askBake() const;
    /// What technique::Baker::bake() made of that. @param work  as stats() named it; an Error where that is
    /// no longer what is missing, or the file is of something else
    Status takeBake(const std::string& work, std::span<const std::byte> file);
    /// Shows a message over the picture ("" removes it).
    void showMessage(const std::string& message);

    /// Framebuffer size in pixels and pixels per CSS pixel.
    void resize(ivec2 pixels, float scale);
    void setPanelVisible(bool visible);
    /// Bare: nothing stands over the picture, neither light dots nor the brush's ring, costs, help or
    /// messages.
    void setBare(bool bare);
    void setDark(bool dark);

    /// Draws if something changed or the picture is not complete. @return true when another call is wanted
    bool draw(double nowSeconds);
    enum class Between { Nothing, More, Picture };
    /// Works on the picture between two calls of draw(), which shows what is there: what waited for the GPU
    /// goes on at once. @return whether another call is of use before the next draw(), or a picture waits for
    /// that
    Between work();
    /// Ends the work on the picture with what there is of it, until something changes. @return whether there
    /// was any work that has shown something
    bool stop();
    /// Number of times something was really drawn since the start: an idle page must not raise it.
    int drawCount() const;

    /// Pointer in CSS pixels from the top left corner. @return true when the viewer used the event
    ///
    /// Over a relief a drag moves the light whose dot is nearest (a distant light turns). While the
    /// environment shines, a drag turns it, with Alt or the right button about z, and the light is gripped at
    /// its dot only. With Shift it leads the camera around its target. In a scene without height fields Shift
    /// swaps both: a drag is for the camera but at a light's dot, with Shift for the environment, else the
    /// light. On water it lets drops fall; there the camera is led with Control.
    ///
    /// While the mode is "paint" a drag on what is translucent paints with the brush of the parameters
    /// "paint.*", elsewhere and with Shift or Control it leads the camera.
    ///
    /// @param pressure  [0,1], of a pen
    bool pointer(PointerEvent event, vec2 position, int button, Modifiers modifiers, bool touch,
                 float pressure = 1);
    /// Height of a relief's light; zoom with Control and where there is none to lift. @param delta CSS pixels
    bool wheel(vec2 position, float delta, Modifiers modifiers);
    bool pinch(float factor);
    /// A drop falls where a pixel shows water, and time runs. @return false where it shows none
    bool drop(vec2 position);
    /// `key` as in KeyboardEvent.key.
    bool key(const std::string& key, Modifiers modifiers);

    /// Parameters of the scene by path, as text; set() records an undo step (steps of one drag are merged).
    std::string get(const std::string& path) const;
    Status set(const std::string& path, const std::string& value);
    void reset(const std::string& path);
    bool undo();
    bool redo();
    /// Does what a button of the panel does, by its path in controls(). Error where that cannot be done now.
    Status act(const std::string& path);
    /// Marks one control of the panel: its DOM twin has the keyboard focus ("" for none).
    void focusControl(const std::string& path);

    /// JSON array of the controls in panel order: path, attribute, label, unit, group, doc, kind, components,
    /// min, max, low, high, logarithmic, choices, value, default (as loaded; both as text). An empty group:
    /// not in the panel. Buttons stand at the end: path, label, group, doc and the kind "action". The DOM
    /// twin is made from it.
    std::string controls();
    /// JSON: milliseconds, passes, draws, lights, bytes, complete, finished (complete, by all samples of its
    /// pixels), shown (there is a picture), canUndo, canRedo, open (CSS pixels
    /// from the upper left that neither panel nor numbers cover), downscale (pixels that one which was drawn
    /// stands for, along a side), progress (of work that takes long: task, share of that, secondsLeft where
    /// it is known), bake (technique, object, work: what setBakesElsewhere() leaves to others), pictures
    /// (shown so far, drawn or reprojected), reprojected (what is shown is the last picture, seen by a camera
    /// that has moved since), frames, revision; notDrawn: lines that say what the scene asks for, the picture
    /// lacks, and why; light: [x, y] of the chosen one's dot or arrow; lamps: place and outside (an arrow at
    /// the border stands for it) of all; panel: path -> [x, y, width, height] of each control's widget that
    /// can be seen in full. CSS pixels.
    std::string stats() const;
    /// JSON array: of each object that has subsurface scattering owner, profile; reach [mm] and whole (the
    /// share that leaves again) of red, green and blue; distances [mm] and values [1/mm²] of R_d; text, the
    /// same in words.
    ///
    /// @param numbers  false: owner and text alone, which take no time
    std::string profiles(bool numbers = true) const;
    /// JSON object path -> value of every parameter that differs from the loaded scene: what a link carries.
    /// Never "playing": whether things move is up to whoever follows the link.
    std::string changes() const;
    std::string sceneJson() const;

    /// Paints the strokes of a script on an object, as one undo step; "": the first that can be painted.
    Status paint(std::string_view script, const std::string& object = "");
    /// The script of all strokes on an object; "": the first that is painted, or an empty script.
    std::string strokes(const std::string& object = "") const;
    /// What is painted on an object, "": the first that is painted; null where nothing is.
    std::shared_ptr<const scene::Painting> painting(const std::string& object = "") const;

    /// While the parameter "playing" is on, which scenes have in which something moves, each draw() shows a
    /// later moment: view.time follows its clock.
    ///
    /// The parameters "compare" (off, truth, error, methods) and "divider" show another picture right of a
    /// divider. The picture keeps its size; the truth is shown at its own, and both are measured at that. A
    /// truth belongs to a scene: once that has changed, nothing is compared. "methods" shows the same scene
    /// with the settings "beside.technique..." and "beside.quality...", which begin as the scene has them.
    ///
    /// JSON: mode, divider, truth ("none", "stale", "fresh"), size and noise of the truth; of a finished
    /// picture rmse, relRmse, max, bias, p99, full (end of the error's scale), and with "methods" flip;
    /// milliseconds and passes of the picture; place: [x, y, width, height] of the other picture in CSS
    /// pixels; pixelsPerCssPixel; with "methods" left: what is set there, right: name and numbers.
    std::string comparison();
    /// The scene that is showing with all its images, as files: "scene.json" and what that names. Its truth
    /// comes back by takeComputedTruth().
    std::vector<std::pair<std::string, Bytes>> askTruth();
    /// Whether the techniques of this program show every object.
    bool drawsAll() const;
    /// Why the picture could not be drawn; "" where it could.
    std::string failure() const;
    /// The finished picture as linear values: the light, or the quantity that is shown. See Renderer::read().
    Result<Image> linear();
    /// The scene without changes(), but with the pictures that a person opened, as files like those of
    /// askTruth(): what a viewer of another program goes on with.
    std::vector<std::pair<std::string, Bytes>> pack() const;
    Status takeComputedTruth(const Image& picture, std::optional<double> noise);
    /// A file with the truth of the scene as it was loaded: linear values, PFM or another float picture.
    Status openTruth(const std::string& name, std::span<const std::byte> bytes, std::optional<double> noise);

    std::string title() const;
    std::string caption() const;
    const scene::Scene* scene() const;
    /// Changes whenever a parameter changed, by whatever road.
    std::uint64_t revision() const;

    /// Gives the GPU memory back; the next draw() makes the picture again.
    void release();
    /// Goes on with another context, after the old one was lost. Scene, undo steps and panel stay.
    void attach(gl::Context& context, gl::ImGuiHost& imgui);

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace lucent::viewer
