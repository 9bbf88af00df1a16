#include "web/Api.h"

#include "base/JsonWriter.h"
#include "scene/Load.h"
#include "technique/Technique.h"
#include "viewer/Viewer.h"
#include "web/Files.h"

#include <emscripten.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

using namespace lucent;
using viewer::Viewer;

namespace {

constexpr float kSoftwareError = 0.03f; // of pictures by default where the processor draws them

/// What a page has: one context, one host for its panels, files and viewers.
struct Page {
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<gl::ImGuiHost> imgui;
    PutFiles files;
    std::map<int, std::unique_ptr<Viewer>> viewers;
    int lastViewer = 0;
    struct Load {
        int number = 0;
        std::string error;
    };
    std::map<int, Load> loads;                         // of each viewer
    std::vector<std::pair<std::string, Bytes>> packed; // files of a scene for another module
    Image linear;                                      // that viewer_linear answered with
    struct Bake {
        const technique::Technique* technique = nullptr;
        std::unique_ptr<scene::Loading> loading;
        std::unique_ptr<technique::Baking> baking; // once that is done
        Result<Bytes> file = Bytes();              // what it came to
    };
    Bake bake;
    std::string answer;
};

Page& page() {
    static Page only;
    return only;
}

Viewer& viewerOf(int handle) { return *page().viewers.at(handle); }

const char* answer(std::string text) {
    page().answer = std::move(text);
    return page().answer.c_str();
}

const char* answer(std::vector<std::pair<std::string, Bytes>> files) {
    page().packed = std::move(files);
    JsonWriter json;
    json.beginArray();
    for (const auto& [name, bytes] : page().packed) {
        json.beginObject().key("name").value(name);
        json.key("at").value(double(std::uintptr_t(bytes.data()))).key("size").value(int(bytes.size())).end();
    }
    json.end();
    return answer(json.text());
}

const char* answer(const Status& status) { return answer(status ? std::string() : status.error().message); }

Result<Bytes> readFetched(const std::string& path) { return page().files.read(path); }

std::span<const std::byte> bytesOf(const std::uint8_t* bytes, int size) {
    return std::as_bytes(std::span(bytes, std::size_t(size)));
}

std::optional<double> noiseOf(double noise) { return noise < 0 ? std::nullopt : std::optional(noise); }

viewer::Modifiers modifiersOf(int bits) { return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0}; }

} // namespace

// Dear ImGui falls back to a typeface of its own when an atlas has none. Ours always has one, and without
// that typeface the page is 10 KB smaller: the linker sends calls of ImFontAtlas::AddFontDefault here.
extern "C" void* __wrap__ZN11ImFontAtlas14AddFontDefaultEPK12ImFontConfig(void*, const void*) {
    return nullptr;
}

const char* lucent_start() {
    Page& p = page();
    for (auto& [handle, viewer] : p.viewers)
        viewer->release();
    p.imgui.reset();
    p.context.reset();
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return answer(context.error().message);
    p.context = std::move(*context);
    p.imgui = std::make_unique<gl::ImGuiHost>(*p.context);
    for (auto& [handle, viewer] : p.viewers)
        viewer->attach(*p.context, *p.imgui);
    return answer(std::string());
}

const char* lucent_capabilities() {
    const gl::Caps& caps = page().context->caps();
    JsonWriter json;
    json.beginObject().key("webgl").raw(caps.json()).key("fallbacks").beginArray();
    for (const std::string& line : caps.fallbacks())
        json.value(line);
    json.end().end();
    return answer(json.text());
}

void lucent_context_lost() { page().context->markLost(); }

// --- files

std::uint8_t* file_space(const char* path, int size) { return page().files.space(path, size); }

void file_forget(const char* path) { page().files.forget(path); }

const char* scene_dependencies(const char* path) {
    JsonWriter json;
    json.beginObject();
    const Result<Bytes> scene = readFetched(path);
    const auto files =
        scene ? scene::dependencies(path, *scene) : Result<std::vector<std::string>>(scene.error());
    if (files) {
        json.key("files").beginArray();
        for (const std::string& file : *files)
            json.value(file);
        json.end();
    } else {
        json.key("error").value(files.error().message);
    }
    json.end();
    return answer(json.text());
}

// --- work that is done once for an object

