#include "viewer/Viewer.h"
#include "technique/Technique.h"

#include "viewer/State.h"
#include "views/Eye.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <limits>
#include <utility>

namespace lucent::viewer {

namespace {

constexpr float kWheelFactor = 0.0015f;         // a wheel step of 100 pixels: 16 %
constexpr float kWheelLine = 5 * layout::kText; // CSS pixels that ImGui scrolls for one unit of its wheel
constexpr double kPanelSeconds = 0.02; // after which the panel leaves the picture no time in one call

} // namespace

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
    state_->sides.reset();
    state_->drawing = nullptr;
    state_->dropTime.reset();
    state_->shown = false;
    state_->stale = state_->scene != nullptr;
    state_->phase = State::Phase::Done;
}

Status Viewer::load(const std::string& path, const ReadFile& read) {
    beginLoad(path, read);
    return *advanceLoad(std::numeric_limits<double>::infinity());
}

void Viewer::beginLoad(const std::string& path, const ReadFile& read) {
    state_->loading = std::make_unique<scene::Loading>(path, read, technique::tables());
    state_->coming.reset();
}

std::optional<Status> Viewer::advanceLoad(double ms) {
    State& s = *state_;
    const double begin = secondsNow();
    if (!s.coming) {
        std::optional<Result<scene::Scene>> scene = s.loading->advance(ms);
        if (!scene) return std::nullopt;
        s.loading.reset();
        if (!*scene) {
            showMessage(scene->error().message);
            return Status(scene->error());
        }
        s.coming = std::make_unique<scene::Scene>(std::move(**scene));
        s.bounded = 0;
    }
    while (s.bounded < s.coming->objects.size()) { // the meshes that this makes stay with the objects
        views::boundsOf(s.coming->objects[s.bounded++]);
        if (1e3 * (secondsNow() - begin) > ms) return std::nullopt;
    }
    if (4e3 * (secondsNow() - begin) > ms) return std::nullopt; // to show it takes its time, too
    s.adopt(std::move(*std::exchange(s.coming, nullptr)));
    return Status(Done{});
}

Status Viewer::openEnvironment(const std::string& name, std::span<const std::byte> bytes) {
    State& s = *state_;
    const auto refuse = [&](const Error& error) {
        showMessage(error.message);
        return error;
    };
    if (!s.scene) return refuse({name + ": there is no scene to light; open a height map or a model first"});
    auto map = scene::loadEnvironmentMap(name, bytes);
    if (!map) return refuse(map.error());
    s.shineBy(name, std::move(*map));
    s.message.clear();
    s.bind();
    s.changed();
    return Done{};
}

void Viewer::copy(const Viewer& other) {
    const State& from = *other.state_;
    if (!from.scene) return;
    State& s = *state_;
    s.adopt(*from.scene);
    s.mode = from.mode;
    s.paintSettings = from.paintSettings;
    s.bind();
}

int Viewer::sceneNumber() const { return state_->sceneNumber; }

void Viewer::setAutomaticError(float error) { state_->automaticError = error; }

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

void Viewer::setBare(bool bare) {
    state_->bare = bare;
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
    s.tick(nowSeconds);
    double wait = s.tooltipWait(nowSeconds);
    const double begin = secondsNow();
    const auto settle = [&] {
        if (!s.settled) s.settle(begin + kPanelSeconds);
    };
    if (!s.pictureNext) settle(); // the panel decides the picture's size
    s.pictureNext = !s.pictureNext && secondsNow() - begin > kPanelSeconds;
    if (s.pictureNext) return true;
    const bool isNew = std::exchange(s.unseen, false) || s.advance();
    s.drawSides();
    s.measureEnergy();
    if (secondsNow() - begin < kPanelSeconds) settle();
    wait = std::max(wait, s.tooltipWait(nowSeconds));
    const std::uint64_t hash = s.frameHash();
    // A new size waits for its first picture, and no picture is shown that is being drawn into.
    const bool paintable = (s.shown && s.canPresent()) || !s.working();
    const bool moves = s.paintedRevision != s.revision && s.movedCamera();
    if (paintable && (isNew || moves || hash != s.shownHash)) {
        if (Status painted = s.paint(); !painted) showMessage(painted.error().message);
        s.shownHash = hash;
        s.paintedRevision = s.revision;
        ++s.drawCount;
        if (isNew || (moves && s.renderer->isReprojected())) ++s.pictureCount;
    }
    const bool isPrepared = s.preparePaint();
    return s.working() || !s.settled || wait > 0 || s.play.playing || !isPrepared;
}

