/// The self-check as a module of its own, fetched when somebody asks for it, on a WebGL2 context of its own:
/// the page's viewers and what they load first know nothing of it. C functions as in Api.h; strings returned
/// stay valid until the next call that returns one.

#include "measure/SelfCheck.h"

#include <memory>
#include <string>

using namespace lucent;

namespace {

struct Run {
    std::unique_ptr<gl::Context> context;
    std::unique_ptr<measure::SelfCheck> check;
    std::string answer;
};

Run& run() {
    static Run only;
    return only;
}

const char* answer(std::string text) {
    run().answer = std::move(text);
    return run().answer.c_str();
}

} // namespace

extern "C" {

/// Takes the current WebGL2 context. "" or the message why it cannot be used.
const char* check_start() {
    Result<std::unique_ptr<gl::Context>> context = gl::Context::create();
    if (!context) return answer(context.error().message);
    run().context = std::move(*context);
    run().check = std::make_unique<measure::SelfCheck>(*run().context);
    return answer(std::string());
}

/// Measures a line more; 1 while lines are left.
int check_step() { return run().check->step(); }

/// Finished part, [0,1].
double check_progress() { return run().check->progress(); }

/// JSON: {"device", "passed", "checks", "capabilities"}, as far as they go.
const char* check_report() { return answer(run().check->json()); }
}
