#pragma once
/// What a frame graph needs of the machine below: textures, index buffers, and passes that draw into them.

#include "graph/Texture.h"

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace lucent::graph {

/// A linked shader program; what it is knows only the device that made it.
class Program {
public:
    virtual ~Program() = default;
};

/// The uniform block of one draw: a struct of a generated shaders/FOLDER/Blocks.h.
struct Block {
    Block() = default;
    template <class Struct>
    Block(const Struct& values)
        : name(Struct::kName), bytes(reinterpret_cast<const std::byte*>(&values),
                                     reinterpret_cast<const std::byte*>(&values + 1)) {}
    std::string_view name; ///< in the shader; empty: none
    std::vector<std::byte> bytes;
};

struct Binding {
    std::string_view sampler; ///< name in the shader
    TextureHandle texture;
};

enum class Topology : std::uint8_t { Triangles, Lines, Points }; ///< points: the shader sets gl_PointSize
enum class Cull : std::uint8_t { None, Front, Back };            ///< front faces run counterclockwise
enum class DepthTest : std::uint8_t { None, Less, LessEqual, Equal, Greater };

/// A target with stencil (Format::Depth32FStencil8) counts: with Count every fragment, nearest or not, up to
/// 255; More draws only where there were more than Draw::counted.
enum class Stencil : std::uint8_t { None, Count, More };

/// How what is drawn meets what the target holds, in all colour targets alike. Integer targets are
/// overwritten. 16-bit floats blend wherever they can be drawn into; 32-bit floats need Caps::floatBlend, and
/// the device refuses the draw without it.
enum class Blend : std::uint8_t { None, Add, Max, Min };

/// One draw call. There are no vertex buffers: shaders fetch what belongs to gl_VertexID from textures.
struct Draw {
    const Program* program = nullptr;
    IndicesHandle indices = IndicesHandle::None; ///< gl_VertexID runs over these; none: over 0, 1, 2 ...
    int vertices = 3; ///< how many, or how many indices; 3: one triangle over the whole target
    int instances = 1;
    Topology topology = Topology::Triangles;
    ivec4 region{0}; ///< x, y, width, height in pixels that are drawn; 0 wide: the whole target
    ivec2 rows{0};   ///< of the target, from and to, that are drawn of it; to 0: all
    Cull cull = Cull::None;
    DepthTest depthTest = DepthTest::None; ///< with None the depth target keeps what it holds
    bool depthWrite = true;
    Stencil stencil = Stencil::None;
    int counted = 0; ///< of Stencil::More
    Blend blend = Blend::None;
    Block block{};
    std::vector<Binding> textures{};
};

class Commands {
public:
    virtual ~Commands() = default;
    virtual void draw(const Draw& draw) = 0;
};

/// Whether any sample of a pass was drawn. The answer comes after the frame, in a browser never within it.
class Query {
public:
    virtual ~Query() = default;
    /// Nothing while the last pass with this query has no answer yet, or when there was no such pass.
    virtual std::optional<bool> poll() = 0;
};

/// What a target is filled with: one float for depths, beside which a stencil becomes 0, a uvec4 for
/// integers, a vec4 for every other colour.
using Clear = std::variant<vec4, uvec4, float>;

/// One layer and mip level of a texture that a pass draws into.
struct Attachment {
    TextureHandle texture = TextureHandle::None;
    int layer = 0, level = 0;
    std::optional<Clear> clear{}; ///< nothing: old content may be undefined and every pixel is drawn
};

/// Where a pass draws. All attachments have the same size; at least one is there.
struct PassTarget {
    std::string_view label;
    std::vector<Attachment> colors{};
    Attachment depth{};
    Query* query = nullptr; ///< asked about this pass
};

class Device {
public:
    virtual ~Device() = default;
    virtual TextureHandle createTexture(const TextureDesc& desc, std::string_view label) = 0;
    virtual void destroyTexture(TextureHandle texture) = 0;
    virtual IndicesHandle createIndices(std::span<const std::uint32_t> indices, std::string_view label) = 0;
    virtual void destroyIndices(IndicesHandle indices) = 0;
    virtual void runPass(const PassTarget& target, const std::function<void(Commands&)>& body) = 0;
};

} // namespace lucent::graph
