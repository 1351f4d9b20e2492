// What the README repeats of the program is what the program says.
#include "app/sandbox/keys.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace plumb {

TEST(Readme, HasTheTableOfKeys) {
    std::ifstream file(PLUMB_SOURCE_DIR "/README.md");
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_NE(text.str().find(keys_as_markdown()), std::string::npos)
        << "paste what `plumb list --keys` prints into README.md";
}

} // namespace plumb
