#include "app/lab/run/method_choice.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(MethodChoice, SaysAReasonOnce) {
    const std::vector<std::string> reasons{
        "a does not support joints, and the scene has 1",
        "b cannot run this scene: the adapter does not support cloth",
        "c does not support joints, and the scene has 1",
        "d does not support contacts, and the scene has 2 bodies",
        "e does not support joints, and the scene has 1",
        "f cannot run this scene: the adapter does not support cloth"};
    EXPECT_EQ(grouped_reasons(reasons),
              (std::vector<std::string>{
                  "a, c and e do not support joints, and the scene has 1",
                  "b and f cannot run this scene: the adapter does not support cloth",
                  "d does not support contacts, and the scene has 2 bodies"}));
    EXPECT_EQ(why_no_method({reasons[0], reasons[3]}),
              "no method can run this scene: a does not support joints, and the scene has 1; "
              "d does not support contacts, and the scene has 2 bodies");
    EXPECT_TRUE(grouped_reasons({}).empty());
}

} // namespace
} // namespace plumb