Viewer::Between Viewer::work() {
    State& s = *state_;
    if (s.pixels.x <= 0 || s.pixels.y <= 0) return Between::Nothing;
    if (s.unseen) return Between::Picture;
    if (!s.settled || !s.working()) return Between::Nothing;
    ImGui::SetCurrentContext(s.imgui);
    s.unseen = s.advance();
    return s.unseen ? Between::Picture : s.working() ? Between::More : Between::Nothing;
}

bool Viewer::stop() {
    State& s = *state_;
    if (!s.shown || s.stale || s.phase == State::Phase::Done) return false;
    return s.stopping = true;
}

int Viewer::drawCount() const { return state_->drawCount; }

bool Viewer::pointer(PointerEvent event, vec2 position, int button, Modifiers modifiers, bool touch,
                     float pressure) {
    State& s = *state_;
    s.pressure = pressure;
    s.hoverAt = event == PointerEvent::Leave ? vec2(-1) : position;
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
        if (s.grip == State::Grip::Paint) s.endStroke();
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
        if (!s.panel.scrolls(delta > 0)) return false; // then the page does
        ImGui::GetIO().MouseWheel = -delta / kWheelLine;
        s.frame();
        return true;
    }
    if (!s.scene || position.x > s.pictureSize().x) return false;
    (void)s.burst("wheel");
    const float factor = std::exp(-delta * kWheelFactor);
    modifiers.control ? s.zoom(factor) : s.nearer(factor);
    return true;
}

bool Viewer::pinch(float factor) {
    State& s = *state_;
    if (!s.scene || !(factor > 0)) return false;
    (void)s.burst("pinch");
    s.zoom(factor);
    return true;
}

bool Viewer::drop(vec2 position) {
    State& s = *state_;
    if (!s.scene) return false;
    const auto place = waterAt(*s.scene, s.lens(), position);
    return place && s.fall(*place);
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
    if (state_->scene) state_->reset(path);
}

bool Viewer::undo() {
    if (state_->grip == State::Grip::Paint) return false; // the stroke is not done
    const std::vector<Change> changes = state_->history.undo();
    if (changes.empty()) return false;
    state_->apply(changes, true);
    return true;
}

bool Viewer::redo() {
    if (state_->grip == State::Grip::Paint) return false;
    const std::vector<Change> changes = state_->history.redo();
    if (changes.empty()) return false;
    state_->apply(changes, false);
    return true;
}

void Viewer::focusControl(const std::string& path) {
    state_->focus = path;
    state_->settled = false;
}

Status Viewer::act(const std::string& path) {
    state_->settled = false;
    return state_->act(path);
}

std::string Viewer::controls() { return controlsJson(state_->controls, state_->actions()); }

std::string Viewer::stats() const {
    State& s = *state_;
    StatsInput input;
    if (s.renderer) input.cost = s.renderer->stats();
    input.complete = s.complete();
    input.finished = s.complete() && s.phase != State::Phase::Smooth && !s.nextSide();
    input.shown = s.shown;
    input.open = {s.openSize().x, s.cardTop.value_or(s.openSize().y)};
    input.canUndo = s.history.canUndo();
    input.canRedo = s.history.canRedo();
    input.downscale = s.phase == State::Phase::Refine ? s.downscale : 1;
    if (s.phase != State::Phase::Done) input.progress = s.drawingProgress;
    if (s.missingBake) {
        input.bakeTechnique = s.missingBake->technique->name;
        input.bakeObject = s.missingBake->scene.objects[s.missingBake->object].name;
        input.bakeWork = s.missingBake->work;
    }
    input.frames = s.drawCount;
    input.pictures = s.pictureCount;
    input.reprojected = s.renderer && s.renderer->isReprojected();
    input.revision = s.revision;
    if (s.scene) {
        input.modes = modesOf(*s.scene);
        input.notDrawn = technique::notDrawn(*s.scene);
    }
    input.balance = s.balance;
    if (s.scene && s.pixels.y > 0)
        for (std::size_t i = 0; i < s.scene->lights.size(); ++i)
            input.lamps.push_back(s.handleOf(i));
    input.light = s.light;
    input.widgets = s.panel.widgets();
    return statsJson(input);
}

