#include "app/lab/run/method_choice.h"

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(MethodChoice, SaysAReasonOnce) {
    EXPECT_EQ(grouped_reasons({"a knows no joints, and the scene has 1",
                               "b is not told of what the scene has: cloth",
                               "c knows no joints, and the scene has 1",
                               "d knows no contacts, and the scene has 2 bodies",
                               "e knows no joints, and the scene has 1",
                               "f is not told of what the scene has: cloth"}),
              (std::vector<std::string>{"a, c and e know no joints, and the scene has 1",
                                        "b and f are not told of what the scene has: cloth",
                                        "d knows no contacts, and the scene has 2 bodies"}));
    EXPECT_TRUE(grouped_reasons({}).empty());
}

} // namespace
} // namespace plumb
