#include "viewer/Viewer.h"

#include "scene/Load.h"
#include "viewer/History.h"
#include "viewer/Interaction.h"
#include "viewer/Overlays.h"
#include "viewer/Report.h"

#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <chrono>
#include <cmath>

namespace lucent::viewer {

namespace {

// Chosen by eye or after what hands are used to.
constexpr float kDotReach = 24;         // CSS pixels around a light's dot that grip it
constexpr float kWheelFactor = 0.0015f; // a wheel step of 100 pixels: 16 %
constexpr float kKeyFactor = 1.1f;
constexpr float kKeyTurn = 5.0f / 180;           // half turns an arrow key
constexpr float kKeyMove = 0.02f;                // of the picture's height an arrow key
constexpr double kTooltipAfter = 0.5;            // s
constexpr double kBurst = 1;                     // s within which changes of one parameter are one step
constexpr float kWheelLine = 5 * measure::kText; // CSS pixels that ImGui scrolls for one unit of its wheel

double secondsNow() {
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

// Drags leave numbers that people can read: a tenth of what a pixel is worth, as a power of ten.
float rounded(float value, float pixelWorth) {
    const double step = std::pow(10.0, std::floor(std::log10(double(pixelWorth))) - 1);
    return float(std::round(value / step) * step);
}
vec3 rounded(vec3 value, float pixelWorth) {
    return {rounded(value.x, pixelWorth), rounded(value.y, pixelWorth), rounded(value.z, pixelWorth)};
}

// Keys that a text field of ImGui knows, by KeyboardEvent.key.
int textKey(std::string_view key) {
    struct Known {
        std::string_view name;
        ImGuiKey key;
    };
    static constexpr Known known[] = {{"ArrowLeft", ImGuiKey_LeftArrow},
                                      {"ArrowRight", ImGuiKey_RightArrow},
                                      {"Home", ImGuiKey_Home},
                                      {"End", ImGuiKey_End},
                                      {"Delete", ImGuiKey_Delete},
                                      {"Backspace", ImGuiKey_Backspace},
                                      {"Enter", ImGuiKey_Enter},
                                      {"Escape", ImGuiKey_Escape},
                                      {"a", ImGuiKey_A},
                                      {"c", ImGuiKey_C},
                                      {"v", ImGuiKey_V},
                                      {"x", ImGuiKey_X},
                                      {"y", ImGuiKey_Y},
                                      {"z", ImGuiKey_Z}};
    for (const Known& one : known)
        if (one.name == key) return one.key;
    return -1;
}

std::uint64_t mixed(std::uint64_t hash, const void* data, int bytes) { // FNV-1a
    const auto* at = static_cast<const unsigned char*>(data);
    for (int i = 0; i < bytes; ++i)
        hash = (hash ^ at[i]) * 1099511628211u;
    return hash;
}

// Tells whether a frame of ImGui looks like another one.
std::uint64_t hashOf(const ImDrawData& data) {
    std::uint64_t hash = 14695981039346656037u;
    for (int i = 0; i < data.CmdListsCount; ++i) {
        const ImDrawList& list = *data.CmdLists[i];
        hash = mixed(hash, list.VtxBuffer.Data, list.VtxBuffer.size_in_bytes());
        hash = mixed(hash, list.IdxBuffer.Data, list.IdxBuffer.size_in_bytes());
        for (const ImDrawCmd& command : list.CmdBuffer)
            hash = mixed(hash, &command.ClipRect, sizeof command.ClipRect);
    }
    return hash;
}

} // namespace

struct Viewer::State {
    State(gl::Context& gl, gl::ImGuiHost& host) : context(&gl), imguiHost(&host) {}

    // What the pointer has gripped, and how things were then: drags add up without drift.
    enum class Grip { None, Light, Map, Roll, Orbit };
    // The picture: a quick look first, so that something is seen while a hand moves; then the fine one.
    enum class Phase { Look, Refine, Done };

