#pragma once
/// JSON text as a tree that remembers lines, so that every complaint can name its place.

#include "base/Result.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent::scene {

struct Json {
    enum class Type { Null, Bool, Number, String, Array, Object };
    Type type = Type::Null;
    int line = 1; ///< of its key, or of the value where there is no key
    bool boolean = false;
    double number = 0;
    std::string string;
    std::vector<std::string> keys; ///< of an object, in the order of the file
    std::vector<Json> items;       ///< of an array, or the values of an object

    /// Member of an object; null when it is absent or this is no object.
    const Json* find(std::string_view key) const;
    /// What stands there, for messages: `"text"`, `-0.8`, `true`, `a list`, `an object`.
    std::string describe() const;
};

/// Reads one JSON text (RFC 8259).
///
/// @param quotes  whether messages may repeat what stands there: not of a file that only a scene names, which
/// may be
///                any
/// @return  Error "NAME:LINE:COLUMN: what; expected" for bad syntax, a key given twice, nesting deeper than
/// 32
Result<Json> parseJson(std::span<const std::byte> text, const std::string& name, bool quotes = true);

} // namespace lucent::scene
