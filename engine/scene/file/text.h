// Values as the text of a scene file. Not for users of the engine.
#pragma once

#include "engine/scene/file/number.h"
#include "engine/scene/scene_desc.h"

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <glm/gtc/quaternion.hpp>
#include <glm/vec3.hpp>

namespace plumb::scene_file {

bool same_bits(double a, double b);
bool same_bits(const glm::dvec3 &a, const glm::dvec3 &b);

template <typename Vector> std::string array3(const Vector &v) {
    return "[" + shortest(v.x) + ", " + shortest(v.y) + ", " + shortest(v.z) + "]";
}
// Ten to a line.
std::string array_of(std::span<const double> values);
std::string rotation(const glm::dquat &q);  // [w, x, y, z]
std::string string(std::string_view value); // in quotes
// Appends a character that a basic string cannot hold unescaped.
void append_escaped(std::string &text, char c);

// Degrees that convert to exactly this angle; empty when there are none.
std::optional<double> exact_degrees(double radians);
// "key_deg = ..." if there are such degrees, else in radians.
std::string angle_in_line(const std::string &key, double radians);
std::string angle(const std::string &key, double radians); // a line

// The contents of each kind of table, without its header.
std::string joint_text(const JointDesc &joint);
std::string particle_text(const ParticleDesc &particle);
std::string attractor_text(const AttractorDesc &attractor);
std::string spring_text(const SpringDesc &spring);
std::string cloth_text(const ClothDesc &cloth);
std::string body_text(const BodyDesc &body);
std::string settings_text(const GivenSettings &given);

} // namespace plumb::scene_file
