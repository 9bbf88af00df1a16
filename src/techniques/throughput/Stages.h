#pragma once
/// Long work, stage after stage, in small pieces: in slices of time, on several threads, with progress.

#include "base/Result.h"

#include <chrono>
#include <functional>
#include <list>

namespace lucent::throughput {

/// A stage may add others, which then come right behind it, before those that were there. What stages refer
/// to must live as long as they do.
class Stages {
public:
    /// @param threads  0: as many as the machine has; no result depends on it
    explicit Stages(int threads = 0);
    Stages(const Stages&) = delete;
    Stages& operator=(const Stages&) = delete;

    /// A stage of one piece. Its error ends the work.
    void then(std::function<Status()> work);
    /// A stage of pieces of which each is for itself: on several threads.
    ///
    /// @param share  of all the work, [0,1]
    /// @param piece  called with each of [0, count)
    void forEach(double share, std::size_t count, std::function<void(std::size_t)> piece);
    /// The same, one piece after another.
    void inOrder(double share, std::size_t count, std::function<void(std::size_t)> piece);

    /// Works on for about so long, but for one piece at least. @return whether all is done
    Result<bool> advance(double ms);
    /// Works on until all is done.
    Status finish();
    /// Of the work that is done, [0,1].
    double share() const;

private:
    using Clock = std::chrono::steady_clock;
    struct Stage {
        double share = 0;
        std::size_t count = 0;
        std::function<void(std::size_t)> piece; // none: `whole`
        std::function<Status()> whole;
        bool isParallel = true;
        std::size_t done = 0; // pieces
    };
    void add(Stage stage);
    void work(Stage& stage, Clock::time_point end) const;

    std::size_t threads_;
    std::list<Stage> stages_;
    std::list<Stage>::iterator place_ = stages_.end(); // of the next that is added
    double done_ = 0;                                  // by stages that have ended
};

} // namespace lucent::throughput
