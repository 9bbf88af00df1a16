#pragma once
/// What a frame graph needs of the machine below: textures, and passes that draw into them.

#include "graph/Texture.h"

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace lucent::graph {

/// A linked shader program; what it is knows only the device that made it.
class Program {
public:
    virtual ~Program() = default;
};

/// Memory layout of a std140 block as C++ sees it; the device compares it with what GL reports.
struct BlockLayout {
    struct Member {
        std::string_view name; ///< as GL reports it after the block's name: "field.texels"
        std::size_t offset;
    };
    std::string_view name;
    std::size_t size;
    std::span<const Member> members;
};

/// The uniform block of one draw: a plain struct with a static `layout`.
struct Block {
    Block() = default;
    template <class Struct>
    Block(const Struct& values)
        : layout(&Struct::layout()), bytes(reinterpret_cast<const std::byte*>(&values),
                                           reinterpret_cast<const std::byte*>(&values + 1)) {}
    const BlockLayout* layout = nullptr;
    std::vector<std::byte> bytes;
};

struct Binding {
    std::string_view sampler; ///< name in the shader
    TextureHandle texture;
};

/// One draw call. Vertices come from gl_VertexID: there are no vertex buffers yet.
struct Draw {
    const Program* program = nullptr;
    int vertices = 3; ///< 3: one triangle over the whole target
    ivec4 region{0};  ///< x, y, width, height in pixels that are drawn; 0 wide: the whole target
    bool cullFront = false;
    bool depthTest = false;
    bool add = false; ///< adds to what the target holds; 32-bit floats only after asking Caps
    Block block;
    std::vector<Binding> textures;
};

class Commands {
public:
    virtual ~Commands() = default;
    virtual void draw(const Draw& draw) = 0;
};

/// Where a pass draws. All attachments have the same size.
struct PassTarget {
    std::string_view label;
    std::vector<TextureHandle> colors;
    TextureHandle depth = TextureHandle::None;
    std::optional<vec4> clear; ///< nothing: old content may be undefined and every pixel is drawn
};

class Device {
public:
    virtual ~Device() = default;
    virtual TextureHandle createTexture(const TextureDesc& desc, std::string_view label) = 0;
    virtual void destroyTexture(TextureHandle texture) = 0;
    virtual void runPass(const PassTarget& target, const std::function<void(Commands&)>& body) = 0;
};

} // namespace lucent::graph
