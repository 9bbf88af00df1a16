#pragma once
/// Dear ImGui's drawing on our context: this folder is the only one that calls GL.

#include "gl/Context.h"

struct ImDrawData;
struct ImFontAtlas;

namespace lucent::gl {

/// Draws ImGui's triangles into the default framebuffer. One per context; every viewer has its own ImGui
/// context but all share one font atlas, which is uploaded here once.
///
/// The package's own backend keeps the atlas's texture name inside the atlas, where it would outlive a lost
/// context, and asks GL for some twenty states a frame, which a browser answers slowly; hence this one.
class ImGuiHost {
public:
    explicit ImGuiHost(Context& context) : context_(context) {}
    ~ImGuiHost();
    ImGuiHost(const ImGuiHost&) = delete;
    ImGuiHost& operator=(const ImGuiHost&) = delete;

    /// Empties the default framebuffer: transparent, `width` x `height` pixels.
    void clear(int width, int height);

    /// Blends the panel over what is there; the canvas holds premultiplied alpha.
    ///
    /// @param atlas   the shared font atlas, built; uploaded at the first call
    /// @param width,height  framebuffer size in pixels
    /// @return        Error (Fault::Machine) when the shader does not compile
    Status draw(const ImDrawData& data, ImFontAtlas& atlas, int width, int height);

private:
    void create(ImFontAtlas& atlas);
    Context& context_;
    unsigned vertexArray_ = 0, vertexBuffer_ = 0, indexBuffer_ = 0, fontTexture_ = 0;
};

} // namespace lucent::gl
