#pragma once
/// A linked shader program: compile errors speak of our files and lines, blocks are checked against C++.

#include "base/Result.h"
#include "graph/Device.h"

#include <string>
#include <vector>

namespace lucent::shaders {
struct Stage;
}

namespace lucent::gl {

class Program : public graph::Program {
public:
    /// Compiles and links STEM.vert (or lib/screen.vert when there is none: one triangle over the target) and
    /// STEM.frag with `defines` ("NAME" or "NAME VALUE").
    ///
    /// @return Error (Fault::Machine): every line of the log as "relief/light.frag:12: message"
    static Result<Program> build(const std::string& stem, const std::vector<std::string>& defines);

    /// The same from two stages; `name` stands before messages about both.
    static Result<Program> link(const std::string& name, const shaders::Stage& vertex,
                                const shaders::Stage& fragment, const std::vector<std::string>& defines);

    Program(Program&& other) noexcept;
    Program& operator=(Program&&) = delete;
    ~Program() override;

    unsigned id() const { return id_; }
    struct Sampler {
        std::string name;
        unsigned target; ///< GL_TEXTURE_2D or GL_TEXTURE_2D_ARRAY
    };
    /// The samplers that the program uses; the index is the texture unit.
    const std::vector<Sampler>& samplers() const { return samplers_; }

    /// Compares a block of C++ with what GL made of it, once.
    ///
    /// @return Error "relief/light: block ReliefBlock: depth at offset 16 in GLSL, 12 in C++"
    Status checkBlock(const graph::BlockLayout& layout) const;

private:
    Program() = default;
    void bindSamplers();
    unsigned id_ = 0;
    std::string stem_;
    std::vector<Sampler> samplers_;
    mutable const graph::BlockLayout* checked_ = nullptr;
};

/// Rewrites a driver's log so that each "0:LINE" or "ERROR: 0:LINE" names the file and line that was written.
std::string translateLog(const std::string& log, const std::string& stagePath, int firstSourceLine);

} // namespace lucent::gl
