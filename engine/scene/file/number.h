// Numbers as text, the same for every locale.
#pragma once

#include <string>

namespace plumb {

// The fewest digits that read back to the same value. As TOML reads it: a whole number stays whole
// ("5") where that loses nothing, and minus zero is "-0.0".
std::string shortest(double value);

// As above, for a value that is read as double and then rounded to float.
std::string shortest(float value);

} // namespace plumb
