// Every error in a scene file's settings and bodies: where the message points, and what it says.
#include "tests/scene/scene_file_errors.h"

namespace plumb {
namespace {

using namespace scene_file_errors;

const std::vector<SceneFileError> &errors() {
    static const std::vector<SceneFileError> all{
        {"Syntax",
         R"(a = [1, 2
@b = 3
)",
         {"Error while parsing array: expected comma or closing ']', saw 'b'; see https://toml.io "
          "for the syntax"}},
        {"SyntaxDuplicateKey",
         R"(title = "a"
title = @"b"
)",
         {"Error while parsing key-value pair: cannot redefine existing string 'title'; see "
          "https://toml.io for the syntax"}},
        {"SyntaxFraction",
         R"([world]
dt = 1@/60
)",
         {"Error while parsing decimal integer: expected digit, saw '/'; put a fraction in quotes: "
          "\"1/60\""}},
        {"SyntaxOpenQuotes",
         "[world]\nmethod = \"soft_step@\n",
         {"Error while parsing string: unescaped control characters other than TAB (U+0009) are "
          "explicitly prohibited; close the quotes at the end of the string"}},
        {"SyntaxInvalidUtf8",
         "title = @\"\xff\"\n",
         {"Encountered invalid utf-8 sequence; see https://toml.io for the syntax"}},
        {"UnknownTopLevelKey",
         R"(@titel = "x"
)",
         {R"(unknown key "titel" in the top level of a scene; did you mean "title"?)"}},
        {"UnknownKeyNothingNear",
         R"([world]
@zzzzzz = 1
)",
         {R"(unknown key "zzzzzz" in [world]; choose from gravity, dt, substeps, max_substeps, substep_tolerance, substep_budget, sleep_after, iterations, speculative_distance, kept_travel, penetration_slop, baumgarte, split_impulse, baumgarte_time, foresee_turns, alternate_points, closed_form_flight, contact_frequency_ratio, contact_damping_ratio, joint_frequency_ratio and 15 more)"}},
        {"UnknownTable",
         R"([@lights]
)",
         {R"(unknown key "lights" in the top level of a scene; choose from title, description, world, methods, camera, material, body, attractor, particle, cloth, spring, joint, probe, expect, state)"}},
        {"UnknownKeyAfterWideCharacters",
         R"(camera = { target = [0, 0, 0], @"ä" = 1 }
)",
         {R"(unknown key "ä" in [camera]; choose from target, distance, yaw_deg, yaw, pitch_deg, pitch, fov_deg, fov)"}},
        {"TableWanted",
         R"(@world = 3
)",
         {"world is a number; it must be a table: [world]"}},
        {"ArrayOfTablesWanted",
         R"([@body]
name = "a"
)",
         {"body is a table; write [[body]] for each body"}},
        {"TablesInArrayWanted",
         R"(body = [@1]
)",
         {"body holds a number; write [[body]] for each body"}},
        {"AllAtOnce",
         R"(@titel = 1
[world]
dt = @-1
gravity = [0, @"x", 0]
@[[body]]
name = "a"
)",
         {R"(unknown key "titel" in the top level of a scene; did you mean "title"?)",
          R"(dt is -1; it must be a number from 1e-9 to 1 s, or a fraction in quotes such as "1/60")",
          "gravity[1] is a string; it must be a number from -1e9 to 1e9 m/s^2",
          R"([[body]] "a" has no shape; shape = "sphere", "box", "capsule", "cylinder", "hull", "plane", "mesh" or "height_field")"}},
        {"StringWanted",
         R"(title = @3
)",
         {"title is a number; it must be a string in quotes"}},
        {"NumberWanted",
         ball + R"(position = [0, @true, 0]
)",
         {"position[1] is true or false; it must be a number between -1e9 and 1e9"}},
        {"BooleanWanted",
         two + joint + R"(anchor = [0, 0, 0]
collide_connected = @1
)",
         {"collide_connected is a number; it must be true or false"}},
        {"ArrayWanted",
         ball + R"(position = @1
)",
         {"position is a number; it must be an array of 3 numbers"}},
        {"ThreeElementsWanted",
         ball + R"(position = @[1, 2]
)",
         {"position has 2 elements; it must be an array of 3 numbers"}},
        {"DateIsNoNumber",
         R"([camera]
distance = @2020-01-01
)",
         {"distance is a date or time; it must be a positive number, from 1e-9 to 1e9"}},
        {"NotANumber",
         ball + R"(position = [0, @nan, 0]
)",
         {"position[1] is nan; it must be a number between -1e9 and 1e9"}},
        {"Infinite",
         ball + R"(velocity = [@-inf, 0, 0]
)",
         {"velocity[0] is -inf; it must be a number between -1e9 and 1e9"}},
        {"TooLarge",
         ball + R"(position = [@2e9, 0, 0]
)",
         {"position[0] is 2e+09; it must be a number between -1e9 and 1e9"}},
        {"TooLargeForDouble",
         R"(title = "x"
[camera]
distance = 1e400@
)",
         {"Error while parsing floating-point: '1e400' is not representable in 64 bits; see "
          "https://toml.io for the syntax"}},
        {"NegativeMass",
         ball + R"(mass = @-1
)",
         {"mass is -1; it must be a positive number, from 1e-9 to 1e9"}},
        {"ZeroMass",
         ball + R"(mass = @0
)",
         {"mass is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"ZeroDensity",
         ball + R"(density = @0.0
)",
         {"density is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"MassBeyondRange",
         R"([[body]]
name = "a"
shape = "box"
half_extents = [1e6, 1e6, 1e6]
density = @1e5
)",
         {"density times volume gives a mass of 8e+23 kg; it must be a positive number, from 1e-9 "
          "to 1e9; give a mass"}},
        {"MassOfMaterialBeyondRange",
         R"([[body]]
name = "a"
shape = @"sphere"
radius = 1e-7
)",
         {"density times volume gives a mass of 4.18879020478639e-18 kg; it must be a positive "
          "number, from 1e-9 to 1e9; give a mass"}},
        {"NegativeRadius",
         R"([[body]]
name = "a"
shape = "sphere"
radius = @-1
)",
         {"radius is -1; it must be a positive number, from 1e-9 to 1e9"}},
        {"ZeroHalfExtent",
         R"([[body]]
name = "a"
shape = "box"
half_extents = [1, @0, 1]
)",
         {"half_extents[1] is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"MaterialDensity",
         R"([[material]]
name = "m"
density = @-5
)",
         {"density is -5; it must be a positive number, from 1e-9 to 1e9"}},
        {"MaterialFriction",
         R"([[material]]
name = "m"
friction = @-0.1
)",
         {"friction is -0.1; it must be a number from 0 to 1e9"}},
        {"RestitutionAboveOne",
         R"([[material]]
name = "m"
restitution = @1.5
)",
         {"restitution is 1.5; it must be a number from 0 to 1"}},
        {"RestitutionBelowZero",
         R"([[material]]
name = "m"
restitution = @-0.5
)",
         {"restitution is -0.5; it must be a number from 0 to 1"}},
        {"DtZero",
         R"([world]
dt = @0
)",
         {R"(dt is 0; it must be a number from 1e-9 to 1 s, or a fraction in quotes such as "1/60")"}},
        {"DtBadFraction",
         R"([world]
dt = @"1/sixty"
)",
         {R"(dt is "1/sixty"; it must be a number from 1e-9 to 1 s, or a fraction in quotes such as "1/60")"}},
        {"DtZeroFraction",
         R"([world]
dt = @"1/0"
)",
         {R"(dt is "1/0"; it must be a number from 1e-9 to 1 s, or a fraction in quotes such as "1/60")"}},
        {"UnknownMethod",
         R"([world]
method = @"soft_stpe"
)",
         {R"(there is no method "soft_stpe"; did you mean "soft_step"?)"}},
        {"UnknownMethodInMethods",
         R"([methods.@pgss]
iterations = 4
)",
         {R"(there is no method "pgss"; did you mean "pgs"?)"}},
        {"MethodsNeedTables",
         R"([methods]
@pgs = 4
)",
         {"pgs is a number; it must be a table: [methods.pgs]"}},
        {"UnknownMethodSetting",
         R"([methods.pgs]
@iteration = 4
)",
         {R"(unknown key "iteration" in [methods.pgs]; did you mean "iterations"?)"}},
        {"Substeps",
         R"([world]
substeps = @-1
iterations = @1.5
)",
         {"substeps is -1; it must be a whole number from 1 to 10000",
          "iterations is 1.5; it must be a whole number from 1 to 10000"}},
        {"SettingOutOfRange",
         R"([methods.pgs]
baumgarte = @1.5
)",
         {R"(baumgarte is 1.5; it must be a number from 0 to 1, or a fraction in quotes such as "1/60")"}},
        {"WholeNumberWithAPoint",
         R"([world]
substeps = @8.0
)",
         {"substeps is 8.0; it must be a whole number from 1 to 10000"}},
        {"OwnSettingsInMethods",
         R"([methods.@soft_step]
substeps = 3
)",
         {"soft_step is the scene's own method, whose settings are in [world]; move them there"}},
        {"TitleInABody",
         R"([[body]]
name = "a"
shape = "sphere"
radius = 1
@title = "x"
)",
         {R"(unknown key "title" in [[body]] "a"; title belongs at the top of the file, before the first [table])"}},
        {"WorldSettingInMethods",
         R"([methods.pgs]
@dt = 0.01
)",
         {R"(unknown key "dt" in [methods.pgs]; dt belongs to [world]: it is the same for all methods)"}},
        {"UnknownPrecision",
         R"([world]
precision = @"single"
)",
         {R"(unknown precision "single"; choose from float, double)"}},
        {"Seed",
         R"([world]
seed = @-4
)",
         {"seed is not a natural number; it must be a whole number from 0 to 2^64 - 1 (in quotes "
          "from 2^63 on)"}},
        {"SeedText",
         R"([world]
seed = @"18446744073709551616"
)",
         {"seed is not a natural number; it must be a whole number from 0 to 2^64 - 1 (in quotes "
          "from 2^63 on)"}},
        {"CameraPitch",
         R"([camera]
pitch_deg = @91
)",
         {"pitch_deg is 91; it must be a number from -90 to 90"}},
        {"CameraPitchRadians",
         R"([camera]
pitch = @1.6
)",
         {"pitch is 1.6 (radians); in degrees it must be a number from -90 to 90"}},
        {"CameraFov",
         R"([camera]
fov_deg = @0
)",
         {"fov_deg is 0; it must be a number from 1 to 170"}},
        {"CameraDistance",
         R"([camera]
distance = @0
)",
         {"distance is 0; it must be a positive number, from 1e-9 to 1e9"}},
        {"CameraYawTwice",
         R"([camera]
yaw_deg = 1
@yaw = 1
)",
         {"[camera] has both yaw_deg and yaw; keep one of them"}},
        {"MissingName",
         R"(@[[body]]
shape = "sphere"
radius = 1
)",
         {"[[body]] has no name; each body needs a name of its own"}},
        {"EmptyName",
         R"([[body]]
name = @" "
shape = "sphere"
radius = 1
)",
         {"the name is empty; each body needs a name of its own"}},
        {"BodyNamedWorld",
         R"([[body]]
name = @"world"
shape = "sphere"
radius = 1
)",
         {R"("world" cannot be the name of a body; it stands for the world in joints and springs)"}},
        {"DuplicateBody",
         ball + R"([[body]]
name = @"ball"
shape = "plane"
)",
         {R"(another body is already named "ball", at line 2; each body needs a name of its own)"}},
        {"DuplicateMaterial",
         R"([[material]]
name = "m"
[[material]]
name = @"m"
)",
         {R"(another material is already named "m", at line 2; each material needs a name of its own)"}},
        {"DuplicateExpect",
         expect + R"(to = 1
at_most = 1
[[expect]]
name = @"e"
quantity = "energy"
source = "by hand"
to = 1
at_most = 1
)",
         {R"(another expect is already named "e", at line 2; each expect needs a name of its own)"}},
        {"DuplicateOfRepeated",
         R"([[body]]
name = "link_2"
shape = "sphere"
radius = 1
[[body]]
name = @"link"
shape = "sphere"
radius = 0.1
repeat = { kind = "line", count = 4, step = [1, 0, 0] }
)",
         {R"(another body is already named "link_2", at line 2; each body needs a name of its own)"}},
        {"UnknownMaterial",
         R"([[material]]
name = "steel"
[[body]]
name = "ball"
shape = "sphere"
radius = 1
material = @"stele"
)",
         {R"(there is no material "stele"; did you mean "steel"?)"}},
        {"UnknownMaterialNoneThere",
         ball + R"(material = @"steel"
)",
         {R"(there is no material "steel")"}},
        {"MissingShape",
         R"(@[[body]]
name = "a"
)",
         {R"([[body]] "a" has no shape; shape = "sphere", "box", "capsule", "cylinder", "hull", "plane", "mesh" or "height_field")"}},
        {"UnknownShape",
         R"([[body]]
name = "a"
shape = @"spere"
)",
         {R"(unknown shape "spere"; did you mean "sphere"?)"}},
        {"UnknownKind",
         ball + R"(kind = @"fixed"
)",
         {R"(unknown kind "fixed"; choose from static, kinematic, dynamic)"}},
        {"MissingRadius",
         R"(@[[body]]
name = "a"
shape = "sphere"
)",
         {R"([[body]] "a" has no radius; radius = metres)"}},
        {"WrongSizeForShape",
         R"([[body]]
name = "a"
shape = "box"
@radius = 1
half_extents = [1, 1, 1]
)",
         {"a box has no radius; its size is half_extents"}},
        {"UnknownBodyKey",
         ball + R"(@posiiton = [0, 0, 0]
)",
         {R"(unknown key "posiiton" in [[body]] "ball"; did you mean "position"?)"}},
        {"RotationWithoutUnit",
         ball + R"(@rotation = [0, 0, 0]
)",
         {R"(unknown key "rotation" in [[body]] "ball"; did you mean "rotation_deg"?)"}},
        {"FrictionOnBody",
         ball + R"(@friction = 0.5
)",
         {R"(unknown key "friction" in [[body]] "ball"; friction belongs to a [[material]], which the body then names)"}},
        {"MassAndDensity",
         ball + R"(mass = 1
@density = 1
)",
         {R"([[body]] "ball" has both mass and density; keep one of them)"}},
        {"DynamicPlane",
         R"([[body]]
name = "a"
shape = "plane"
kind = @"dynamic"
)",
         {R"(a plane cannot be dynamic; kind = "static", which is a plane's default, or "kinematic")"}},
        {"PlaneWithMass",
         R"([[body]]
name = "a"
shape = "plane"
@mass = 3
)",
         {"a plane has no mass; it is infinite and never moves under forces"}},
        {"TwoRotations",
         ball + R"(rotation_deg = [0, 0, 0]
@orientation = [1, 0, 0, 0]
)",
         {R"([[body]] "ball" has both rotation_deg and orientation; keep one of them)"}},
        {"AxisWithoutAngle",
         R"(@[[body]]
name = "a"
shape = "sphere"
radius = 1
axis = [0, 1, 0]
)",
         {R"([[body]] "a" has no angle_deg; axis needs angle_deg, the angle about it)"}},
        {"AngleWithoutAxis",
         ball + R"(@angle_deg = 30
)",
         {R"([[body]] "ball" has angle_deg but no axis; axis = [x, y, z] of unit length)"}},
        {"AxisNotUnit",
         ball + R"(axis = @[0, 3, 4]
angle_deg = 30
)",
         {"axis has length 5, not 1; normalised it is [0, 0.6, 0.8]"}},
        {"AxisZero",
         ball + R"(axis = @[0, 0, 0]
angle_deg = 30
)",
         {"axis has length 0, not 1; it cannot be normalised"}},
        {"OrientationNotUnit",
         ball + R"(orientation = @[1, 1, 1, 1]
)",
         {"orientation has length 2, not 1; normalised it is [0.5, 0.5, 0.5, 0.5]"}},
        {"TwoAngularVelocities",
         ball + R"(angular_velocity = [0, 0, 0]
@angular_velocity_deg = [0, 0, 0]
)",
         {R"([[body]] "ball" has both angular_velocity and angular_velocity_deg; keep one of them)"}},
        {"StaticVelocity",
         ball + R"(kind = "static"
@velocity = [1, 0, 0]
)",
         {R"(a static body has no velocity; kind = "kinematic" moves at its velocity, "dynamic" under forces)"}},
        {"StaticAngularVelocity",
         ball + R"(kind = "static"
@angular_velocity_deg = [1, 0, 0]
)",
         {R"(a static body has no angular_velocity_deg; kind = "kinematic" moves at its velocity, "dynamic" under forces)"}},
        {"ColourName",
         ball + R"(color = @"red"
)",
         {R"(color "red" is not a colour; write "#rrggbb", as in "#ff8800", or [r, g, b] with numbers from 0 to 1)"}},
        {"ColourHex",
         ball + R"(color = @"#12345g"
)",
         {R"(color "#12345g" is not a colour; write "#rrggbb", as in "#ff8800", or [r, g, b] with numbers from 0 to 1)"}},
        {"ColourRange",
         ball + R"(color = [0, @2, 0]
)",
         {"color[1] is 2; it must be a number from 0 to 1"}},
        {"RepeatNoTable",
         ball + R"(@repeat = 5
)",
         {R"(repeat is a number; it must be a table: repeat = { kind = "stack", count = 10 })"}},
        {"RepeatNoKind",
         ball + R"(repeat = @{ count = 5 }
)",
         {R"(repeat of [[body]] "ball" has no kind; kind = "grid", "stack", "line", "pyramid", "ring" or "scatter")"}},
        {"RepeatUnknownKind",
         ball + R"(repeat = { kind = @"gird", count = [1, 1, 1], spacing = [1, 1, 1] }
)",
         {R"(unknown kind "gird" of repeat; did you mean "grid"?)"}},
        {"RepeatUnknownKey",
         ball + R"(repeat = { kind = "ring", count = 3, radius = 2, @face = true }
)",
         {R"(unknown key "face" in the ring repeat of [[body]] "ball"; choose from kind, count, radius, facing)"}},
        {"RepeatMissingCount",
         ball + R"(repeat = @{ kind = "stack" }
)",
         {R"(the stack repeat of [[body]] "ball" has no count; how many, a whole number)"}},
        {"RepeatCountZero",
         ball + R"(repeat = { kind = "stack", count = @0 }
)",
         {"count is 0; it must be a whole number from 1 to 200000"}},
        {"RepeatCountElement",
         ball + R"(repeat = { kind = "grid", count = [2, @0, 2], spacing = [1, 1, 1] }
)",
         {"count[1] is 0; it must be a whole number from 1 to 200000"}},
        {"RepeatCountNoArray",
         ball + R"(repeat = { kind = "grid", count = @3, spacing = [1, 1, 1] }
)",
         {"count is a number; it must be an array of 3 whole numbers"}},
        {"RepeatMissingSpacing",
         ball + R"(repeat = @{ kind = "pyramid", base = 3 }
)",
         {R"(the pyramid repeat of [[body]] "ball" has no spacing; spacing = [sideways, up] in metres)"}},
        {"RepeatTooManyBodies",
         ball + R"(repeat = @{ kind = "grid", count = [100, 100, 100], spacing = [1, 1, 1] }
)",
         {"too many bodies: 0 before this, and 1000000 here; a scene holds at most 200000"}},
        {"RepeatTooManyBodiesInAll",
         chain + ball + R"(repeat = @{ kind = "ring", count = 199997, radius = 1 }
)",
         {"too many bodies: 4 before this, and 199997 here; a scene holds at most 200000"}},
        {"RepeatStackOfPlanes",
         R"([[body]]
name = "a"
shape = "plane"
repeat = @{ kind = "stack", count = 3 }
)",
         {R"(the stack repeat of [[body]] "a" has no spacing; a plane has no height to take it from)"}},
        {"ScatterDoesNotFit",
         ball +
             R"(repeat = @{ kind = "scatter", count = 9, half_extents = [1, 0, 0], min_distance = 1 }
)",
         {"only 2 of 9 bodies found a place at least min_distance from the others; fewer bodies, a "
          "smaller min_distance or larger half_extents"}},
    };
    return all;
}

class SceneFileErrors : public testing::TestWithParam<SceneFileError> {};

TEST_P(SceneFileErrors, PointAndExplain) {
    expect_messages(GetParam());
}

INSTANTIATE_TEST_SUITE_P(All, SceneFileErrors, testing::ValuesIn(errors()),
                         [](const auto &each) { return each.param.name; });

} // namespace
} // namespace plumb
