// The table of joint types and what derives from it.
#include "engine/scene/joint_type.h"

#include "engine/scene/scene_file.h"

#include <fstream>
#include <set>
#include <sstream>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace plumb {
namespace {

SceneDesc parse(const std::string &text) {
    const SceneFileResult result = parse_scene(text, "s.toml");
    for (const SceneMessage &message : result.messages)
        ADD_FAILURE() << format_message("s.toml", message);
    return result.scene;
}

TEST(JointTypes, TableIsOfOnePiece) {
    std::set<std::string_view> names;
    for (const JointTypeInfo *type : joint_types()) {
        EXPECT_EQ(&joint_type(type->type), type);
        EXPECT_TRUE(names.insert(type->name).second) << type->name;
        EXPECT_GE(type->rows.size(), 1U);
        EXPECT_LE(type->rows.size(), max_joint_rows);
        std::set<std::string_view> keys;
        for (const std::vector<JointKey> *list : {&common_joint_keys(), &type->keys})
            for (const JointKey &key : *list) {
                EXPECT_TRUE(keys.insert(key.name).second) << key.name;
                EXPECT_LE(key.bounds.min, key.bounds.max) << key.name;
            }
        for (const std::vector<JointKey> *list : {&common_joint_keys(), &type->keys})
            for (const JointKey &key : *list)
                EXPECT_TRUE(key.needs.empty() || keys.contains(key.needs)) << key.name;
    }
    EXPECT_EQ(names, (std::set<std::string_view>{"ball", "distance", "hinge", "slider", "fixed"}));
}

TEST(JointTypes, ReferenceIsInTheReadme) {
    std::ifstream file(PLUMB_SOURCE_DIR "/scenes/README.md");
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find(joint_reference()), std::string::npos)
        << "put this into scenes/README.md, under [[joint]]:\n\n"
        << joint_reference();
}

const std::string turned_body = R"([[body]]
name = "a"
shape = "sphere"
radius = 0.5
position = [1, 2, 3]
rotation_deg = [20, -130, 75]
)";
constexpr double rounding = 1e-14;

void expect_near(const glm::dvec3 &actual, const glm::dvec3 &expected) {
    EXPECT_LT(glm::distance(actual, expected), rounding)
        << actual.x << " " << actual.y << " " << actual.z;
}

TEST(JointTypes, AxisIsTheFramesXAxisInTheWorldAtTheStart) {
    // Including directions near which a shortest rotation of x is ill defined.
    for (const glm::dvec3 &direction :
         {glm::dvec3{1, 0, 0}, glm::dvec3{-1, 0, 0}, glm::dvec3{0, 1, 0}, glm::dvec3{0, -1, 0},
          glm::dvec3{0, 0, 1}, glm::dvec3{0, 0, -1}, glm::normalize(glm::dvec3{-1, 1e-9, 0}),
          glm::normalize(glm::dvec3{-1, 1e-5, 2e-5}), glm::normalize(glm::dvec3{0.3, -0.5, 2})}) {
        std::ostringstream axis;
        axis.precision(17);
        axis << "[" << direction.x << ", " << direction.y << ", " << direction.z << "]";
        const SceneDesc scene =
            parse(turned_body + "[[joint]]\nname = \"j\"\ntype = \"hinge\"\nbody_b = \"a\"\n" +
                  "anchor = [1, 3, 3]\naxis = " + axis.str() + "\n");
        const JointDesc &joint = scene.joints.at(0);
        const glm::dquat frame_b = scene.bodies[0].orientation * joint.frame_b_local;
        expect_near(joint.frame_a_local * glm::dvec3{1, 0, 0}, direction);
        for (int k = 0; k < 3; ++k) { // they agree: the angle is 0
            glm::dvec3 unit{0};
            unit[k] = 1;
            expect_near(frame_b * unit, joint.frame_a_local * unit);
        }
    }
}

TEST(JointTypes, FixedKeepsTheBodiesAsTheyStand) {
    const SceneDesc scene = parse(turned_body + "[[joint]]\nname = \"j\"\ntype = \"fixed\"\n"
                                                "body_a = \"a\"\nanchor = [1, 3, 3]\n");
    const JointDesc &joint = scene.joints.at(0);
    EXPECT_EQ(joint.frame_b_local, (glm::dquat{1, 0, 0, 0}));
    expect_near(scene.bodies[0].orientation * joint.frame_a_local * glm::dvec3{0, 1, 0}, {0, 1, 0});
}

TEST(JointTypes, KeysInTheirUnits) {
    const SceneDesc scene = parse(turned_body + R"([[joint]]
name = "door"
type = "hinge"
body_b = "a"
anchor = [1, 3, 3]
axis = [0, 1, 0]
limits_deg = [-90, 45]
motor_speed_deg = 180
max_motor_force = 20
frequency = 5
damping_ratio = 0.25
break_force = 300
[[joint]]
name = "rail"
type = "slider"
body_b = "a"
anchor = [1, 3, 3]
axis = [0, 1, 0]
limits = [-0.5, 2]
motor_speed = -1.5
max_motor_force = 7
[[joint]]
name = "rope"
type = "distance"
body_b = "a"
anchor_a = [1, 5, 3]
max_length = 4
[[joint]]
name = "strut"
type = "distance"
body_b = "a"
anchor_a = [1, 5, 3]
min_length = 2
max_length = 4
)");
    constexpr double degree = 3.14159265358979323846 / 180;
    const JointDesc &door = scene.joints.at(0);
    EXPECT_EQ(door.limits, (std::array{-90 * degree, 45 * degree}));
    EXPECT_EQ(door.motor_speed, 180 * degree);
    EXPECT_EQ(door.max_motor_force, 20);
    EXPECT_EQ(door.frequency, 5);
    EXPECT_EQ(door.damping_ratio, 0.25);
    EXPECT_EQ(door.break_force, 300);
    const JointDesc &rail = scene.joints.at(1);
    EXPECT_EQ(rail.limits, (std::array{-0.5, 2.0}));
    EXPECT_EQ(rail.motor_speed, -1.5);
    EXPECT_EQ(scene.joints.at(2).min_length, 0);
    EXPECT_EQ(scene.joints.at(2).max_length, 4);
    EXPECT_EQ(scene.joints.at(3).min_length, 2);
}

// Only what a person would write.
TEST(JointTypes, WriterSaysWhatMatters) {
    SceneDesc scene = parse(turned_body + "[[joint]]\nname = \"rod\"\ntype = \"distance\"\n"
                                          "body_b = \"a\"\nanchor_a = [1, 5, 3]\nlength = 4\n");
    const auto joint_of = [&] {
        const std::string text = write_scene(scene);
        return text.substr(text.find("[[joint]]"));
    };
    const std::string head = "[[joint]]\nname = \"rod\"\ntype = \"distance\"\nbody_a = \"world\"\n"
                             "body_b = \"a\"\nanchor_a_local = [1, 5, 3]\n"
                             "anchor_b_local = [0, 0, 0]\n";
    EXPECT_EQ(joint_of(), head + "length = 4\n");
    scene.joints[0].min_length = 0;
    EXPECT_EQ(joint_of(), head + "max_length = 4\n");
    scene.joints[0].impulses[1] = 0.1;
    scene.joints[0].damping_ratio = 0.5;
    EXPECT_EQ(joint_of(),
              head + "max_length = 4\nfrequency = 0\ndamping_ratio = 0.5\nimpulses = [0, 0.1]\n");
}

} // namespace
} // namespace plumb
