#pragma once
/// Works a plan off, step by step, so that a page stays alive. No threads and no files: exact solutions come
/// from the caller, who may know them already.

#include "frame/Renderer.h"
#include "measure/Plan.h"
#include "truth/Picture.h"

#include <deque>
#include <memory>

namespace lucent::measure {

/// A part of the exact solution of what a scene shows, with its standard errors: some rows, or a whole
/// picture by rays of its own (measure/Solve.h).
///
/// @param directions  that stand for an environment
using SolveTruth =
    std::function<Result<truth::Picture>(const scene::Scene& scene, int directions, const truth::Tile& part)>;

/// Called with a line before each part of the work.
using Say = std::function<void(const std::string&)>;

class Sweep {
public:
    Sweep(gl::Context& context, Plan plan, SolveTruth solve, Say say);
    ~Sweep();

    /// Does a piece of the work: at most some rows of an exact solution, or one picture.
    ///
    /// @return false when all is done. What a method or a scene refuses is written down, not returned.
    bool step();

    /// Done part of the work by its expected time, [0,1].
    double share() const { return total_ > 0 ? done_ / total_ : 1; }

    /// What was found so far; ratios and Pareto fronts come with the last step.
    const BenchReport& report() const { return report_; }

private:
    struct Task;
    class Solving;
    class CaseTruth;
    class Timing;
    class SeriesPoint;
    class Hard;
    struct CaseState;

    void addTasks();
    void add(std::unique_ptr<Task> task, double cost);

    gl::Context& context_;
    Plan plan_;
    SolveTruth solve_;
    Say say_;
    BenchReport report_;
    std::deque<std::unique_ptr<Task>> tasks_;
    bool begun_ = false; // the first task
    double total_ = 0, done_ = 0;
};

/// The whole plan at once.
BenchReport sweep(gl::Context& context, Plan plan, SolveTruth solve, const Say& say);

} // namespace lucent::measure
