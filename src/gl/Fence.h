#pragma once
/// Whether the GPU has done all that it was given so far.

namespace lucent::gl {

/// Stands behind every command before it.
class Fence {
public:
    Fence();
    ~Fence();
    Fence(Fence&& other) noexcept : sync_(other.sync_) { other.sync_ = nullptr; }
    Fence& operator=(Fence&&) = delete;

    /// @param milliseconds  to wait for it at most; a browser never waits: there fences pass between tasks
    bool passed(double milliseconds) const;

private:
    void* sync_;
};

} // namespace lucent::gl
