#include "gl/Context.h"

#include "gl/Gl.h"

#include <algorithm>
#include <chrono>

#ifndef __EMSCRIPTEN__
#include <EGL/egl.h>
#include <EGL/eglext.h>
#endif

namespace lucent::gl {

#ifdef __EMSCRIPTEN__

struct Context::Window {
    std::string message; // browsers report on the console, and through glGetError
};

#else

struct Context::Window {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::string message; // first error that the driver's debug output told

    ~Window() {
        if (context == EGL_NO_CONTEXT) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
    }

    // A GPU with a driver of its own first, then Mesa without any window system.
    Status open() {
        if (openDevice() ||
            openOn(eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)))
            return Done{};
        return Error{"gl: no OpenGL ES 3.0 context without a window system; install libegl-mesa0 and "
                     "libgl1-mesa-dri, or the driver of the GPU",
                     Fault::Machine};
    }

    bool openDevice() {
        const auto queryDevices =
            reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
        const auto queryString =
            reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(eglGetProcAddress("eglQueryDeviceStringEXT"));
        EGLDeviceEXT devices[16];
        EGLint count = 0;
        if (!queryDevices || !queryString || !queryDevices(16, devices, &count)) return false;
        for (EGLint i = 0; i < count; ++i) {
            const char* extensions = queryString(devices[i], EGL_EXTENSIONS);
            if (!extensions || std::string_view(extensions).find("software") != std::string_view::npos)
                continue;
            if (openOn(eglGetPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr))) return true;
        }
        return false;
    }

    bool openOn(EGLDisplay candidate) {
        if (candidate == EGL_NO_DISPLAY || !eglInitialize(candidate, nullptr, nullptr)) return false;
        eglBindAPI(EGL_OPENGL_ES_API);
        const EGLint wanted[] = {EGL_RENDERABLE_TYPE,
                                 EGL_OPENGL_ES3_BIT,
                                 EGL_SURFACE_TYPE,
                                 EGL_PBUFFER_BIT,
                                 EGL_RED_SIZE,
                                 8,
                                 EGL_GREEN_SIZE,
                                 8,
                                 EGL_BLUE_SIZE,
                                 8,
                                 EGL_ALPHA_SIZE,
                                 8,
                                 EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!eglChooseConfig(candidate, wanted, &config, 1, &count) || !count) config = EGL_NO_CONFIG_KHR;
        const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_CONTEXT_MINOR_VERSION, 0, EGL_NONE};
        const EGLContext made = eglCreateContext(candidate, config, EGL_NO_CONTEXT, version);
        if (made == EGL_NO_CONTEXT) return false;
        if (!eglMakeCurrent(candidate, EGL_NO_SURFACE, EGL_NO_SURFACE, made)) {
            eglDestroyContext(candidate, made);
            return false;
        }
        display = candidate;
        context = made;
        return true;
    }
};

namespace {

constexpr GLenum kDebugOutput = 0x92E0;            // DEBUG_OUTPUT_KHR
constexpr GLenum kDebugOutputSynchronous = 0x8242; // DEBUG_OUTPUT_SYNCHRONOUS_KHR
constexpr GLenum kDebugTypeError = 0x824C;         // DEBUG_TYPE_ERROR_KHR
constexpr GLenum kDebugTypeUndefined = 0x824E;     // DEBUG_TYPE_UNDEFINED_BEHAVIOR_KHR

constexpr GLenum kDebugSourceShaderCompiler = 0x8248; // Program reports those with our files and lines

using DebugCallback = void (*)(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei length,
                               const char* text, const void* user);

void noteError(GLenum source, GLenum type, GLuint, GLenum, GLsizei, const char* text, const void* user) {
    auto& message = *const_cast<std::string*>(static_cast<const std::string*>(user));
    const bool isError = type == kDebugTypeError || type == kDebugTypeUndefined;
    if (message.empty() && isError && source != kDebugSourceShaderCompiler) message = text;
}

// Where the driver has KHR_debug it says what is wrong; glGetError only says that something is.
void listenToDriver(std::string& message) {
    const auto setCallback = reinterpret_cast<void (*)(DebugCallback, const void*)>(
        eglGetProcAddress("glDebugMessageCallbackKHR"));
    if (!setCallback) return;
    glEnable(kDebugOutput);
    glEnable(kDebugOutputSynchronous);
    setCallback(noteError, &message);
    glGetError(); // drivers that know the function but not the extension
}

} // namespace

#endif

Result<std::unique_ptr<Context>> Context::create(std::span<const std::string_view> without) {
    std::unique_ptr<Context> context(new Context);
    context->window_ = std::make_unique<Window>();
#ifndef __EMSCRIPTEN__
    if (Status opened = context->window_->open(); !opened) return opened.error();
    listenToDriver(context->window_->message);
#endif
    // A restored context remembers the errors of what was deleted for the lost one.
    for (int i = 0; i < 16 && glGetError(); ++i) {
    }
    context->caps_ = Caps::probe(without);
    if (!context->caps_.colorBufferFloat)
        return Error{"caps: cannot draw into floating-point textures (EXT_color_buffer_float missing) on " +
                         context->caps_.renderer +
                         "; visible points, layers of glass and sums of light are drawn into them",
                     Fault::Machine};
    context->device_ = std::make_unique<Device>(context->caps_);
    return context;
}

Context::~Context() {
    programs_.clear();
    device_.reset();
}

const Program* Context::program(const std::string& stem, const std::vector<std::string>& defines) {
    std::string key = stem;
    for (const std::string& define : defines)
        key += "|" + define;
    return &programs_.try_emplace(key, stem, defines).first->second;
}

bool Context::compile(double milliseconds) {
    using Clock = std::chrono::steady_clock;
    const auto begins = Clock::now();
    for (const auto& [key, program] : programs_) {
        if (program.isBegun()) continue;
        if (Clock::now() - begins > std::chrono::duration<double, std::milli>(milliseconds)) return false;
        program.compile();
    }
    return !caps_.parallelCompile || std::none_of(programs_.begin(), programs_.end(),
                                                  [](const auto& one) { return one.second.isCompiling(); });
}

bool Context::hasUnready() const {
    return std::any_of(programs_.begin(), programs_.end(),
                       [](const auto& one) { return !one.second.isTaken(); });
}

void Context::makeReady() {
    compile();
    for (const auto& [key, program] : programs_)
        (void)program.ready(); // a draw tells what is wrong with it
}

std::string Context::takeError() { return take(true); }

std::string Context::takeNoted() { return take(kAnswersAtOnce); }

std::string Context::take(bool asksGl) {
    const std::string said = std::exchange(window_->message, {});
    std::string error = device_->takeError();
    if (const GLenum code = asksGl ? glGetError() : 0; code && error.empty())
        error = "gl: error " + std::to_string(code);
    if (said.empty()) return error;
    return (error.empty() ? "gl" : error) + ": " + said;
}

} // namespace lucent::gl