std::string Viewer::profiles(bool numbers) const {
    return state_->scene ? figuresJson(state_->allFigures(), numbers) : "[]";
}

std::string Viewer::changes() const { return changesJson(state_->controls, &state_->play.playing); }
std::string Viewer::sceneJson() const { return state_->scene ? scene::toJson(*state_->scene) : ""; }

Status Viewer::paint(std::string_view script, const std::string& object) {
    State& s = *state_;
    if (!s.scene) return Error{"paint: there is no scene; load one first"};
    const Result<std::vector<scene::Stroke>> strokes =
        scene::parseStrokes(std::as_bytes(std::span<const char>(script.data(), script.size())), "strokes");
    if (!strokes) return strokes.error();
    const auto& objects = s.scene->objects;
    const auto found = std::find_if(objects.begin(), objects.end(), [&](const scene::Object& one) {
        return isPaintable(one) && (object.empty() || one.name == object);
    });
    if (found == objects.end())
        return Error{object.empty()
                         ? "paint: no object can be painted; the material of one must scatter"
                         : "paint: objects." + object + " cannot be painted; its material must scatter"};
    ++s.gesture;
    return s.addStrokes(std::size_t(found - objects.begin()), *strokes);
}

std::shared_ptr<const scene::Painting> Viewer::painting(const std::string& object) const {
    if (state_->scene)
        for (const scene::Object& one : state_->scene->objects)
            if (one.painting && (object.empty() || one.name == object)) return one.painting;
    return nullptr;
}

std::string Viewer::strokes(const std::string& object) const {
    const auto painted = painting(object);
    return scene::toJson(painted ? painted->strokes : std::vector<scene::Stroke>{});
}

std::string Viewer::title() const { return state_->scene ? state_->scene->title : ""; }
std::string Viewer::caption() const { return state_->scene ? state_->scene->caption : ""; }
std::string Viewer::comparison() { return comparisonJson(state_->comparison()); }

std::vector<std::pair<std::string, Bytes>> Viewer::askTruth() {
    State& s = *state_;
    if (!s.scene) return {};
    s.asked = *s.scene;
    return packScene(*s.scene);
}

bool Viewer::drawsAll() const {
    const State& s = *state_;
    return !s.scene || std::all_of(s.scene->objects.begin(), s.scene->objects.end(),
                                   [](const scene::Object& object) { return technique::isShaded(object); });
}

std::string Viewer::failure() const { return state_->failure; }

Result<Image> Viewer::linear() {
    State& s = *state_;
    if (!s.renderer || !s.complete()) return Error{"picture: is not finished; must be drawn first"};
    return s.renderer->read(s.picture, s.picture.view.show);
}

std::vector<std::pair<std::string, Bytes>> Viewer::pack() const {
    const State& s = *state_;
    if (!s.asLoaded) return {};
    scene::Scene scene = *s.asLoaded;
    const auto mapOf = [](const auto& environment) { return environment ? environment->map : nullptr; };
    if (mapOf(scene.environment) != mapOf(s.scene->environment)) scene.environment = s.scene->environment;
    return packScene(std::move(scene));
}

Status Viewer::takeComputedTruth(const Image& picture, std::optional<double> noise) {
    State& s = *state_;
    if (!s.asked) return Error{"truth: nobody asked for one since the scene was loaded"};
    s.takeTruth({asTruthImage(picture), noise, *std::exchange(s.asked, std::nullopt)});
    return Done{};
}

Status Viewer::openTruth(const std::string& name, std::span<const std::byte> bytes,
                         std::optional<double> noise) {
    State& s = *state_;
    if (!s.asLoaded) return Error{name + ": there is no scene; load one first"};
    const Result<Image> picture = decodeImage(bytes, name, Encoding::Linear);
    if (!picture) return picture.error();
    s.takeTruth({asTruthImage(*picture), noise, *s.asLoaded});
    return Done{};
}

const scene::Scene* Viewer::scene() const { return state_->scene.get(); }
std::uint64_t Viewer::revision() const { return state_->revision; }

} // namespace lucent::viewer
