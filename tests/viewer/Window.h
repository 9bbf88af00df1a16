#pragma once
/// A default framebuffer for a context without a window: viewers draw where a page's canvas would be.

#include "base/Image.h"
#include "gl/Gl.h"

#include <EGL/egl.h>

namespace lucent {

/// Needs a current context; gives it a surface of `size` pixels as long as it lives.
class Window {
public:
    explicit Window(ivec2 size)
        : size_(size), display_(eglGetCurrentDisplay()), context_(eglGetCurrentContext()) {
        // A surface must have its context's config.
        EGLint wanted[] = {EGL_CONFIG_ID, 0, EGL_NONE};
        eglQueryContext(display_, context_, EGL_CONFIG_ID, &wanted[1]);
        EGLConfig config = nullptr;
        EGLint count = 0;
        eglChooseConfig(display_, wanted, &config, 1, &count);
        const EGLint attributes[] = {EGL_WIDTH, size.x, EGL_HEIGHT, size.y, EGL_NONE};
        surface_ = eglCreatePbufferSurface(display_, config, attributes);
        ok_ = surface_ != EGL_NO_SURFACE && eglMakeCurrent(display_, surface_, surface_, context_);
        const GLenum back = GL_BACK; // a context that began without a surface draws nowhere
        if (ok_) glDrawBuffers(1, &back);
        if (ok_) glReadBuffer(GL_BACK);
    }
    ~Window() {
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_);
        if (surface_ != EGL_NO_SURFACE) eglDestroySurface(display_, surface_);
    }
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;

    bool ok() const { return ok_; }

    /// What is there now: premultiplied, encoded, 4 channels, top row first.
    Image read() const {
        std::vector<unsigned char> bytes(std::size_t(size_.x) * size_.y * 4);
        glReadPixels(0, 0, size_.x, size_.y, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
        Image image(size_.x, size_.y, 4);
        for (int y = 0; y < size_.y; ++y)
            for (int i = 0; i < size_.x * 4; ++i)
                image.at(0, y)[i] = float(bytes[std::size_t(size_.y - 1 - y) * size_.x * 4 + i]) / 255;
        return image;
    }

private:
    ivec2 size_;
    EGLDisplay display_;
    EGLContext context_;
    EGLSurface surface_ = EGL_NO_SURFACE;
    bool ok_ = false;
};

} // namespace lucent