    gl::Context* context;
    gl::ImGuiHost* imguiHost;
    ImGuiContext* imgui = nullptr;
    std::unique_ptr<frame::Renderer> renderer; // made when first drawn

    std::unique_ptr<scene::Scene> scene;
    std::vector<Control> controls; // of the scene
    std::map<std::string, std::string> loaded;
    History history;
    std::uint64_t revision = 0, gesture = 1;
    std::string burstPath;
    double burstTime = -1e9;

    ivec2 pixels{0};
    float scale = 1;
    bool dark = false;
    Panel panel;
    std::string message, focus;
    bool help = false, showStats = false, touch = false;

    scene::Scene picture; // what is being drawn: the scene as it was when this picture began
    std::uint64_t pictureNumber = 0;
    ivec2 picturePixels{0};
    Phase phase = Phase::Done;
    bool stale = false, shown = false; // the scene changed since; there is a picture to present
    bool settled = true;               // ImGui has nothing new to say
    std::uint64_t shownHash = 0;
    int drawCount = 0;
    double frameTime = 0, hoverTime = 0;
    std::string hovered, tooltip;

    bool held = false;
    Grip grip = Grip::None;
    vec2 gripStart{0};
    std::size_t light = 0; // the light that drags, wheel and keys move
    scene::Camera gripCamera;
    vec3 gripValue{0};

    // --- sizes
    vec2 canvas() const { return vec2(pixels) / scale; }
    vec2 pictureSize() const { return glm::max(panel.pictureSize(canvas()), vec2(1)); }
    scene::Camera seenCamera() const { return framed(scene->camera, scene->size, pictureSize()); }
    Lens lens() const { return Lens(seenCamera(), pictureSize()); }

    // --- scene
    void adopt(scene::Scene newScene);
    void bind();
    const Control* find(const std::string& path) const;
    Status change(const std::string& path, const std::string& value, std::uint64_t step);
    void assign(const void* member, vec3 value);
    void assign(const void* member, float value);
    void apply(const std::vector<Change>& changes, bool back);
    std::uint64_t burst(const std::string& path);
    void changed();

    // --- lights and gestures
    bool mapShines() const { return scene->environment && scene->environment->enabled; }
    bool inMapMode() const { return mapShines() && scene->lights.empty(); }
    scene::PointLight* pointLight(std::size_t index) const {
        return index < scene->lights.size() ? std::get_if<scene::PointLight>(&scene->lights[index]) : nullptr;
    }
    std::optional<vec2> dotOf(std::size_t index) const;
    float pickLight(vec2 position);
    Grip gripAt(vec2 position, int button, Modifiers modifiers);
    void startGrip(Grip wanted, vec2 position);
    void drag(vec2 position);
    void moveLight(vec2 from, vec2 to, vec2 turns);
    void lift(float factor);
    void zoom(float factor);
    void resetPose();
    bool shortcut(const std::string& key, Modifiers modifiers);
    bool arrow(vec2 step, Modifiers modifiers);

    // --- ImGui
    void frame();
    void overlays();
    void settle();
    void mouse(vec2 position) { ImGui::GetIO().MousePos = {position.x, position.y}; }
    void typeKey(const std::string& key, Modifiers modifiers);
    void useImGui(Modifiers modifiers);
    double tooltipWait(double now);

