#include "gl/Query.h"

#include "gl/Device.h"
#include "gl/Gl.h"

namespace lucent::gl {

Query::Query(const Device& device) : device_(device) { glGenQueries(1, &id_); }

Query::~Query() { glDeleteQueries(1, &id_); }

void Query::begin() { glBeginQuery(GL_ANY_SAMPLES_PASSED, id_); }

void Query::end() {
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    asked_ = true;
    polls_ = 0;
    answer_.reset();
}

std::optional<bool> Query::poll() {
    if (!asked_ || answer_) return answer_;
    if (polls_++ < device_.queryDelay()) return std::nullopt;
    GLuint ready = 0, any = 0;
    glGetQueryObjectuiv(id_, GL_QUERY_RESULT_AVAILABLE, &ready);
    if (!ready) return std::nullopt;
    glGetQueryObjectuiv(id_, GL_QUERY_RESULT, &any);
    return answer_ = any != 0;
}

} // namespace lucent::gl
