#include "base/JsonWriter.h"

#include "base/Text.h"

#include <cassert>
#include <cmath>

namespace lucent {

void JsonWriter::newLine() {
    text_ += '\n';
    text_.append(2 * levels_.size(), ' ');
}

JsonWriter& JsonWriter::begin(char open, char close) {
    raw(std::string_view(&open, 1));
    levels_.push_back({close});
    return *this;
}

JsonWriter& JsonWriter::end() {
    assert(!levels_.empty() && !afterKey_);
    const Level level = levels_.back();
    levels_.pop_back();
    if (!level.empty) newLine();
    text_ += level.close;
    return *this;
}

JsonWriter& JsonWriter::key(std::string_view name) {
    assert(!levels_.empty() && levels_.back().close == '}');
    raw(inQuotes(name));
    text_ += ": ";
    afterKey_ = true;
    return *this;
}

JsonWriter& JsonWriter::value(std::string_view text) { return raw(inQuotes(text)); }
JsonWriter& JsonWriter::value(float number) { return raw(std::isfinite(number) ? shortest(number) : "null"); }
JsonWriter& JsonWriter::value(double number) {
    return raw(std::isfinite(number) ? shortest(number) : "null");
}

JsonWriter& JsonWriter::value(std::span<const float> numbers) {
    std::string list;
    for (const float number : numbers)
        list += (list.empty() ? "" : ", ") + shortest(number);
    return raw("[" + list + "]");
}

JsonWriter& JsonWriter::raw(std::string_view json) {
    if (!afterKey_ && !levels_.empty()) {
        if (!levels_.back().empty) text_ += ',';
        levels_.back().empty = false;
        newLine();
    }
    afterKey_ = false;
    text_ += json;
    return *this;
}

std::string JsonWriter::text() const {
    assert(levels_.empty());
    return text_ + "\n";
}

} // namespace lucent
