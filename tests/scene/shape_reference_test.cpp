// What scenes/README.md says about shapes matches the table of kinds.
#include "engine/scene/shape_fields.h"

#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace plumb {
namespace {

TEST(ShapeReference, IsThatOfTheReadme) {
    std::ifstream file(PLUMB_SOURCE_DIR "/scenes/README.md");
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find(scene_file::shape_reference()), std::string::npos)
        << "scenes/README.md should have, under Shapes:\n\n"
        << scene_file::shape_reference();
}

} // namespace
} // namespace plumb
