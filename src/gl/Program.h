#pragma once
/// A shader program: compiled without a wait when its turn comes, checked at first use; errors speak of our
/// files and lines.

#include "base/Result.h"
#include "graph/Device.h"

#include <optional>
#include <string>
#include <vector>

namespace lucent::shaders {
struct Stage;
}

namespace lucent::gl {

class Program : public graph::Program {
public:
    /// To be made of STEM.vert (or lib/screen.vert when there is none: one triangle over the target) and
    /// STEM.frag with `defines` ("NAME" or "NAME VALUE"), a variant that STEM.frag declares.
    Program(const std::string& stem, const std::vector<std::string>& defines);
    /// The same from two stages, whose sources live until compile(); `name` stands before messages about
    /// both.
    Program(const std::string& name, const shaders::Stage& vertex, const shaders::Stage& fragment,
            const std::vector<std::string>& defines);
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() override;

    /// Begins to compile and link it, which takes some milliseconds in a browser; nothing where it has begun.
    void compile() const;
    bool isBegun() const { return id_ || status_; }
    /// Whether ready() would wait; only where it has begun and there is Caps::parallelCompile.
    bool isCompiling() const;
    /// Whether ready() has been asked.
    bool isTaken() const { return status_.has_value(); }
    /// Waits until the program is linked; the members below hold after that.
    ///
    /// @return Error (Fault::Machine): every line of the log as "relief/light.frag:12: message"
    const Status& ready() const;

    unsigned id() const { return id_; }
    struct Sampler {
        std::string name;
        unsigned target; ///< GL_TEXTURE_2D or GL_TEXTURE_2D_ARRAY
    };
    /// The samplers that the program uses; the index is the texture unit.
    const std::vector<Sampler>& samplers() const { return samplers_; }

    /// Compares a block of C++ with what GL made of it.
    ///
    /// @return Error "relief/light: block ReliefBlock: 528 bytes in GLSL, 512 in C++"
    Status checkBlock(const graph::Block& block) const;

private:
    std::string log() const;
    struct BlockSize {
        std::string name;
        std::size_t bytes;
    };
    void bindSamplers() const;
    void bindBlocks() const;
    void deleteStages() const;
    std::string name_;
    std::string preamble_;
    std::vector<shaders::Stage> sources_;  // vertex, fragment
    mutable unsigned id_ = 0;              // 0: not begun
    mutable std::vector<unsigned> stages_; // as compiled, until ready()
    mutable std::optional<Status> status_;
    mutable std::vector<Sampler> samplers_;
    mutable std::vector<BlockSize> blocks_;
};

/// Rewrites a driver's log so that each "0:LINE" or "ERROR: 0:LINE" names the file and line that was written.
std::string translateLog(const std::string& log, const std::string& stagePath, int firstSourceLine);

} // namespace lucent::gl
