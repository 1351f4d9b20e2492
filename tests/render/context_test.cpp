#include "app/render/context.h"

#include <cstdlib>
#include <stdexcept>

#include <gtest/gtest.h>

namespace plumb {
namespace {

// Under ctest each test of this program runs in its own process; without ctest, later tests do not
// need a display either.
void hide_displays() {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
}

TEST(Context, ChoicesHaveNames) {
    EXPECT_EQ(gl_choice_from_name("auto"), GlChoice::automatic);
    EXPECT_EQ(gl_choice_from_name("window"), GlChoice::window);
    EXPECT_EQ(gl_choice_from_name("osmesa"), GlChoice::osmesa);
    EXPECT_THROW((void)gl_choice_from_name("egl"), std::invalid_argument);
}

TEST(Context, OffScreenIsOsmesaWithoutALookAtTheDisplay) {
    ContextRequest request;
    request.off_screen = true;
    const ContextResult result = create_context(request);
    EXPECT_STREQ(result.context->kind(), "osmesa");
    EXPECT_EQ(result.context->window(), nullptr);
    EXPECT_TRUE(result.why_no_window.empty());
    EXPECT_NE(result.context->renderer().find("llvmpipe"), std::string::npos)
        << result.context->renderer();
    EXPECT_FALSE(result.context->version().empty());
}

TEST(Context, WithoutADisplayAutomaticFallsBackAndSaysWhy) {
    hide_displays();
    const ContextResult result = create_context({});
    EXPECT_STREQ(result.context->kind(), "osmesa");
    EXPECT_FALSE(result.why_no_window.empty());
}

TEST(Context, WithoutADisplayAWindowIsRefusedWithTheReason) {
    hide_displays();
    ContextRequest request;
    request.choice = GlChoice::window;
    try {
        (void)create_context(request);
        FAIL() << "a window without a display";
    } catch (const ContextError &error) {
        EXPECT_NE(std::string(error.what()).find("window: "), std::string::npos) << error.what();
    }
}

} // namespace
} // namespace plumb
