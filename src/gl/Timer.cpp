#include "gl/Timer.h"

#include "gl/Context.h"
#include "gl/Gl.h"

#ifndef __EMSCRIPTEN__
#include <EGL/egl.h>
#endif

namespace lucent::gl {

namespace {

constexpr GLenum kTimeElapsed = 0x88BF; // TIME_ELAPSED_EXT
constexpr GLenum kDisjoint = 0x8FBB;    // GPU_DISJOINT_EXT

#ifdef __EMSCRIPTEN__
void beginQuery(GLuint query) { glBeginQuery(kTimeElapsed, query); }
void endQuery() { glEndQuery(kTimeElapsed); }
#else
// The core entry points do not know this target; those of the extension do.
template <class Function>
Function load(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}
void beginQuery(GLuint query) {
    static const auto begin = load<void (*)(GLenum, GLuint)>("glBeginQueryEXT");
    begin(kTimeElapsed, query);
}
void endQuery() {
    static const auto end = load<void (*)(GLenum)>("glEndQueryEXT");
    end(kTimeElapsed);
}
#endif

} // namespace

Timer::Timer(const Context& context) {
    if (context.caps().timerQuery) glGenQueries(1, &query_);
}

Timer::~Timer() {
    if (query_) glDeleteQueries(1, &query_);
}

void Timer::begin() {
    if (query_) beginQuery(query_);
}

void Timer::end() {
    if (!query_) return;
    endQuery();
    pending_ = true;
}

std::optional<double> Timer::milliseconds() {
    if (!pending_) return std::nullopt;
    GLuint ready = 0;
    glGetQueryObjectuiv(query_, GL_QUERY_RESULT_AVAILABLE, &ready);
    if (!ready) return std::nullopt;
    pending_ = false;
    GLint disjoint = 0;
    glGetIntegerv(kDisjoint, &disjoint);
    GLuint nanoseconds = 0;
    glGetQueryObjectuiv(query_, GL_QUERY_RESULT, &nanoseconds);
    if (disjoint) return std::nullopt;
    return nanoseconds * 1e-6;
}

} // namespace lucent::gl
