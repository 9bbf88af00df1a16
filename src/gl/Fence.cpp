#include "gl/Fence.h"

#include "gl/Gl.h"

#include <algorithm>

namespace lucent::gl {

Fence::Fence() : sync_(glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0)) { glFlush(); }

Fence::~Fence() {
    if (sync_) glDeleteSync(static_cast<GLsync>(sync_));
}

bool Fence::passed([[maybe_unused]] double milliseconds) const {
    if (!sync_) return true; // the context is lost
    const auto sync = static_cast<GLsync>(sync_);
#ifdef __EMSCRIPTEN__
    GLint status = GL_UNSIGNALED;
    glGetSynciv(sync, GL_SYNC_STATUS, 1, nullptr, &status);
    return status == GL_SIGNALED;
#else
    const auto most = GLuint64(std::max(milliseconds, 0.0) * 1e6);
    return glClientWaitSync(sync, 0, most) != GL_TIMEOUT_EXPIRED;
#endif
}

} // namespace lucent::gl
