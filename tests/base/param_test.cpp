#include "base/Param.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lucent {
namespace {

enum class Speed : int { Slow, Fast, Fastest };
constexpr std::string_view kSpeeds[] = {"slow", "fast", "fastest"};

// One member of each kind.
struct Knobs {
    float number = 0.1f;
    int count = 3;
    bool on = true;
    Speed speed = Speed::Fast;
    vec3 color{0.25f, 0.5f, 1};
    vec3 place{1, -2, 3};
    vec2 range{0, 1};
    vec2 across{2, 1};
    float size = 1;
    float free = 0;
};

const ParamTable& knobs() {
    static const Param params[] = {
        declare(&Knobs::number, {.id = "number", .label = "", .min = 0.1, .max = 0.9, .doc = ""}),
        declare(&Knobs::count, {.id = "count", .label = "", .min = 1, .max = 8, .doc = ""}),
        declare(&Knobs::on, {.id = "on", .label = "", .doc = ""}),
        declare(&Knobs::speed, {.id = "speed", .label = "", .doc = "", .choices = kSpeeds}),
        declare(&Knobs::color, {.id = "color", .label = "", .min = 0, .doc = "", .color = true}),
        declare(&Knobs::place, {.id = "place", .label = "", .doc = ""}),
        declare(&Knobs::range, {.id = "lightRange", .label = "", .min = 0, .max = 1, .doc = ""}),
        declare(&Knobs::across, {.id = "across", .label = "", .min = -5, .doc = "", .pair = true}),
        declare(&Knobs::size,
                {.id = "size", .label = "", .min = kAboveZero, .max = 1e3, .doc = "", .attribute = "big"}),
        declare(&Knobs::free, {.id = "free", .label = "", .max = 5, .doc = ""}),
    };
    static const ParamTable table = tableOf<Knobs>("knobs", params);
    return table;
}

const Param& knob(std::string_view id) {
    for (const Param& param : knobs().params)
        if (param.id == id) return param;
    ADD_FAILURE() << id;
    return knobs().params[0];
}

// Sets a knob by text and gives the text back, or the message.
std::string set(std::string_view id, std::string_view text) {
    Settings settings(knobs());
    void* data = static_cast<std::byte*>(settings.data()) + knob(id).offset;
    const std::string before = getText(knob(id), data);
    if (const Status status = setText(knob(id), data, text); !status) {
        EXPECT_EQ(getText(knob(id), data), before) << "a failed set must not change the value";
        return status.error().message;
    }
    return getText(knob(id), data);
}

TEST(Param, SettingsBeginWithTheDefaultsOfTheStruct) {
    const Settings settings(knobs());
    EXPECT_EQ(settings.as<Knobs>().number, 0.1f);
    EXPECT_EQ(settings.as<Knobs>().speed, Speed::Fast);
    EXPECT_EQ(settings.as<Knobs>().range, vec2(0, 1));
}

TEST(Param, DefaultsReadBackFromTheirText) {
    for (const Param& param : knobs().params) {
        Settings settings(knobs());
        void* data = static_cast<std::byte*>(settings.data()) + param.offset;
        const std::string text = getText(param, data);
        const Status status = setText(param, data, text);
        ASSERT_TRUE(status) << param.id << " " << status.error().message;
        EXPECT_EQ(getText(param, data), text);
    }
}

TEST(Param, EachKindReadsItsText) {
    EXPECT_EQ(set("number", " 0.3 "), "0.3");
    EXPECT_EQ(set("count", "8"), "8");
    EXPECT_EQ(set("on", "false"), "false");
    EXPECT_EQ(set("speed", "fastest"), "fastest");
    EXPECT_EQ(set("color", "0.1,0.2 , 0.3"), "0.1 0.2 0.3");
    EXPECT_EQ(set("color", "#ff0000"), "1 0 0");
    EXPECT_EQ(set("place", "-1 2e3 0"), "-1 2000 0");
    EXPECT_EQ(set("lightRange", "0.2 0.2"), "0.2 0.2");
    EXPECT_EQ(set("across", "3,-4"), "3 -4"); // in any order, unlike a range
}

TEST(Param, HexColoursAreSrgb) {
    Knobs values;
    ASSERT_TRUE(setText(knob("color"), &values.color, "#80Bc00"));
    EXPECT_NEAR(values.color.x, 0.215861, 1e-6); // ((128/255 + 0.055) / 1.055)^2.4
    EXPECT_NEAR(values.color.y, 0.502886, 1e-6); // of 188
    EXPECT_EQ(values.color.z, 0);
}

TEST(Param, WrongTextSaysWhatWasExpected) {
    EXPECT_EQ(set("number", "abc"), "is \"abc\"; must be a number");
    EXPECT_EQ(set("number", "1 2"), "is \"1 2\"; must be a number");
    EXPECT_EQ(set("number", "1x"), "is \"1x\"; must be a number");
    EXPECT_EQ(set("number", ""), "is \"\"; must be a number");
    EXPECT_EQ(set("count", "2.5"), "is \"2.5\"; must be an integer");
    EXPECT_EQ(set("on", "yes"), "is \"yes\"; must be true or false");
    EXPECT_EQ(set("speed", "warp"), "is \"warp\"; must be slow, fast or fastest");
    EXPECT_EQ(set("color", "#12345"), "is \"#12345\"; must be 3 numbers or #rrggbb");
    EXPECT_EQ(set("color", "#12345g"), "is \"#12345g\"; must be 3 numbers or #rrggbb");
    EXPECT_EQ(set("place", "1 2"), "is \"1 2\"; must be 3 numbers");
    EXPECT_EQ(set("lightRange", "1"), "is \"1\"; must be 2 numbers");
    EXPECT_EQ(set("across", "1 2 3"), "is \"1 2 3\"; must be 2 numbers");
}

TEST(Param, ValuesOutOfRangeSayTheRange) {
    EXPECT_EQ(set("number", "2"), "is 2; must be in [0.1, 0.9]");
    EXPECT_EQ(set("number", "0.1"), "0.1"); // the bound itself, though 0.1f lies above the double 0.1
    EXPECT_EQ(set("count", "0"), "is 0; must be in [1, 8]");
    EXPECT_EQ(set("color", "0 -1 0"), "is 0 -1 0; must be at least 0");
    EXPECT_EQ(set("size", "0"), "is 0; must be in (0, 1000]");
    EXPECT_EQ(set("free", "6"), "is 6; must be at most 5");
    EXPECT_EQ(set("place", "1 nan 2"), "is 1 nan 2; must be finite");
    EXPECT_EQ(set("place", "1e300 0 0"), "is inf 0 0; must be finite");
    EXPECT_EQ(set("across", "0 -6"), "is 0 -6; must be at least -5");
    EXPECT_EQ(set("lightRange", "0.8 0.2"), "is 0.8 0.2; the first must not be above the second");
}

TEST(Param, ComponentsAreNumbers) {
    Knobs values;
    setComponent(knob("color"), &values.color, 1, 0.75);
    setComponent(knob("speed"), &values.speed, 0, 2);
    setComponent(knob("on"), &values.on, 0, 0);
    EXPECT_EQ(values.color, vec3(0.25f, 0.75f, 1));
    EXPECT_EQ(values.speed, Speed::Fastest);
    EXPECT_FALSE(values.on);
    EXPECT_EQ(getComponent(knob("place"), &values.place, 2), 3);
    EXPECT_EQ(getComponent(knob("speed"), &values.speed, 0), 2);
}

TEST(Param, WhatIsNotShownIsInNoGroupOfThePanel) {
    Param param = knob("size");
    param.group = Group::Material;
    BoundParam bound{"x", "material", &param, nullptr, nullptr};
    EXPECT_EQ(bound.group(), Group::Material);
    bound.shown = false;
    EXPECT_EQ(bound.group(), Group::None);
}

TEST(Param, AttributesAreKebabCaseBehindTheirPrefix) {
    BoundParam bound{"x", "material", &knob("lightRange"), nullptr, nullptr};
    EXPECT_EQ(attributeName(bound), "material-light-range");
    bound.param = &knob("size");
    EXPECT_EQ(attributeName(bound), "big");
    bound.prefix = "";
    EXPECT_EQ(attributeName(bound), "");
}

} // namespace
} // namespace lucent
