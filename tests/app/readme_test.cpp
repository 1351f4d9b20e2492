// What the README quotes from the program is what the program says.
#include "tests/app/program.h"

#include "app/sandbox/keys.h"
#include "engine/scene/given_settings.h"

#include <gtest/gtest.h>

#include <string>

namespace plumb {

TEST(Readme, HasTheTableOfKeys) {
    EXPECT_NE(text_of(PLUMB_SOURCE_DIR "/README.md").find(keys_as_markdown()), std::string::npos)
        << "paste what `plumb list --keys` prints into README.md";
}

TEST(Readme, OfScenesHasTheTableOfSettings) {
    EXPECT_NE(text_of(PLUMB_SOURCE_DIR "/scenes/README.md").find(settings_as_markdown()),
              std::string::npos)
        << "paste what `plumb list --settings` prints into scenes/README.md";
}

} // namespace plumb
