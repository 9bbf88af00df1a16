#include "scene/Json.h"

#include <gtest/gtest.h>

namespace lucent::scene {
namespace {

Result<Json> parse(std::string_view text) {
    return parseJson(std::as_bytes(std::span(text.data(), text.size())), "a.json");
}

std::string messageOf(std::string_view text) {
    const Result<Json> json = parse(text);
    return json ? "no error" : json.error().message;
}

TEST(Json, KeepsValuesAndTheirLines) {
    const Result<Json> json =
        parse("{ \"a\": 1,\n  \"b\": [true,\n -2.5\n],\n\"c\": { \"d\": null,\n \"e\": \"x\" } }");
    ASSERT_TRUE(json);
    EXPECT_EQ(json->keys, (std::vector<std::string>{"a", "b", "c"}));
    EXPECT_EQ(json->find("a")->number, 1);
    EXPECT_EQ(json->find("a")->line, 1); // not 2, though the parser has read the line feed behind the comma
    EXPECT_EQ(json->find("b")->line, 2);
    EXPECT_TRUE(json->find("b")->items[0].boolean);
    EXPECT_EQ(json->find("b")->items[1].number, -2.5);
    EXPECT_EQ(json->find("c")->line, 5);
    EXPECT_EQ(json->find("c")->find("d")->type, Json::Type::Null);
    EXPECT_EQ(json->find("c")->find("e")->string, "x");
    EXPECT_EQ(json->find("c")->find("e")->line, 6);
    EXPECT_EQ(json->find("z"), nullptr);
    EXPECT_EQ(json->find("a")->find("z"), nullptr);
}

TEST(Json, NumberBeforeALineFeedKeepsItsKeysLine) { EXPECT_EQ(parse("{\n\"a\": 7\n}")->find("a")->line, 2); }

TEST(Json, SyntaxErrorsNameLineAndColumn) {
    EXPECT_EQ(messageOf("{ \"a\": 1,\n  }"), "a.json:2:3: unexpected '}'; expected string literal");
    EXPECT_EQ(messageOf("{ \"a\": tru }"), "a.json:1:11: invalid literal; last read: '\"a\": tru '");
    EXPECT_EQ(messageOf("{ \"a\": 1 "), "a.json:1:9: unexpected end of input; expected '}'");
    EXPECT_EQ(messageOf(""), "a.json:1:0: unexpected end of input; expected '[', '{', or a literal");
}

TEST(Json, KeyGivenTwiceIsRefused) {
    EXPECT_EQ(messageOf("{ \"a\": 1,\n\"a\": 2 }"),
              "a.json:2:3: key \"a\" stands here twice; must be unique");
}

TEST(Json, DeepNestingIsRefused) {
    EXPECT_EQ(messageOf(std::string(100000, '[')), "a.json:1:33: nested deeper than 32; must be flatter");
    EXPECT_EQ(messageOf(std::string(32, '[') + std::string(32, ']')), "no error");
}

} // namespace
} // namespace lucent::scene
