#pragma once
/// The GL context of a test program. Without one a test skips visibly; LUCENT_REQUIRE_GL=1 makes that a
/// failure.

#include "gl/Context.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace lucent::support {

struct GlTest : testing::Test {
    static inline gl::Context* context = nullptr; // one for the whole program: drivers are slow to start

    void SetUp() override {
        static auto made = gl::Context::create();
        if (!made) {
            if (std::getenv("LUCENT_REQUIRE_GL")) FAIL() << made.error().message;
            GTEST_SKIP() << made.error().message;
        }
        context = made->get();
    }
    void TearDown() override {
        if (!context) return;
        EXPECT_EQ(context->takeError(), "");
    }
};

} // namespace lucent::support
