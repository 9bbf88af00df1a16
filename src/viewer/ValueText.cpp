#include "viewer/ValueText.h"

#include "base/Image.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace lucent::viewer {

namespace {

std::string print(const char* format, int precision, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, precision, value);
    return text;
}

// Decimals of a slider's steps: a hundred or more of them between its ends.
int decimals(const Param& param) {
    if (param.kind == Kind::Integer) return 0;
    return std::clamp(int(std::ceil(2 - std::log10(param.high - param.low) - 1e-6)), 0, 6);
}

// Without an exponent where it is large.
std::string threeDigits(double value) {
    const std::string text = print("%.*g", 3, value);
    return std::abs(value) < 1000 ? text : print("%.*f", 0, std::strtod(text.c_str(), nullptr));
}

} // namespace

std::string numberText(const Param& param, double value) {
    if (param.kind == Kind::Integer) return print("%.*f", 0, value);
    if (param.logarithmic) return threeDigits(value);
    const double coarsest = 0.01 * (param.high - param.low) / 100;
    int digits = decimals(param);
    for (int more = 0; more < 2; ++more) {
        const double shown = std::strtod(print("%.*f", digits, value).c_str(), nullptr);
        if (std::abs(shown - value) < coarsest) break;
        ++digits;
    }
    return print("%.*f", digits, value);
}

std::string withUnit(const Param& param, const std::string& number) {
    if (param.unit.empty()) return number;
    return number + (param.unit == "degrees" ? "°" : " " + std::string(param.unit));
}

double placeOf(const Param& param, double value) {
    const double t = param.logarithmic
                         ? std::log(std::max(value, 1e-30) / param.low) / std::log(param.high / param.low)
                         : (value - param.low) / (param.high - param.low);
    return std::clamp(t, 0.0, 1.0);
}

std::string valueAt(const Param& param, double t) {
    if (param.logarithmic) return threeDigits(param.low * std::pow(param.high / param.low, t));
    return print("%.*f", decimals(param), param.low + t * (param.high - param.low));
}

std::vector<std::string> componentTexts(const BoundParam& bound) {
    std::vector<std::string> parts(1);
    for (const char c : getText(*bound.param, bound.data)) {
        if (c == ' ')
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

std::string withComponent(const BoundParam& bound, int component, const std::string& text) {
    if (component < 0) return text;
    std::vector<std::string> parts = componentTexts(bound);
    parts[std::size_t(component)] = text;
    std::string joined;
    for (const std::string& part : parts)
        joined += (joined.empty() ? "" : " ") + part;
    return joined;
}

vec3 encoded(const BoundParam& bound) {
    vec3 color;
    for (int i = 0; i < 3; ++i)
        color[i] = srgbFromLinear(std::clamp(float(getComponent(*bound.param, bound.data, i)), 0.0f, 1.0f));
    return color;
}

std::string hexText(vec3 color) {
    char text[16];
    const auto byte = [&](int i) { return unsigned(std::lround(color[i] * 255)); };
    std::snprintf(text, sizeof text, "#%02x%02x%02x", byte(0), byte(1), byte(2));
    return text;
}

std::string colorText(const BoundParam& bound) {
    std::string numbers;
    bool inRange = true;
    for (int i = 0; i < 3; ++i) {
        const double value = getComponent(*bound.param, bound.data, i);
        inRange = inRange && value <= 1;
        numbers += (i ? " " : "") + print("%.*f", 2, value);
    }
    return inRange ? hexText(encoded(bound)) : numbers;
}

} // namespace lucent::viewer