namespace {

Status beginBake(const char* path, const char* name) {
    const technique::Technique* technique = technique::find(name);
    if (!technique || !technique->baker) return Error{std::string(name) + ": is no technique that bakes"};
    page().bake = {.technique = technique,
                   .loading = std::make_unique<scene::Loading>(path, readFetched, technique::tables())};
    return Done{};
}

Result<std::unique_ptr<technique::Baking>> bakingOf(const technique::Technique& technique,
                                                    const Result<scene::Scene>& scene) {
    if (!scene) return scene.error();
    const technique::Baker& baker = *technique.baker;
    const auto object = std::find_if(scene->objects.begin(), scene->objects.end(), baker.takes);
    if (object == scene->objects.end())
        return Error{"the scene has no object that " + std::string(technique.name) + " bakes"};
    return baker.bake(scene->technique.at(std::string(technique.name)), *object, 1);
}

// @return the file once it is whole
std::optional<Result<Bytes>> workOnBake(double ms) {
    Page::Bake& bake = page().bake;
    if (bake.baking) return bake.baking->advance(ms);
    const std::optional<Result<scene::Scene>> scene = bake.loading->advance(ms);
    if (!scene) return std::nullopt;
    auto baking = bakingOf(*bake.technique, *scene);
    if (!baking) return Result<Bytes>(baking.error());
    bake.baking = std::move(*baking);
    return std::nullopt;
}

} // namespace

const char* bake_begin(const char* path, const char* technique) { return answer(beginBake(path, technique)); }

double bake_step(double ms) {
    std::optional<Result<Bytes>> file = workOnBake(ms);
    if (!file) return page().bake.baking ? std::min(page().bake.baking->share(), 0.999) : 0;
    page().bake = {.file = std::move(*file)};
    return 1;
}

const char* bake_file() {
    const Result<Bytes>& file = page().bake.file;
    JsonWriter json;
    json.beginObject();
    if (file) {
        json.key("at").value(double(std::uintptr_t(file->data())));
        json.key("size").value(int(file->size()));
    } else {
        json.key("error").value(file.error().message);
    }
    return answer(json.end().text());
}

// --- viewers

int viewer_create() {
    Page& p = page();
    auto viewer = std::make_unique<Viewer>(*p.context, *p.imgui);
    if (p.context->caps().software) viewer->setAutomaticError(kSoftwareError);
    viewer->setBakesElsewhere(true);
    p.viewers.emplace(++p.lastViewer, std::move(viewer));
    return p.lastViewer;
}

void viewer_destroy(int viewer) {
    page().viewers.erase(viewer);
    page().loads.erase(viewer);
}

int viewer_load(int viewer, const char* path) {
    const auto files = std::make_shared<const PutFiles>(std::exchange(page().files, {}));
    const std::string scene = path;
    viewerOf(viewer).beginLoad(scene, [files](const std::string& name) { return files->read(name); });
    Page::Load& load = page().loads[viewer];
    load.error.clear();
    return ++load.number;
}

int viewer_load_on(int viewer, int number) {
    constexpr double kSliceMs = 16; // and what a piece takes that has begun by then
    Page::Load& load = page().loads[viewer];
    if (!page().viewers.contains(viewer) || load.number != number) return 0;
    const std::optional<Status> done = viewerOf(viewer).advanceLoad(kSliceMs);
    if (!done) return 1;
    load.error = done->ok() ? std::string() : done->error().message;
    ++load.number; // ended
    return 0;
}

const char* viewer_load_error(int viewer) { return answer(page().loads[viewer].error); }

const char* viewer_open_environment(int viewer, const char* name, const std::uint8_t* bytes, int size) {
    return answer(viewerOf(viewer).openEnvironment(name, bytesOf(bytes, size)));
}

void viewer_copy(int viewer, int other) { viewerOf(viewer).copy(viewerOf(other)); }
int viewer_scene_number(int viewer) { return viewerOf(viewer).sceneNumber(); }
void viewer_bare(int viewer, int bare) { viewerOf(viewer).setBare(bare != 0); }
void viewer_message(int viewer, const char* text) { viewerOf(viewer).showMessage(text); }
void viewer_resize(int viewer, int width, int height, float scale) {
    viewerOf(viewer).resize({width, height}, scale);
}
void viewer_panel(int viewer, int visible) { viewerOf(viewer).setPanelVisible(visible != 0); }
void viewer_dark(int viewer, int dark) { viewerOf(viewer).setDark(dark != 0); }
int viewer_draw(int viewer, double seconds) { return viewerOf(viewer).draw(seconds); }
int viewer_work(int viewer) { return int(viewerOf(viewer).work()); }
int viewer_stop(int viewer) { return viewerOf(viewer).stop(); }
int viewer_draw_count(int viewer) { return viewerOf(viewer).drawCount(); }

const char* viewer_failure(int viewer) { return answer(viewerOf(viewer).failure()); }

