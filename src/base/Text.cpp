#include "base/Text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace lucent {
namespace {

// std::to_chars would do this, but the C++ library of older Emscripten releases has it for integers only.
template <class Value>
std::string shortestText(Value value, Value (*parse)(const char*, char**), int digits) {
    if (value == 0) value = 0; // no "-0"
    char text[40];
    if (std::abs(value) < Value(1e7) && value == std::floor(value)) { // 1000, not 1e+03
        std::snprintf(text, sizeof text, "%.0f", double(value));
        return text;
    }
    const auto write = [&](int precision) {
        std::snprintf(text, sizeof text, "%.*g", precision, double(value));
    };
    for (int least = 1; least < digits;) { // more digits than are enough are enough
        const int middle = (least + digits) / 2;
        write(middle);
        if (parse(text, nullptr) == value)
            digits = middle;
        else
            least = middle + 1;
    }
    write(digits);
    return text;
}

// Levenshtein distance, one row at a time.
std::size_t editDistance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j)
        row[j] = j;
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] != b[j]);
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, row[j + 1] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string shortest(float value) { return shortestText<float>(value, std::strtof, 9); }
std::string shortest(double value) { return shortestText<double>(value, std::strtod, 17); }

std::optional<double> numberIn(std::string_view text) {
    const std::string whole(text); // strtod wants an end
    char* end = nullptr;
    const double value = std::strtod(whole.c_str(), &end);
    const bool isNumber = !whole.empty() && !std::isspace(static_cast<unsigned char>(whole[0])) &&
                          end == whole.c_str() + whole.size() && std::isfinite(value);
    return isNumber ? std::optional(value) : std::nullopt;
}

std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates) {
    std::string_view best;
    std::size_t bestDistance = std::string_view::npos;
    for (const std::string_view candidate : candidates) {
        const std::size_t distance = editDistance(word, candidate);
        if (distance < bestDistance) {
            best = candidate;
            bestDistance = distance;
        }
    }
    return best;
}

std::string inQuotes(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            (out += '\\') += c;
        else if (c == '\n')
            out += "\\n";
        else if (static_cast<unsigned char>(c) < 0x20) {
            char code[8];
            std::snprintf(code, sizeof code, "\\u%04x", unsigned(c));
            out += code;
        } else
            out += c;
    }
    return out += '"';
}

} // namespace lucent
