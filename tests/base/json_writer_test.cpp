#include "base/JsonWriter.h"

#include <gtest/gtest.h>

#include <limits>

namespace lucent {
namespace {

TEST(JsonWriter, PutsCommasAndIndentsWhereTheyBelong) {
    JsonWriter json;
    const float numbers[] = {0.1f, 2};
    json.beginObject();
    json.key("a").value(1).key("b").value("x\"y").key("c").value(std::span<const float>(numbers));
    json.key("d").beginArray().value(true).value(0.25f).beginObject().end().end();
    json.key("e").beginArray().end();
    json.end();
    EXPECT_EQ(json.text(), "{\n  \"a\": 1,\n  \"b\": \"x\\\"y\",\n  \"c\": [0.1, 2],\n"
                           "  \"d\": [\n    true,\n    0.25,\n    {}\n  ],\n  \"e\": []\n}\n");
}

TEST(JsonWriter, InfinityAndNaNBecomeNull) {
    JsonWriter json;
    json.beginArray()
        .value(std::numeric_limits<float>::infinity())
        .value(std::numeric_limits<double>::quiet_NaN())
        .end();
    EXPECT_EQ(json.text(), "[\n  null,\n  null\n]\n");
}

} // namespace
} // namespace lucent