    // --- drawing
    bool advance();
    Status paint();
    bool working() const {
        return scene && (stale || phase == Phase::Look || (phase == Phase::Refine && !held));
    }
};

// --- scene

void Viewer::State::changed() {
    ++revision;
    stale = true;
    settled = false;
}

void Viewer::State::adopt(scene::Scene newScene) {
    scene = std::make_unique<scene::Scene>(std::move(newScene));
    loaded.clear();
    history.clear();
    grip = Grip::None;
    light = 0;
    message.clear();
    bind();
    changed();
}

// The controls of the scene as it is now; a parameter met for the first time is as it was loaded.
void Viewer::State::bind() {
    controls.clear();
    for (BoundParam& bound : scene::bindParams(*scene)) {
        const auto found = loaded.emplace(bound.path, getText(*bound.param, bound.data)).first;
        controls.push_back({std::move(bound), found->second});
    }
}

const Control* Viewer::State::find(const std::string& path) const {
    const auto found = std::find_if(controls.begin(), controls.end(),
                                    [&](const Control& c) { return c.bound.path == path; });
    return found == controls.end() ? nullptr : &*found;
}

// The path may be an alias (an object's number), so what changed is found by looking.
Status Viewer::State::change(const std::string& path, const std::string& value, std::uint64_t step) {
    const auto textOf = [](const Control& c) { return getText(*c.bound.param, c.bound.data); };
    std::vector<std::string> before;
    for (const Control& control : controls)
        before.push_back(textOf(control));
    if (Status set = scene::setParam(*scene, path, value); !set) return set;
    bool any = false;
    for (std::size_t i = 0; i < controls.size(); ++i) {
        if (textOf(controls[i]) == before[i]) continue;
        history.record(step, {controls[i].bound.path, before[i], textOf(controls[i])});
        any = true;
    }
    if (!any) return Done{};
    bind(); // the projection decides what is bound
    changed();
    return Done{};
}

// Sets what a gesture moved. A value out of its range stays where it was: the end of the way has been
// reached.
void Viewer::State::assign(const void* member, vec3 value) {
    for (const Control& control : controls)
        if (control.bound.data == member) {
            (void)change(std::string(control.bound.path), getText(*control.bound.param, &value), gesture);
            return; // change() has bound the controls anew
        }
}

void Viewer::State::assign(const void* member, float value) { assign(member, vec3(value)); }

void Viewer::State::apply(const std::vector<Change>& changes, bool back) {
    for (const Change& one : changes)
        (void)scene::setParam(*scene, one.path, back ? one.before : one.after);
    bind();
    changed();
}

// Changes that do not come from a drag are one step while they keep to one parameter without a pause.
std::uint64_t Viewer::State::burst(const std::string& path) {
    const double now = secondsNow();
    if (!held && (path != burstPath || now - burstTime > kBurst)) ++gesture;
    burstPath = path;
    burstTime = now;
    return gesture;
}

// --- lights and gestures

std::optional<vec2> Viewer::State::dotOf(std::size_t index) const {
    const scene::PointLight* point = pointLight(index);
    return point ? lens().project(point->position) : std::nullopt;
}

// Chooses the point light whose dot is nearest. @return its distance in CSS pixels
float Viewer::State::pickLight(vec2 position) {
    float nearest = FLT_MAX;
    for (std::size_t i = 0; i < scene->lights.size(); ++i)
        if (const auto dot = dotOf(i); dot && glm::distance(*dot, position) < nearest) {
            nearest = glm::distance(*dot, position);
            light = i;
        }
    return nearest;
}

Viewer::State::Grip Viewer::State::gripAt(vec2 position, int button, Modifiers modifiers) {
    if (!scene || button == 1 || position.x > pictureSize().x) return Grip::None;
    if (modifiers.shift) return Grip::Orbit;
    const float distance = pickLight(position);
    const bool onDot = scene->view.lightDot && distance < kDotReach;
    const bool roll = modifiers.alt || button == 2;
    if (mapShines() && !onDot) return roll ? Grip::Roll : Grip::Map;
    return scene->lights.empty() || button == 2 ? Grip::None : Grip::Light;
}

void Viewer::State::startGrip(Grip wanted, vec2 position) {
    grip = wanted;
    gripStart = position;
    gripCamera = scene->camera;
    if (grip == Grip::Map || grip == Grip::Roll) gripValue = scene->environment->rotation;
    if (grip != Grip::Light) return;
    if (const scene::PointLight* point = pointLight(light))
        gripValue = point->position;
    else
        gripValue = std::get<scene::DistantLight>(scene->lights[light]).direction;
}

void Viewer::State::drag(vec2 position) {
    const vec2 size = pictureSize(), turns = (position - gripStart) / std::min(size.x, size.y);
    const float degree = 180 / std::min(size.x, size.y);
    switch (grip) {
    case Grip::None:
        break;
    case Grip::Light:
        moveLight(gripStart, position, turns);
        break;
    case Grip::Map:
    case Grip::Roll:
        assign(&scene->environment->rotation,
               rounded(turnedMap(gripValue, turns, grip == Grip::Roll), degree));
        break;
    case Grip::Orbit: {
        const float arm = glm::distance(gripCamera.eye, gripCamera.target);
        assign(&scene->camera.eye, rounded(orbited(gripCamera, turns), arm * glm::radians(degree)));
    }
    }
}

// From gripValue on, by pixels or (a distant light) by half turns.
void Viewer::State::moveLight(vec2 from, vec2 to, vec2 turns) {
    if (scene::PointLight* point = pointLight(light)) {
        const vec3 place = movedLight(lens(), gripValue, from, to);
        assign(&point->position, vec3(rounded(place, lens().metresPerPixel(place)).x,
                                      rounded(place, lens().metresPerPixel(place)).y, place.z));
        return;
    }
    auto& distant = std::get<scene::DistantLight>(scene->lights[light]);
    const float length = glm::length(gripValue);
    assign(&distant.direction, rounded(turnedLight(scene->camera, gripValue, turns), length * 0.01f));
}

void Viewer::State::lift(float factor) {
    scene::PointLight* point = pointLight(light);
    if (!point) return zoom(factor);
    const float z = liftedLight(point->position.z, factor);
    assign(&point->position, vec3(vec2(point->position), rounded(z, std::abs(z) * 0.01f)));
}

void Viewer::State::zoom(float factor) {
    const scene::Camera closer = zoomed(scene->camera, factor);
    if (closer.type == scene::Camera::Type::Orthographic)
        assign(&scene->camera.height, rounded(closer.height, closer.height * 0.01f));
    else
        assign(&scene->camera.eye, rounded(closer.eye, glm::distance(closer.eye, closer.target) * 0.001f));
}

// Camera, lights and the environment's rotation go back to how they were loaded, as one step.
void Viewer::State::resetPose() {
    ++gesture;
    const void* rotation = scene->environment ? &scene->environment->rotation : nullptr;
    const std::vector<Control> before = controls; // change() binds anew
    for (const Control& control : before) {
        const std::string& path = control.bound.path;
        if (path.starts_with("camera.") || path.starts_with("lights.") || control.bound.data == rotation)
            (void)change(path, control.loaded, gesture);
    }
}

bool Viewer::State::arrow(vec2 step, Modifiers modifiers) {
    const vec2 turns = step * kKeyTurn;
    if (modifiers.shift) {
        (void)burst("camera.eye");
        startGrip(Grip::Orbit, {});
        drag(turns * std::min(pictureSize().x, pictureSize().y));
    } else if (inMapMode()) {
        (void)burst("environment.rotation");
        startGrip(modifiers.alt ? Grip::Roll : Grip::Map, {});
        drag(turns * std::min(pictureSize().x, pictureSize().y));
    } else if (!scene->lights.empty()) {
        (void)burst("lights");
        startGrip(Grip::Light, pictureSize() / 2.0f);
        moveLight(gripStart, gripStart + step * kKeyMove * pictureSize().y, turns);
    }
    grip = Grip::None;
    return true;
}

bool Viewer::State::shortcut(const std::string& key, Modifiers modifiers) {
    if (key == "ArrowLeft") return arrow({-1, 0}, modifiers);
    if (key == "ArrowRight") return arrow({1, 0}, modifiers);
    if (key == "ArrowUp") return arrow({0, -1}, modifiers);
    if (key == "ArrowDown") return arrow({0, 1}, modifiers);
    const bool more = key == "PageUp" || key == "+" || key == "=", less = key == "PageDown" || key == "-";
    if (more || less) {
        const float factor = more ? kKeyFactor : 1 / kKeyFactor;
        (void)burst("lift");
        inMapMode() ? zoom(factor) : lift(factor);
        return true;
    }
    if (key == "0" || key == "Home") return resetPose(), true;
    return false;
}

// --- ImGui

void Viewer::State::useImGui(Modifiers modifiers) {
    ImGui::SetCurrentContext(imgui);
    ImGuiIO& io = ImGui::GetIO();
    io.KeyShift = modifiers.shift;
    io.KeyCtrl = modifiers.control;
    io.KeyAlt = modifiers.alt;
}

// One frame of ImGui: what was done in the panel takes effect, nothing is drawn yet.
void Viewer::State::frame() {
    if (pixels.x <= 0 || pixels.y <= 0) return;
    ImGui::SetCurrentContext(imgui);
    ImGuiIO& io = ImGui::GetIO();
    const double now = secondsNow();
    io.DeltaTime = float(std::clamp(now - frameTime, 1e-4, 1.0));
    frameTime = now;
    io.DisplaySize = {canvas().x, canvas().y};
    io.DisplayFramebufferScale = {scale, scale};
    fonts().select(scale);
    panel.setCanvas(canvas());

    ImGui::NewFrame();
    std::vector<Edit> edits;
    if (scene)
        edits = panel.draw(
            {.title = scene->title, .controls = controls, .focus = focus, .canvas = canvas(), .touch = touch},
            theme(dark));
    overlays();
    ImGui::Render();
    settled = false;
    for (const Edit& edit : edits)
        if (Status set = change(edit.path, edit.text, burst(edit.path)); !set) message = set.error().message;
}

void Viewer::State::overlays() {
    const vec2 size = pictureSize();
    if (scene && scene->view.lightDot) {
        ImDrawList& list = *ImGui::GetBackgroundDrawList();
        list.PushClipRect({0, 0}, {size.x, size.y});
        for (std::size_t i = 0; i < scene->lights.size(); ++i)
            if (const auto dot = dotOf(i)) drawLightDot(*dot, pointLight(i)->color);
        list.PopClipRect();
    }
    if (showStats && renderer) drawStats(renderer->stats(), size, theme(dark));
    if (help && drawHelp(size, theme(dark))) help = false;
    if (!message.empty() && drawMessage(message, size, theme(dark))) message.clear();
    if (const Control* control = find(tooltip); control && panel.hovered() == tooltip)
        drawTooltip(control->bound.param->doc, panel.hoveredPlace(), canvas(), theme(dark));
}

// ImGui lays out after what it measured in the frame before: frames until two are alike.
void Viewer::State::settle() {
    constexpr int kMostFrames = 5;
    std::uint64_t before = 0;
    for (int i = 0; i < kMostFrames; ++i) {
        frame();
        const std::uint64_t now = hashOf(*ImGui::GetDrawData());
        if (now == before) break;
        before = now;
    }
    settled = true;
}

void Viewer::State::typeKey(const std::string& key, Modifiers modifiers) {
    ImGuiIO& io = ImGui::GetIO();
    const bool isText =
        !modifiers.control && !key.empty() && (key.size() == 1 || (unsigned char)key[0] >= 0x80);
    if (isText) io.AddInputCharactersUTF8(key.c_str());
    const int special = isText ? -1 : textKey(key);
    for (const bool pressed : {true, false}) {
        if (special >= 0) io.KeysDown[special] = pressed;
        frame();
    }
}

// Shows a tooltip after a short rest on a control. @return seconds until then, 0 when nothing is awaited
double Viewer::State::tooltipWait(double now) {
    if (panel.hovered() != hovered) {
        hovered = panel.hovered();
        hoverTime = now;
        if (!tooltip.empty()) settled = false;
        tooltip.clear();
    }
    if (hovered.empty() || tooltip == hovered) return 0;
    if (now - hoverTime < kTooltipAfter) return kTooltipAfter - (now - hoverTime);
    tooltip = hovered;
    settled = false;
    return 0;
}

// --- drawing

// Works on the picture. A quick look is always finished before the next begins, so that a slow machine shows
// something while a hand moves. @return true when there is something new to present
bool Viewer::State::advance() {
    if (!scene) return false;
    const ivec2 size = glm::max(ivec2(glm::round(pictureSize() * scale)), ivec2(1));
    if (size != picturePixels) {
        picturePixels = size;
        shown = false;
        stale = true;
        phase = Phase::Done;
    }
    if (stale && phase != Phase::Look) {
        picture = *scene;
        picture.camera = seenCamera();
        ++pictureNumber;
        stale = false;
        phase = Phase::Look;
    }
    if (phase == Phase::Done || (phase == Phase::Refine && held)) return false;
    if (!renderer) renderer = std::make_unique<frame::Renderer>(*context);
    const Result<frame::Progress> progress =
        renderer->advance(picture, pictureNumber, size, phase == Phase::Look);
    if (!progress) {
        phase = Phase::Done;
        message = progress.error().message;
        settled = false;
        return false;
    }
    if (!progress->complete) return phase == Phase::Refine;
    phase = phase == Phase::Look ? Phase::Refine : Phase::Done;
    shown = true;
    if (showStats) settled = false;
    return true;
}

Status Viewer::State::paint() {
    imguiHost->clear(pixels.x, pixels.y);
    if (scene && shown)
        if (Status presented = renderer->present(picture); !presented) return presented;
    return imguiHost->draw(*ImGui::GetDrawData(), fonts().atlas, pixels.x, pixels.y);
}

// --- public

Viewer::Viewer(gl::Context& context, gl::ImGuiHost& imgui) : state_(std::make_unique<State>(context, imgui)) {
    State& s = *state_;
    s.imgui = ImGui::CreateContext(&fonts().atlas);
    ImGui::SetCurrentContext(s.imgui);
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    io.ConfigInputTextCursorBlink = false; // an idle viewer draws nothing
    for (int key = 0; key < ImGuiKey_COUNT; ++key)
        io.KeyMap[key] = key;
    applyTheme(theme(s.dark));
    s.frameTime = secondsNow();
}

Viewer::~Viewer() { ImGui::DestroyContext(state_->imgui); }

void Viewer::attach(gl::Context& context, gl::ImGuiHost& imgui) {
    release();
    state_->context = &context;
    state_->imguiHost = &imgui;
}

void Viewer::release() {
    state_->renderer.reset();
    state_->shown = false;
    state_->stale = state_->scene != nullptr;
    state_->phase = State::Phase::Done;
}

Status Viewer::load(const std::string& path, const ReadFile& read) {
    Result<scene::Scene> scene = scene::load(path, read, frame::techniques());
    if (!scene) {
        showMessage(scene.error().message);
        return scene.error();
    }
    state_->adopt(std::move(*scene));
    return Done{};
}

Status Viewer::openImage(const std::string& name, std::span<const std::byte> bytes, bool asEnvironment) {
    const Status opened = asEnvironment ? openEnvironment(name, bytes) : openHeights(name, bytes);
    if (!opened) showMessage(opened.error().message);
    return opened;
}

Status Viewer::openEnvironment(const std::string& name, std::span<const std::byte> bytes) {
    State& s = *state_;
    if (!s.scene) return Error{name + ": there is no scene to light; open a height map first"};
    auto map = scene::loadEnvironmentMap(name, bytes);
    if (!map) return map.error();
    if (!s.scene->environment) s.scene->environment.emplace();
    s.scene->environment->source = name;
    s.scene->environment->map = std::move(*map);
    s.scene->environment->enabled = true;
    s.message.clear();
    s.bind();
    s.changed();
    return Done{};
}

Status Viewer::openHeights(const std::string& name, std::span<const std::byte> bytes) {
    State& s = *state_;
    if (!s.scene || s.scene->objects.empty()) {
        Result<scene::Scene> scene = scene::sceneFromHeights(name, bytes, frame::techniques());
        if (!scene) return scene.error();
        s.adopt(std::move(*scene));
        return Done{};
    }
    scene::Object object = s.scene->objects.front();
    if (Status replaced = scene::replaceHeights(object, name, bytes); !replaced) return replaced;
    s.scene->objects.front() = std::move(object);
    s.message.clear();
    s.bind();
    s.changed();
    return Done{};
}

void Viewer::showMessage(const std::string& message) {
    state_->message = message;
    state_->settled = false;
}

void Viewer::resize(ivec2 pixels, float scale) {
    State& s = *state_;
    if (s.pixels == pixels && s.scale == scale) return;
    s.pixels = pixels;
    s.scale = scale;
    s.settled = false;
}

void Viewer::setPanelVisible(bool visible) {
    state_->panel.setVisible(visible);
    state_->settled = false;
}

void Viewer::setDark(bool dark) {
    state_->dark = dark;
    ImGui::SetCurrentContext(state_->imgui);
    applyTheme(theme(dark));
    state_->settled = false;
}

bool Viewer::draw(double nowSeconds) {
    State& s = *state_;
    if (s.pixels.x <= 0 || s.pixels.y <= 0) return false;
    ImGui::SetCurrentContext(s.imgui);
    double wait = s.tooltipWait(nowSeconds);
    if (!s.settled) s.settle(); // the panel decides the picture's size
    const bool isNew = s.advance();
    if (!s.settled) s.settle();
    wait = std::max(wait, s.tooltipWait(nowSeconds));
    const std::uint64_t hash = ImGui::GetDrawData() ? hashOf(*ImGui::GetDrawData()) : 0;
    const bool paintable = s.shown || !s.working(); // a new size waits for its first picture
    if (paintable && (isNew || hash != s.shownHash)) {
        if (Status painted = s.paint(); !painted) showMessage(painted.error().message);
        s.shownHash = hash;
        ++s.drawCount;
    }
    return s.working() || !s.settled || wait > 0;
}

int Viewer::drawCount() const { return state_->drawCount; }

bool Viewer::pointer(PointerEvent event, vec2 position, int button, Modifiers modifiers, bool touch) {
    State& s = *state_;
    s.useImGui(modifiers);
    s.touch = touch;
    ImGuiIO& io = ImGui::GetIO();
    const int imguiButton = button == 0 ? 0 : button == 2 ? 1 : 2;
    if (event == PointerEvent::Leave) {
        s.mouse(s.held ? position : vec2(-FLT_MAX));
        s.frame();
        return false;
    }
    s.mouse(position);
    s.frame(); // ImGui learns where the pointer is before it hears of buttons
    bool used = io.WantCaptureMouse || s.grip != State::Grip::None;
    if (event == PointerEvent::Down) {
        ++s.gesture;
        s.burstPath.clear();
        s.held = true;
        if (!io.WantCaptureMouse && s.scene) s.startGrip(s.gripAt(position, button, modifiers), position);
        used = io.WantCaptureMouse || s.grip != State::Grip::None;
        io.MouseDown[imguiButton] = true;
        s.frame();
    } else if (event == PointerEvent::Move && s.grip != State::Grip::None) {
        s.drag(position);
    } else if (event == PointerEvent::Up) {
        s.held = false;
        s.grip = State::Grip::None;
        io.MouseDown[imguiButton] = false;
        s.frame();
        ++s.gesture;
        s.burstPath.clear();
    }
    return used;
}

bool Viewer::wheel(vec2 position, float delta, Modifiers modifiers) {
    State& s = *state_;
    s.useImGui(modifiers);
    s.mouse(position);
    s.frame();
    if (ImGui::GetIO().WantCaptureMouse) {
        ImGui::GetIO().MouseWheel = -delta / kWheelLine;
        s.frame();
        return true;
    }
    if (!s.scene || position.x > s.pictureSize().x) return false;
    (void)s.burst("wheel");
    const float factor = std::exp(-delta * kWheelFactor);
    modifiers.control || s.inMapMode() ? s.zoom(factor) : s.lift(factor);
    return true;
}

bool Viewer::pinch(float factor) {
    State& s = *state_;
    if (!s.scene || !(factor > 0)) return false;
    (void)s.burst("pinch");
    s.zoom(factor);
    return true;
}

bool Viewer::key(const std::string& key, Modifiers modifiers) {
    State& s = *state_;
    s.useImGui(modifiers);
    if (s.panel.typing()) {
        s.typeKey(key, modifiers);
        return true;
    }
    s.settled = false;
    if (modifiers.control) {
        if (key == "y" || key == "Y" || ((key == "z" || key == "Z") && modifiers.shift)) return redo();
        return (key == "z" || key == "Z") && undo();
    }
    if (key == "h" || key == "H") return s.panel.setVisible(!s.panel.visible()), true;
    if (key == "f" || key == "F") return s.showStats = !s.showStats, true;
    if (key == "?") return s.help = !s.help, true;
    if (key == "Escape") {
        const bool any = s.help || !s.message.empty();
        s.help = false;
        s.message.clear();
        return any;
    }
    return s.scene && s.shortcut(key, modifiers);
}

std::string Viewer::get(const std::string& path) const {
    const Control* control = state_->find(path);
    return control ? getText(*control->bound.param, control->bound.data) : "";
}

Status Viewer::set(const std::string& path, const std::string& value) {
    if (!state_->scene) return Error{path + ": there is no scene; load one first"};
    return state_->change(path, value, state_->burst(path));
}

void Viewer::reset(const std::string& path) {
    if (const Control* control = state_->find(path)) (void)set(path, std::string(control->loaded));
}

bool Viewer::undo() {
    const std::vector<Change> changes = state_->history.undo();
    if (changes.empty()) return false;
    state_->apply(changes, true);
    return true;
}

bool Viewer::redo() {
    const std::vector<Change> changes = state_->history.redo();
    if (changes.empty()) return false;
    state_->apply(changes, false);
    return true;
}

void Viewer::focusControl(const std::string& path) {
    state_->focus = path;
    state_->settled = false;
}

std::string Viewer::controls() { return controlsJson(state_->controls); }

std::string Viewer::stats() const {
    const State& s = *state_;
    StatsInput input;
    if (s.renderer) input.cost = s.renderer->stats();
    input.complete = s.scene && !s.stale && s.phase == State::Phase::Done;
    input.frames = s.drawCount;
    input.revision = s.revision;
    if (s.scene && s.pixels.y > 0) input.light = s.dotOf(s.light);
    input.widgets = s.panel.widgets();
    return statsJson(input);
}

std::string Viewer::changes() const { return changesJson(state_->controls); }
std::string Viewer::sceneJson() const { return state_->scene ? scene::toJson(*state_->scene) : ""; }
std::string Viewer::title() const { return state_->scene ? state_->scene->title : ""; }
std::string Viewer::caption() const { return state_->scene ? state_->scene->caption : ""; }
const scene::Scene* Viewer::scene() const { return state_->scene.get(); }
std::uint64_t Viewer::revision() const { return state_->revision; }

} // namespace lucent::viewer