const char* viewer_linear(int viewer) {
    Result<Image> picture = viewerOf(viewer).linear();
    JsonWriter json;
    json.beginObject();
    if (picture) {
        page().linear = std::move(*picture);
        const Image& image = page().linear;
        json.key("width").value(image.width).key("height").value(image.height);
        json.key("at").value(double(std::uintptr_t(image.pixels.data())));
    } else {
        json.key("error").value(picture.error().message);
    }
    return answer(json.end().text());
}

int viewer_pointer(int viewer, int event, float x, float y, int button, int modifiers, int touch,
                   float pressure) {
    return viewerOf(viewer).pointer(viewer::PointerEvent(event), {x, y}, button, modifiersOf(modifiers),
                                    touch != 0, pressure);
}

int viewer_wheel(int viewer, float x, float y, float delta, int modifiers) {
    return viewerOf(viewer).wheel({x, y}, delta, modifiersOf(modifiers));
}

int viewer_pinch(int viewer, float factor) { return viewerOf(viewer).pinch(factor); }
int viewer_drop(int viewer, float x, float y) { return viewerOf(viewer).drop({x, y}); }
int viewer_key(int viewer, const char* key, int modifiers) {
    return viewerOf(viewer).key(key, modifiersOf(modifiers));
}

const char* viewer_paint(int viewer, const char* script, const char* object) {
    return answer(viewerOf(viewer).paint(script, object));
}
const char* viewer_strokes(int viewer, const char* object) {
    return answer(viewerOf(viewer).strokes(object));
}
const char* viewer_painting(int viewer, const char* object) {
    const auto painting = viewerOf(viewer).painting(object);
    if (!painting) return answer("null");
    const auto address = [](const Image& map) { return double(std::uintptr_t(map.pixels.data())); };
    JsonWriter json;
    json.beginObject().key("side").value(painting->side());
    json.key("entering").value(address(*painting->entering));
    json.key("leaving").value(address(*painting->leaving)).end();
    return answer(json.text());
}
const char* viewer_get(int viewer, const char* path) { return answer(viewerOf(viewer).get(path)); }
const char* viewer_set(int viewer, const char* path, const char* value) {
    return answer(viewerOf(viewer).set(path, value));
}
void viewer_reset(int viewer, const char* path) { viewerOf(viewer).reset(path); }
int viewer_undo(int viewer) { return viewerOf(viewer).undo(); }
int viewer_redo(int viewer) { return viewerOf(viewer).redo(); }
const char* viewer_act(int viewer, const char* path) { return answer(viewerOf(viewer).act(path)); }
void viewer_focus(int viewer, const char* path) { viewerOf(viewer).focusControl(path); }
const char* viewer_controls(int viewer) { return answer(viewerOf(viewer).controls()); }
const char* viewer_stats(int viewer) { return answer(viewerOf(viewer).stats()); }
const char* viewer_profiles(int viewer, bool numbers) { return answer(viewerOf(viewer).profiles(numbers)); }
const char* viewer_changes(int viewer) { return answer(viewerOf(viewer).changes()); }
const char* viewer_scene_json(int viewer) { return answer(viewerOf(viewer).sceneJson()); }
const char* viewer_title(int viewer) { return answer(viewerOf(viewer).title()); }
const char* viewer_caption(int viewer) { return answer(viewerOf(viewer).caption()); }
const char* viewer_comparison(int viewer) { return answer(viewerOf(viewer).comparison()); }

const char* viewer_ask_truth(int viewer) { return answer(viewerOf(viewer).askTruth()); }
const char* viewer_ask_bake(int viewer) { return answer(viewerOf(viewer).askBake()); }
const char* viewer_take_bake(int viewer, const char* work, const std::uint8_t* bytes, int size) {
    return answer(viewerOf(viewer).takeBake(work, bytesOf(bytes, size)));
}
const char* viewer_pack(int viewer) { return answer(viewerOf(viewer).pack()); }
int viewer_draws_all(int viewer) { return viewerOf(viewer).drawsAll(); }

const char* viewer_take_truth(int viewer, const std::uint8_t* floats, int size, int width, int height,
                              double noise) {
    Image image(width, height, 4);
    if (std::size_t(size) != image.pixels.size() * sizeof(float))
        return answer("truth: has " + std::to_string(size) + " bytes; must have 16 for each pixel");
    std::memcpy(image.pixels.data(), floats, std::size_t(size));
    return answer(viewerOf(viewer).takeComputedTruth(image, noiseOf(noise)));
}

const char* viewer_open_truth(int viewer, const char* name, const std::uint8_t* bytes, int size,
                              double noise) {
    return answer(viewerOf(viewer).openTruth(name, bytesOf(bytes, size), noiseOf(noise)));
}

double viewer_revision(int viewer) { return double(viewerOf(viewer).revision()); }
void viewer_release(int viewer) { viewerOf(viewer).release(); }
