// Every error in a scene file's joints.
#include "tests/scene/scene_file_errors.h"

namespace plumb {
namespace {

using namespace scene_file_errors;

const std::string hinge = "[[joint]]\nname = \"j\"\ntype = \"hinge\"\nbody_b = \"b\"\n"
                          "anchor = [0, 0, 0]\naxis = [0, 1, 0]\n";
const std::string slider = "[[joint]]\nname = \"j\"\ntype = \"slider\"\nbody_b = \"b\"\n"
                           "anchor = [0, 0, 0]\naxis = [0, 1, 0]\n";
const std::string rope = "[[joint]]\nname = \"j\"\ntype = \"distance\"\nbody_a = \"a\"\n"
                         "body_b = \"b\"\n";

const std::vector<SceneFileError> &errors() {
    static const std::vector<SceneFileError> all{
        {"JointMissingType",
         two + R"(@[[joint]]
name = "j"
body_a = "a"
body_b = "b"
anchor = [0, 0, 0]
)",
         {R"([[joint]] "j" has no type; type = "ball", "distance", "hinge", "slider" or "fixed")"}},
        {"JointUnknownType",
         two + R"([[joint]]
name = "j"
type = @"bal"
body_a = "a"
body_b = "b"
anchor = [0, 0, 0]
)",
         {R"(unknown type "bal"; did you mean "ball"?)"}},
        {"JointUnknownBody",
         two + R"([[joint]]
name = "j"
type = "ball"
body_a = @"c"
body_b = @"nowhere"
anchor = [0, 0, 0]
)",
         {R"(there is no body "c"; choose from a, b)",
          R"(there is no body "nowhere"; choose from a, b)"}},
        {"JointNearBody",
         ball + R"([[joint]]
name = "j"
type = "ball"
body_a = @"bal"
anchor = [0, 0, 0]
)",
         {R"(there is no body "bal"; did you mean "ball"?)"}},
        {"JointRepeatedBody",
         chain + R"([[joint]]
name = "j"
type = "ball"
body_a = @"link"
anchor = [0, 0, 0]
)",
         {R"(the body "link" is repeated, so there are many; name one of link_0 to link_3)"}},
        {"JointWorldToItself",
         two + R"(@[[joint]]
name = "j"
type = "ball"
body_b = "world"
anchor = [0, 0, 0]
)",
         {R"([[joint]] "j" joins the world to itself; give body_a or body_b the name of a body)"}},
        {"JointBodyToItself",
         two + R"([[joint]]
name = "j"
type = "ball"
body_a = "a"
body_b = @"a"
anchor = [0, 0, 0]
)",
         {R"([[joint]] "j" joins a body to itself; body_a and body_b must differ)"}},
        {"JointNoAnchor",
         two + R"(@[[joint]]
name = "j"
type = "ball"
body_a = "a"
body_b = "b"
anchor_a = [0, 0, 0]
)",
         {R"([[joint]] "j" has no anchor_b; anchor = [x, y, z] is one world point for both bodies, anchor_b one for this body, anchor_b_local one in its frame)"}},
        {"JointTwoAnchors",
         two + joint + R"(anchor = [0, 0, 0]
@anchor_b = [0, 0, 0]
)",
         {R"([[joint]] "j" has both anchor and anchor_b; keep one of them)"}},
        {"JointAnchorIsWrong",
         two + joint + R"(anchor = [0, 0, @nan]
)",
         {"anchor[2] is nan; it must be a number between -1e9 and 1e9"}},
        {"BallJointLength",
         two + joint + R"(anchor = [0, 0, 0]
@length = 3
)",
         {R"(a ball joint has no length; it belongs to type = "distance")"}},
        {"DistanceJointOfNoLength",
         two + R"(@[[joint]]
name = "j"
type = "distance"
body_a = "a"
body_b = "b"
anchor = [0, 0, 0]
)",
         {R"(the anchors of [[joint]] "j" are 0 m apart, which cannot be its length; give it a length: a positive number, from 1e-9 to 1e9)"}},
        {"DuplicateJoint",
         two + joint + R"(anchor = [0, 0, 0]
[[joint]]
name = @"j"
type = "distance"
body_a = "a"
body_b = "b"
)",
         {R"(another joint is already named "j", at line 11; each joint needs a name of its own)"}},
        {"ChainOfSingle",
         two + R"([[joint]]
name = "j"
type = "ball"
chain = @"a"
)",
         {R"(the body "a" is not repeated; a chain connects the copies of a body with repeat)"}},
        {"ChainUnknown",
         chain + R"([[joint]]
name = "j"
type = "ball"
chain = @"lnik"
)",
         {R"(there is no body "lnik"; did you mean "link"?)"}},
        {"ChainOfOne",
         ball + R"(repeat = { kind = "stack", count = 1 }
[[joint]]
name = "j"
type = "ball"
chain = @"ball"
)",
         {R"(there is only one "ball"; a chain needs at least two bodies)"}},
        {"ChainWithBody",
         chain + R"([[joint]]
name = "j"
type = "ball"
chain = "link"
@body_a = "link_0"
)",
         {"a chain has no body_a; its bodies are the copies of a repeated body, its anchors are in "
          "their frames: anchor_a_local, anchor_b_local"}},
        {"ChainWithOneAnchor",
         chain + R"([[joint]]
name = "j"
type = "ball"
chain = "link"
anchor_a_local = @[1, 0, 0]
)",
         {R"([[joint]] "j" has only one of anchor_a_local and anchor_b_local; give both, or neither: a distance joint then connects the centres, any other sits halfway between them)"}},
        {"JointKeysOfOthers",
         two + joint + R"(anchor = [0, 0, 0]
@axis = [1, 0, 0]
@limits_deg = [0, 90]
@frame_a_local = [1, 0, 0, 0]
)",
         {R"(a ball joint has no axis; it belongs to type = "hinge" or "slider")",
          R"(a ball joint has no limits_deg; it belongs to type = "hinge")",
          R"(a ball joint has no frame_a_local; it belongs to type = "hinge", "slider" or "fixed")"}},
        {"SliderHasNoDegrees",
         two + slider + R"(@motor_speed_deg = 90
max_motor_force = 2
)",
         {R"(a slider joint has no motor_speed_deg; it belongs to type = "hinge")"}},
        {"HingeWithoutAxis",
         two + R"(@[[joint]]
name = "j"
type = "hinge"
body_b = "b"
anchor = [0, 0, 0]
)",
         {R"([[joint]] "j" has none of axis, frame_a_local; axis = [x, y, z] is a unit vector in world coordinates at the start)"}},
        {"HingeWithAxisAndFrames",
         two + hinge + R"(@frame_a_local = [1, 0, 0, 0]
@frame_b_local = [1, 0, 0, 0]
)",
         {R"([[joint]] "j" has both axis and frame_a_local; keep one of them)",
          R"([[joint]] "j" has both axis and frame_b_local; keep one of them)"}},
        {"FixedWithOneFrame",
         two + R"([[joint]]
name = "j"
type = "fixed"
body_b = "b"
anchor = [0, 0, 0]
frame_b_local = @[1, 0, 0, 0]
)",
         {R"([[joint]] "j" has only one of frame_a_local and frame_b_local; a joint has a frame in each body)"}},
        {"AxisIsNoDirection",
         two + R"([[joint]]
name = "j"
type = "slider"
body_b = "b"
anchor = [0, 0, 0]
axis = @[0, 0, 0]
)",
         {"axis has length 0, not 1; it cannot be normalised"}},
        {"LimitsTheWrongWayRound",
         two + hinge + R"(limits_deg = @[90, -90]
)",
         {"the lower value of limits_deg is above the upper; write [lower, upper]"}},
        {"LimitsBeyondHalfATurn",
         two + hinge + R"(limits = [@-4, 0]
)",
         {"limits[0] is -4; it must be an angle from -180 to 180 degrees"}},
        {"LimitsTwice",
         two + hinge + R"(limits_deg = [0, 90]
@limits = [0, 1]
)",
         {R"([[joint]] "j" has both limits_deg and limits; keep one of them)"}},
        {"LimitsOfOneNumber",
         two + slider + R"(limits = @[1]
)",
         {"limits has 1 elements; it must be an array of 2 numbers"}},
        {"MotorWithoutForce",
         two + hinge + R"(motor_speed_deg = @90
)",
         {R"([[joint]] "j" has motor_speed_deg but no max_motor_force; give max_motor_force, the motor's maximum torque (N m))"}},
        {"DampingOfWhatIsRigid",
         two + joint + R"(anchor = [0, 0, 0]
damping_ratio = @0.5
)",
         {R"([[joint]] "j" has damping_ratio but no frequency; give frequency, the natural frequency of its spring with the bodies on it (Hz))"}},
        {"NegativeFrequency",
         two + joint + R"(anchor = [0, 0, 0]
frequency = @-1
)",
         {"frequency is -1; it must be a number from 0 to 1e9"}},
        {"MisspeltKey",
         two + joint + R"(anchor = [0, 0, 0]
@brake_force = 1
)",
         {R"(unknown key "brake_force" in [[joint]] "j"; did you mean "break_force"?)"}},
        {"RopeWithLength",
         two + rope + R"(length = 4
@max_length = 5
)",
         {R"([[joint]] "j" has both length and max_length; keep one of them)"}},
        {"RopeWithoutEnd",
         two + rope + R"(min_length = @4
)",
         {R"([[joint]] "j" has min_length but no max_length; give max_length, the maximum distance between the anchors (m))"}},
        {"RopeTheWrongWayRound",
         two + rope + R"(max_length = 4
min_length = @5
)",
         {"min_length is above max_length; the anchors are at least min_length and at most "
          "max_length apart"}},
        {"TooFewImpulses",
         two + hinge + R"(impulses = @[1, 2, 3]
)",
         {"impulses has 3 elements; for a hinge joint it must be an array of 8 numbers"}},
        {"ExpectOfJoints",
         two + joint + R"(anchor = [0, 0, 0]
[[expect]]
name = "e"
quantity = "joint_force"
joint = @"k"
to = 1
at_most = 1
source = "by hand"
[[expect]]
name = "f"
quantity = "joint_angle"
joint = @"j"
to = 1
at_most = 1
source = "by hand"
[[expect]]
name = "g"
quantity = "speed"
body = "a"
@joint = "j"
to = 1
at_most = 1
source = "by hand"
@[[expect]]
name = "h"
quantity = "joint_force"
to = 1
at_most = 1
source = "by hand"
)",
         {R"(there is no joint "k"; the only one is j)",
          R"("j" is of type "ball" and has no joint_angle; one of type "hinge" has)",
          "speed has no joint; it is measured on a body",
          R"([[expect]] "h" has no joint; joint_force is measured on one joint: which?)"}},
        {"UnknownTypeAndUnknownBody",
         two + R"([[joint]]
name = "j"
type = @"hing"
body_b = @"c"
)",
         {R"(unknown type "hing"; did you mean "hinge"?)",
          R"(there is no body "c"; choose from a, b)"}},
    };
    return all;
}

class SceneFileJointErrors : public testing::TestWithParam<SceneFileError> {};

TEST_P(SceneFileJointErrors, PointAndExplain) {
    expect_messages(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, SceneFileJointErrors, testing::ValuesIn(errors()),
                         [](const auto &each) { return each.param.name; });

} // namespace
} // namespace plumb
