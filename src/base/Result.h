#pragma once
/// Errors as values: our libraries are built without exceptions, so both targets fail alike.

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace lucent {

/// Who has to act: the author of the input, or the owner of the machine. The program exits with 1 or 2.
enum class Fault { Input = 1, Machine = 2 };

/// One message in the form "where: what was found; what was expected".
struct Error {
    std::string message;
    Fault fault = Fault::Input;
};

/// Either a value or the error that prevented it.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    /// The value; only valid when ok().
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    /// The error; only valid when not ok().
    const Error& error() const {
        assert(!ok());
        return *std::get_if<1>(&state_);
    }

private:
    T& value() {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    const T& value() const {
        assert(ok());
        return *std::get_if<0>(&state_);
    }
    std::variant<T, Error> state_;
};

/// What a function returns that either does its work or says why not.
struct Done {};
using Status = Result<Done>;

} // namespace lucent
