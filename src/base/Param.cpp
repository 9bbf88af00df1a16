#include "base/Param.h"

#include "base/Image.h"
#include "base/Text.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lucent {
namespace {

// Any parameter's value: large and aligned enough for all kinds.
struct Value {
    alignas(float) std::byte bytes[sizeof(vec3)];
};

std::size_t sizeOf(Kind kind) {
    if (kind == Kind::Toggle) return sizeof(bool);
    return std::size_t(componentCount(kind)) * sizeof(float); // int and enum are as large as float
}
static_assert(sizeof(int) == sizeof(float));

Error expected(std::string_view found, const std::string& what) {
    return {"is " + inQuotes(found) + "; must be " + what};
}

std::string choiceList(const Param& param) {
    std::string list;
    for (const std::string_view choice : param.choices)
        (list += list.empty() ? "" : choice == param.choices.back() ? " or " : ", ") += choice;
    return list;
}

std::string kindInWords(const Param& param) {
    switch (param.kind) {
    case Kind::Number:
        return "a number";
    case Kind::Integer:
        return "an integer";
    case Kind::Toggle:
        return "true or false";
    case Kind::Choice:
        return choiceList(param);
    case Kind::Color:
        return "3 numbers or #rrggbb";
    case Kind::Vector:
        return "3 numbers";
    case Kind::Range:
    case Kind::Pair:
        return "2 numbers";
    }
    return {};
}

std::string boundsInWords(const Param& param) {
    const bool above = param.min == kAboveZero;
    const std::string low = above ? "(0" : "[" + shortest(float(param.min));
    if (param.min == -kLimitless && param.max == kLimitless) return "finite";
    if (param.max == kLimitless) return above ? "above 0" : "at least " + shortest(float(param.min));
    if (param.min == -kLimitless) return "at most " + shortest(float(param.max));
    return "in " + low + ", " + shortest(float(param.max)) + "]";
}

bool isSeparator(char c) { return c == ' ' || c == ',' || c == '\t' || c == '\n'; }

// Numbers separated by blanks or commas; empty when anything else stands there.
std::vector<double> parseNumbers(std::string_view text) {
    const std::string copy(text); // strtod wants a final zero
    std::vector<double> numbers;
    const char* at = copy.c_str();
    while (true) {
        while (isSeparator(*at))
            ++at;
        if (!*at) return at == copy.c_str() + copy.size() ? numbers : std::vector<double>();
        char* end = nullptr;
        numbers.push_back(std::strtod(at, &end));
        if (end == at || (*end && !isSeparator(*end))) return {};
        at = end;
    }
}

// "#rrggbb", sRGB, as linear light.
std::vector<double> parseHexColor(std::string_view text) {
    const std::string digits(text.substr(1));
    if (digits.size() != 6 || digits.find_first_not_of("0123456789abcdefABCDEF") != digits.npos) return {};
    const unsigned long code = std::strtoul(digits.c_str(), nullptr, 16);
    std::vector<double> rgb;
    for (const int shift : {16, 8, 0})
        rgb.push_back(linearFromSrgb(float((code >> shift) & 255) / 255));
    return rgb;
}

// One number a component, as setComponent() takes them; empty when the text is of another kind.
std::vector<double> parse(const Param& param, std::string_view text) {
    while (!text.empty() && isSeparator(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && isSeparator(text.back()))
        text.remove_suffix(1);
    std::vector<double> numbers;
    if (param.kind == Kind::Toggle) {
        if (text == "true" || text == "false") numbers = {double(text == "true")};
    } else if (param.kind == Kind::Choice) {
        const auto found = std::find(param.choices.begin(), param.choices.end(), text);
        if (found != param.choices.end()) numbers = {double(found - param.choices.begin())};
    } else if (param.kind == Kind::Color && text.starts_with('#')) {
        numbers = parseHexColor(text);
    } else {
        numbers = parseNumbers(text);
    }
    if (numbers.size() != std::size_t(componentCount(param.kind))) return {};
    const bool whole = std::abs(numbers[0]) <= 1e9 && numbers[0] == std::floor(numbers[0]);
    if (param.kind == Kind::Integer && !whole) return {};
    return numbers;
}

} // namespace

std::string_view name(Group group) {
    constexpr std::string_view names[] = {
        "",         "Mode",        "Light",        "Material", "Falloff",      "Subsurface", "Refraction",
        "Caustics", "Environment", "Height field", "Shape",    "Displacement", "Waves",      "View"};
    return names[int(group)];
}

Settings::Settings(const ParamTable& table) : table_(&table), bytes_(table.size) {
    std::memcpy(bytes_.data(), table.defaults, table.size);
}

int componentCount(Kind kind) {
    if (kind == Kind::Color || kind == Kind::Vector) return 3;
    return kind == Kind::Range || kind == Kind::Pair ? 2 : 1;
}

std::string getText(const Param& param, const void* data) {
    if (param.kind == Kind::Toggle) return getComponent(param, data, 0) != 0 ? "true" : "false";
    if (param.kind == Kind::Choice)
        return std::string(param.choices[std::size_t(getComponent(param, data, 0))]);
    std::string text;
    for (int i = 0; i < componentCount(param.kind); ++i)
        text +=
            (i ? " " : "") + (param.kind == Kind::Integer ? std::to_string(int(getComponent(param, data, i)))
                                                          : shortest(float(getComponent(param, data, i))));
    return text;
}

Status setText(const Param& param, void* data, std::string_view text) {
    const std::vector<double> numbers = parse(param, text);
    if (numbers.empty()) return expected(text, kindInWords(param));
    Value value;
    for (int i = 0; i < int(numbers.size()); ++i)
        setComponent(param, &value, i, numbers[std::size_t(i)]);
    if (Status legal = checkRange(param, &value); !legal) return legal;
    std::memcpy(data, &value, sizeOf(param.kind));
    return Done{};
}

double getComponent(const Param& param, const void* data, int component) {
    switch (param.kind) {
    case Kind::Toggle:
        return *static_cast<const bool*>(data);
    case Kind::Integer:
    case Kind::Choice: {
        int number; // an enum's storage, read without aliasing it
        std::memcpy(&number, data, sizeof number);
        return number;
    }
    default:
        return static_cast<const float*>(data)[component];
    }
}

void setComponent(const Param& param, void* data, int component, double value) {
    switch (param.kind) {
    case Kind::Toggle:
        *static_cast<bool*>(data) = value != 0;
        break;
    case Kind::Integer:
    case Kind::Choice: {
        const int number = int(value);
        std::memcpy(data, &number, sizeof number);
        break;
    }
    default:
        static_cast<float*>(data)[component] = float(value);
    }
}

Status checkRange(const Param& param, const void* data) {
    // Floats are compared with the bounds as floats: 0.1f lies above the double 0.1.
    const bool isFloat =
        param.kind != Kind::Integer && param.kind != Kind::Choice && param.kind != Kind::Toggle;
    const double min = isFloat ? float(param.min) : param.min, max = isFloat ? float(param.max) : param.max;
    for (int i = 0; i < componentCount(param.kind) && param.kind != Kind::Choice; ++i) {
        const double value = getComponent(param, data, i);
        if (!std::isfinite(value)) return Error{"is " + getText(param, data) + "; must be finite"};
        if (value < min || value > max)
            return Error{"is " + getText(param, data) + "; must be " + boundsInWords(param)};
    }
    if (param.kind == Kind::Range && getComponent(param, data, 0) > getComponent(param, data, 1))
        return Error{"is " + getText(param, data) + "; the first must not be above the second"};
    return Done{};
}

std::string attributeName(const BoundParam& bound) {
    if (bound.prefix.empty()) return {};
    if (!bound.param->attribute.empty()) return std::string(bound.param->attribute);
    std::string attribute = bound.prefix + "-";
    for (const char c : bound.param->id) {
        if (c >= 'A' && c <= 'Z')
            (attribute += '-') += char(c - 'A' + 'a');
        else
            attribute += c;
    }
    return attribute;
}

} // namespace lucent
