// Numbers as text, the same for every locale.
#pragma once

#include <string>

namespace plumb {

// The fewest digits that round-trip through TOML: a whole number stays whole ("5") where that loses
// nothing, and minus zero is "-0.0".
std::string shortest(double value);

// The same for a value that is read as double and then rounded to float.
std::string shortest(float value);

} // namespace plumb
