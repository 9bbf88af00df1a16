#pragma once
/// One function of several lambdas, for std::visit.

namespace lucent {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>; // for Clang 14

} // namespace lucent
