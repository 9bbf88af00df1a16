#pragma once
/// Small things about text that messages and files share.

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace lucent {

/// Shortest decimal form that reads back to the same value: "0.1", "1e-06", "inf".
std::string shortest(float value);
std::string shortest(double value);

/// The number that all of a text is, if it is one and finite.
std::optional<double> numberIn(std::string_view text);

/// The candidate with the fewest changed, added or removed letters; "" when there are none.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// `text` in double quotes, escaped as JSON wants it.
std::string inQuotes(std::string_view text);

} // namespace lucent
