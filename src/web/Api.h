#pragma once
/// The calls that JavaScript makes: C functions, numbers and UTF-8 strings only, so that no code is generated
/// at run time and a strict content policy holds. Strings returned stay valid until the next call that
/// returns one.
///
/// A page makes one WebGL2 context on an OffscreenCanvas, makes it current, calls lucent_start once, and then
/// one viewer an element. Before viewer_draw the canvas must have the viewer's size.

#include <cstdint>

extern "C" {
/// Takes the current WebGL2 context. Returns "" or the message why it cannot be used. Called again after a
/// lost context came back: viewers keep their scenes and rebuild what they had on the GPU.
const char* lucent_start();
/// JSON: {"webgl": {...capabilities}, "fallbacks": [...]}
const char* lucent_capabilities();
void lucent_context_lost();

/// Makes room for a file of later loads. @return  where its bytes are to be written
std::uint8_t* file_space(const char* path, int size);
void file_forget(const char* path);
/// JSON: {"files": [...]} or {"error": "..."}; the scene must have been put.
const char* scene_dependencies(const char* path);

/// Begins to work out what a technique needs of the first object that it takes, of a scene that was put; no
/// viewer is involved. "" or the message.
const char* bake_begin(const char* path, const char* technique);
/// Works on for about so long. @return the finished share, [0,1]: 1 when there is a file or will be none
double bake_step(double ms);
/// {"at", "size"} of the file, which lies there until another begins, or {"error"}.
const char* bake_file();

int viewer_create(); ///< handle > 0
void viewer_destroy(int viewer);
/// Begins to load a scene, with all files that were put and are taken back by this. @return a number of this
/// load
int viewer_load(int viewer, const char* path);
/// Works on for some tens of ms. @return 1 while there is more to do; 0 when that load has ended, or another
/// has begun
int viewer_load_on(int viewer, int load);
/// "" or the message of the load that ended last. After an error the old scene stays.
const char* viewer_load_error(int viewer);
/// A picture becomes the environment of the scene; "" or the message.
const char* viewer_open_environment(int viewer, const char* name, const std::uint8_t* bytes, int size);
void viewer_copy(int viewer, int other); ///< see Viewer::copy()
int viewer_scene_number(int viewer);
void viewer_bare(int viewer, int bare);
void viewer_message(int viewer, const char* text);
void viewer_resize(int viewer, int width, int height, float scale);
void viewer_panel(int viewer, int visible);
void viewer_dark(int viewer, int dark);
int viewer_draw(int viewer, double seconds); ///< 1: another frame is wanted
int viewer_work(int viewer); ///< 1: another call before the next frame is of use; 2: a picture waits for it
int viewer_stop(int viewer); ///< 1: there was work to stop
int viewer_draw_count(int viewer);
const char* viewer_failure(int viewer); ///< "" or why the picture could not be drawn
/// JSON: {"width", "height", "at"}, the finished picture as linear values at an address of width x height x 4
/// floats, valid until the next call of this function; or {"error"}.
const char* viewer_linear(int viewer);
/// event: 0 down, 1 move, 2 up, 3 leave; modifiers: 1 shift, 2 control, 4 alt; pressure [0,1] of a pen.
/// Returns 1 when used.
int viewer_pointer(int viewer, int event, float x, float y, int button, int modifiers, int touch,
                   float pressure);
int viewer_wheel(int viewer, float x, float y, float delta, int modifiers);
int viewer_pinch(int viewer, float factor);
int viewer_drop(int viewer, float x, float y); ///< 1: it fell on water
int viewer_key(int viewer, const char* key, int modifiers);
/// A stroke script on an object, "": the first that can be painted; "" or the message.
const char* viewer_paint(int viewer, const char* script, const char* object);
const char* viewer_strokes(int viewer, const char* object); ///< the script of what is on it
/// JSON: {"side", "entering", "leaving"}, the maps of what is painted on an object as addresses of side x
/// side x 4 floats, valid until the next call for any viewer; null where nothing is.
const char* viewer_painting(int viewer, const char* object);
const char* viewer_get(int viewer, const char* path);
const char* viewer_set(int viewer, const char* path, const char* value); ///< "" or the message
void viewer_reset(int viewer, const char* path);
int viewer_undo(int viewer);
int viewer_redo(int viewer);
const char* viewer_act(int viewer, const char* path); ///< a button; "" or the message
void viewer_focus(int viewer, const char* path);
const char* viewer_controls(int viewer);
const char* viewer_stats(int viewer);
const char* viewer_changes(int viewer);
const char* viewer_profiles(int viewer, bool numbers); ///< JSON, see Viewer::profiles()
const char* viewer_scene_json(int viewer);
const char* viewer_title(int viewer);
const char* viewer_caption(int viewer);
/// JSON, see Viewer::comparison()
const char* viewer_comparison(int viewer);
/// JSON array of {"name", "at", "size"}: files of the scene that is showing, with its images, for the module
/// of Truth.cpp. Their bytes stay valid until the next call for any viewer.
const char* viewer_ask_truth(int viewer);
/// The same of a scene of what viewer_stats() says is to be baked, for bake_begin() of another module.
const char* viewer_ask_bake(int viewer);
/// What that answered, for the work that viewer_stats() named; "" or the message.
const char* viewer_take_bake(int viewer, const char* work, const std::uint8_t* bytes, int size);
/// The same of the scene without viewer_changes(), for the viewer of another module.
const char* viewer_pack(int viewer);
int viewer_draws_all(int viewer); ///< 0: the scene has objects that this module does not draw
/// The truth that was asked for: width x height x 4 floats. noise < 0: not known. "" or the message.
const char* viewer_take_truth(int viewer, const std::uint8_t* floats, int size, int width, int height,
                              double noise);
/// The truth of the scene as loaded, from a file. noise < 0: not known. "" or the message.
const char* viewer_open_truth(int viewer, const char* name, const std::uint8_t* bytes, int size,
                              double noise);
double viewer_revision(int viewer);
void viewer_release(int viewer);
}
