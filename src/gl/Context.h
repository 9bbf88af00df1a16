#pragma once
/// One GL context: EGL without a window natively, WebGL2 in a page. It owns the capability probe, the program
/// cache and the device on which frame graphs run.

#include "base/Result.h"
#include "gl/Caps.h"
#include "gl/Device.h"
#include "gl/Program.h"

#include <map>
#include <memory>
#include <string>

namespace lucent::gl {

class Context {
public:
    /// Natively: creates a surfaceless EGL context (OpenGL ES 3.0) and makes it current. In a page: takes the
    /// WebGL2 context that is current and enables the extensions we use.
    ///
    /// @param without  extensions to do without (see Caps::probe)
    /// @return         Error (Fault::Machine) that says what is missing and what to install
    static Result<std::unique_ptr<Context>> create(std::span<const std::string_view> without = {});
    ~Context();

    const Caps& caps() const { return caps_; }
    Device& device() { return *device_; }

    /// The program of a shader stem ("relief/light") with feature switches ("USE_X", "STEPS 64"); cached for
    /// the page. A request costs nothing: compile() begins with it, or its first draw, which tells what is
    /// wrong with it.
    const Program* program(const std::string& stem, const std::vector<std::string>& defines = {});
    /// Begins to compile what was asked for until so much time has passed: they are compiled beside each
    /// other.
    ///
    /// @return whether no draw has to wait for a program; where the driver does not tell: whether all have
    /// begun
    bool compile(double milliseconds = 1e9);
    /// Whether any program has not been taken over since it was compiled. A browser answers what that asks
    /// when the GPU has done all it was given: makeReady() is for when it has.
    bool hasUnready() const;
    void makeReady();

    /// What the driver's debug output, GL's error flag and the device's own checks found:
    /// the first thing that went wrong on the GPU since the last call, "" when nothing did. A browser answers
    /// when the GPU has done all it was given.
    std::string takeError();
    /// The same without GL's error flag where to look at it is to wait.
    std::string takeNoted();

    /// GL calls fail from here on until a new Context is made; objects need not be deleted.
    void markLost() { lost_ = true; }
    bool lost() const { return lost_; }

private:
    Context() = default;
    std::string take(bool asksGl);
    struct Window;
    std::unique_ptr<Window> window_;
    Caps caps_;
    std::unique_ptr<Device> device_;
    std::map<std::string, Program> programs_;
    bool lost_ = false;
};

} // namespace lucent::gl
