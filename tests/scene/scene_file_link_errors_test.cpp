// Every error in a scene file's expectations and states.
#include "tests/scene/scene_file_errors.h"

namespace plumb {
namespace {

using namespace scene_file_errors;

const std::vector<SceneFileError> &errors() {
    static const std::vector<SceneFileError> all{
        {"ExpectUnknownQuantity",
         R"([[expect]]
name = "e"
quantity = @"enregy"
to = 1
at_most = 1
source = "x"
)",
         {R"(unknown quantity "enregy"; did you mean "energy"?)"}},
        {"ExpectMissingBody",
         R"(@[[expect]]
name = "e"
quantity = "speed"
to = 1
at_most = 1
source = "x"
)",
         {R"([[expect]] "e" has no body; speed is measured on one body: which?)"}},
        {"ExpectUnwantedBody",
         ball + expect + R"(@body = "ball"
to = 1
at_most = 1
)",
         {"energy has no body; it is measured on the whole scene"}},
        {"ExpectUnknownBody",
         ball + R"([[expect]]
name = "e"
quantity = "speed"
body = @"balk"
to = 1
at_most = 1
source = "x"
)",
         {R"(there is no body "balk"; did you mean "ball"?)"}},
        {"ExpectUnknownReduction",
         expect + R"(reduce = @"maxabs"
to = 1
at_most = 1
)",
         {R"(unknown reduce "maxabs"; did you mean "max_abs"?)"}},
        {"ExpectUnwantedLevel",
         expect + R"(@level = 1
to = 1
at_most = 1
)",
         {R"(reduce = "last" has no level; period, crossings and first_crossing have one)"}},
        {"ExpectWindowReversed",
         expect + R"(from = @2
to = 1
at_most = 1
)",
         {"the window from 2 to 1 s is empty; from must not be after to"}},
        {"ExpectWindowEmpty",
         expect + R"(to = @0
at_most = 1
)",
         {"the window ends at 0 s; to must be later than the start"}},
        {"ExpectNoEnd",
         R"(@[[expect]]
name = "e"
quantity = "energy"
at_most = 1
source = "x"
)",
         {R"([[expect]] "e" has no to; to = seconds, the end of the window and of the run)"}},
        {"ExpectNoRelation",
         R"(@[[expect]]
name = "e"
quantity = "energy"
to = 1
source = "x"
)",
         {R"([[expect]] "e" has none of equals, at_most, at_least; what must the number be?)"}},
        {"ExpectTwoRelations",
         expect + R"(to = 1
at_most = 1
@at_least = 0
)",
         {R"([[expect]] "e" has both at_most and at_least; keep one of them)"}},
        {"ExpectNoTolerance",
         R"(@[[expect]]
name = "e"
quantity = "energy"
to = 1
equals = 1
source = "x"
)",
         {R"([[expect]] "e" has no tolerance; the allowed error, in the quantity's unit)"}},
        {"ExpectZeroTolerance",
         expect + R"(to = 1
equals = 1
tolerance = @0
)",
         {"tolerance is 0; it must be a number above 0"}},
        {"ExpectToleranceOfBound",
         expect + R"(to = 1
at_most = 1
@tolerance = 1
)",
         {"a bound has no tolerance; include it in the bound"}},
        {"ExpectEstimateOfBound",
         expect + R"(to = 1
at_most = 1
@estimate = 0
)",
         {"a bound has no estimate; only a truth found by refinement has one"}},
        {"ExpectCoarseEstimate",
         expect + R"(to = 1
equals = 1
tolerance = 0.5
estimate = @0.05
)",
         {"the estimate of 0.05 is not less than a tenth of the tolerance of 0.5; a truth must be "
          "known ten times more accurately than its tolerance; `plumb reference SCENE --write` "
          "refines it"}},
        {"ExpectNegativeEstimate",
         expect + R"(to = 1
equals = 1
tolerance = 0.5
estimate = @-0.01
)",
         {"estimate is -0.01; it must be a number from 0 to 1e9"}},
        {"ExpectShortCurve",
         expect + R"(to = 1
reduce = "mean"
equals = @[1, 2, 3]
tolerance = 0.5
)",
         {"equals is a curve of 3 values; write at least 4, evenly spaced from the start of the "
          "window to its end; `plumb reference SCENE --write` computes them if there is an "
          "estimate"}},
        {"ExpectCurveOfAnInstant",
         expect + R"(from = @1
to = 1
reduce = "max"
equals = [1, 2, 3, 4]
tolerance = 0.5
)",
         {"the curve's window is the single instant 1 s; from must be before to"}},
        {"ExpectCurveWithoutWindow",
         R"(@[[expect]]
name = "e"
quantity = "energy"
reduce = "max"
equals = [1, 2, 3, 4]
tolerance = 0.5
source = "x"
)",
         {R"([[expect]] "e" has no to; to = seconds, the end of the window and of the run)"}},
        {"ExpectCurveNotFinite",
         expect + R"(to = 1
reduce = "max"
equals = [1, @inf, 3,
    @nan, @"5"]
tolerance = 0.5
)",
         {"equals[1] is inf; it must be a finite number",
          "equals[3] is nan; it must be a finite number",
          "equals[4] is a string; it must be a finite number"}},
        {"ExpectCurveOtherwiseReduced",
         expect + R"(to = 1
reduce = @"period"
equals = [1, 2, 3, 4]
tolerance = 0.5
)",
         {R"(equals is a curve, and reduce = "period"; the distance from a curve can be reduced by "max" or "mean")"}},
        {"ExpectCurveReducedByDefault",
         expect + R"(to = 1
equals = @[1, 2, 3, 4]
tolerance = 0.5
)",
         {R"(equals is a curve, and reduce = "last"; the distance from a curve can be reduced by "max" or "mean")"}},
        {"ExpectCurveAsBound",
         expect + R"(to = 1
reduce = "max"
at_most = @[1, 2, 3, 4]
)",
         {"at_most is an array; it must be a finite number"}},
        {"ExpectNoSource",
         R"(@[[expect]]
name = "e"
quantity = "energy"
to = 1
at_most = 1
)",
         {R"([[expect]] "e" has no source; where does the number come from?)"}},
        {"ExpectEmptySource",
         R"([[expect]]
name = "e"
quantity = "energy"
to = 1
at_most = 1
source = @""
)",
         {"the source is empty; where does the number come from?"}},
        {"StateStep",
         R"([state]
step = @-1
)",
         {"step is not a natural number; it must be a whole number from 0 to 2^64 - 1 (in quotes "
          "from 2^63 on)"}},
        {"StateUnknownKey",
         R"([state]
@steps = 1
)",
         {R"(unknown key "steps" in [state]; did you mean "step"?)"}},
        {"StateClock",
         R"([state]
step = 3
dt_since_step = @4
)",
         {"dt was changed after step 4 of 3; it must be at most `step`"}},
        {"StateClockWithoutAStep",
         R"([state]
step = 3
dt_since_time = @0.5
)",
         {"dt was changed at a time, but after no step; dt_since_step says after which"}},
        {"GrabOfNothing",
         two + R"(@[state.grab]
target = [0, 0, 0]
)",
         {"[state.grab] has none of body, particle; a grab holds one body, or one particle",
          "[state.grab] has no max_force; the greatest force, in N"}},
        {"GrabOfTwo",
         two + R"([state.grab]
body = "a"
@particle = "p"
target = [0, 0, 0]
max_force = 1
)",
         {"[state.grab] has both body and particle; keep one of them"}},
        {"GrabOfUnknownParticle",
         two + R"([state.grab]
particle = @"p"
target = [0, 0, 0]
max_force = 1
held_mass = @-1
)",
         {R"(there is no particle "p")", "held_mass is -1; it must be a number of at least 0"}},
        {"ContactUnknownBody",
         two + R"([[state.contact]]
body_a = "a"
body_b = @"d"
features = []
impulses = []
)",
         {R"(there is no body "d"; choose from a, b)"}},
        {"ContactWithItself",
         two + R"([[state.contact]]
body_a = "a"
body_b = @"a"
features = []
impulses = []
)",
         {"a body is in contact with itself; body_a and body_b must differ"}},
        {"ContactCounts",
         two + R"([[state.contact]]
body_a = "a"
body_b = "b"
features = [1, 2]
impulses = @[[0, 0, 0]]
)",
         {"there are 2 features and 1 impulses; the numbers must match"}},
        {"ContactFeature",
         two + R"([[state.contact]]
body_a = "a"
body_b = "b"
features = [@4294967296]
impulses = [[0, @nan, 0]]
)",
         {"features[0] is 4294967296; it must be a whole number from 0 to 4294967295",
          "impulses[0][1] is nan; it must be a finite number"}},
        {"ContactTriangle",
         two + R"([[state.contact]]
body_a = "a"
body_b = "b"
triangle = @4294967296
features = []
impulses = []
)",
         {"no surface has a triangle 4294967296; triangles are numbered from 0; 4294967294 stands "
          "for "
          "the inside of a solid surface"}},
        {"ContactMissing",
         two + R"(@[[state.contact]]
body_a = "a"
body_b = "b"
impulses = []
)",
         {"[[state.contact]] has no features; an array, one element for each contact point"}},
    };
    return all;
}

class SceneFileLinkErrors : public testing::TestWithParam<SceneFileError> {};

TEST_P(SceneFileLinkErrors, PointAndExplain) {
    expect_messages(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, SceneFileLinkErrors, testing::ValuesIn(errors()),
                         [](const auto &each) { return each.param.name; });

} // namespace
} // namespace plumb
