#include "gl/ImGuiHost.h"

#include "gl/Gl.h"

#include <imgui.h>

#include <cstddef>

namespace lucent::gl {

namespace {

void setAttribute(GLuint location, GLint components, GLenum type, bool normalized, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, components, type, normalized, sizeof(ImDrawVert),
                          reinterpret_cast<const void*>(offset));
}

// ImGui's rectangle in CSS pixels from the top, GL's in pixels from the bottom. False when nothing is left of
// it.
bool setScissor(const ImVec4& clip, const ImDrawData& data, ivec2 size) {
    const vec2 scale(data.FramebufferScale.x, data.FramebufferScale.y);
    const ivec2 low = glm::max(ivec2(vec2(clip.x, clip.y) * scale), ivec2(0));
    const ivec2 high = glm::min(ivec2(vec2(clip.z, clip.w) * scale), size);
    if (high.x <= low.x || high.y <= low.y) return false;
    glScissor(low.x, size.y - high.y, high.x - low.x, high.y - low.y);
    return true;
}

void drawList(const ImDrawList& list, const ImDrawData& data, ivec2 size) {
    static_assert(sizeof(ImDrawIdx) == 2);
    glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                 GL_STREAM_DRAW);
    for (const ImDrawCmd& command : list.CmdBuffer) {
        if (!setScissor(command.ClipRect, data, size)) continue;
        const void* first = reinterpret_cast<const void*>(command.IdxOffset * sizeof(ImDrawIdx));
        glDrawElements(GL_TRIANGLES, GLsizei(command.ElemCount), GL_UNSIGNED_SHORT, first);
    }
}

} // namespace

ImGuiHost::~ImGuiHost() {
    if (context_.lost()) return;
    glDeleteVertexArrays(1, &vertexArray_);
    glDeleteBuffers(1, &vertexBuffer_);
    glDeleteBuffers(1, &indexBuffer_);
    glDeleteTextures(1, &fontTexture_);
}

void ImGuiHost::create(ImFontAtlas& atlas) {
    unsigned char* coverage = nullptr;
    int width = 0, height = 0;
    atlas.GetTexDataAsAlpha8(&coverage, &width, &height);
    glGenTextures(1, &fontTexture_);
    glBindTexture(GL_TEXTURE_2D, fontTexture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_R8, width, height, 0, GL_RED, GL_UNSIGNED_BYTE, coverage);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);

    glGenBuffers(1, &vertexBuffer_);
    glGenBuffers(1, &indexBuffer_);
    glGenVertexArrays(1, &vertexArray_);
    glBindVertexArray(vertexArray_);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indexBuffer_);
    setAttribute(0, 2, GL_FLOAT, false, offsetof(ImDrawVert, pos));
    setAttribute(1, 2, GL_FLOAT, false, offsetof(ImDrawVert, uv));
    setAttribute(2, 4, GL_UNSIGNED_BYTE, true, offsetof(ImDrawVert, col));
    glBindVertexArray(0);
}

void ImGuiHost::clear(int width, int height) {
    context_.device().setScreenSize({width, height});
    context_.device().runPass(
        {.label = "viewer.clear", .colors = {{.texture = graph::TextureHandle::Screen, .clear = vec4(0)}}},
        [](graph::Commands&) {});
}

Status ImGuiHost::draw(const ImDrawData& data, ImFontAtlas& atlas, int width, int height) {
    const Program* program = context_.program("gl/imgui");
    if (const Status& ready = program->ready(); !ready) return ready;
    glActiveTexture(GL_TEXTURE0);
    if (!vertexArray_) create(atlas);

    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_SCISSOR_TEST);
    glEnable(GL_BLEND);
    glBlendEquation(GL_FUNC_ADD);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    const GLuint id = program->id();
    glUseProgram(id);
    glUniform2f(glGetUniformLocation(id, "uSize"), data.DisplaySize.x, data.DisplaySize.y);
    glBindTexture(GL_TEXTURE_2D, fontTexture_);
    glBindVertexArray(vertexArray_);
    glBindBuffer(GL_ARRAY_BUFFER, vertexBuffer_);
    for (int i = 0; i < data.CmdListsCount; ++i)
        drawList(*data.CmdLists[i], data, {width, height});

    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glUseProgram(0);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    return Done{};
}

} // namespace lucent::gl
