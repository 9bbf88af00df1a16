#pragma once
/// Writes JSON text. Commas, indentation and escapes are its business; order and meaning the caller's.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lucent {

class JsonWriter {
public:
    JsonWriter& beginObject() { return begin('{', '}'); }
    JsonWriter& beginArray() { return begin('[', ']'); }
    JsonWriter& end();
    /// Names the value that comes next; inside objects only.
    JsonWriter& key(std::string_view name);

    JsonWriter& value(std::string_view text);
    JsonWriter& value(const char* text) { return value(std::string_view(text)); }
    JsonWriter& value(bool truth) { return raw(truth ? "true" : "false"); }
    JsonWriter& value(int number) { return raw(std::to_string(number)); }
    /// Shortest form that reads back to the same value. JSON has no infinity and no NaN: they become null.
    JsonWriter& value(float number);
    JsonWriter& value(double number);
    /// Numbers on one line: [0.1, 0.2, 0.3]
    JsonWriter& value(std::span<const float> numbers);
    /// Text that is JSON already.
    JsonWriter& raw(std::string_view json);

    /// Everything written, ended by a line feed. All objects and arrays must be closed.
    std::string text() const;

private:
    JsonWriter& begin(char open, char close);
    void newLine();
    struct Level {
        char close;
        bool empty = true;
    };
    std::string text_;
    std::vector<Level> levels_;
    bool afterKey_ = false;
};

} // namespace lucent
