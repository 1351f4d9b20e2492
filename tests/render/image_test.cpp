#include "app/render/image.h"
#include "app/render/png.h"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include <gtest/gtest.h>

#include "engine/core/check.h"
#include "engine/core/random.h"
#include "tests/temporary_folder.h"

namespace plumb {
namespace {

class PngFile : public testing::Test {
  protected:
    TemporaryFolder folder;
    std::filesystem::path dir = folder.path();
};

Image noise(int width, int height) {
    Image image(width, height);
    Random random(11);
    for (std::uint8_t &byte : image.pixels)
        byte = static_cast<std::uint8_t>(random.next_in(0, 256));
    return image;
}

TEST(Image, PixelsAreWhereTheyWereSet) {
    Image image(3, 2, {9, 8, 7});
    image.set(2, 1, {1, 2, 3});
    EXPECT_EQ(image.at(2, 1), glm::u8vec3(1, 2, 3));
    EXPECT_EQ(image.at(0, 1), glm::u8vec3(9, 8, 7));
    EXPECT_EQ(image.pixels[15], 1);
    EXPECT_THROW((void)image.at(3, 0), CheckFailure);
    EXPECT_THROW((void)image.at(0, -1), CheckFailure);
}

TEST_F(PngFile, KeepsEveryPixel) {
    for (const auto &[width, height] : {std::pair{1, 1}, {7, 5}, {64, 33}}) {
        const Image image = noise(width, height);
        write_png(dir / "a.png", image);
        EXPECT_EQ(read_png(dir / "a.png"), image);
    }
}

TEST_F(PngFile, LeavesNothingElseBehind) {
    write_png(dir / "a.png", noise(4, 4));
    write_png(dir / "a.png", noise(5, 5));
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir), {}), 1);
    EXPECT_EQ(read_png(dir / "a.png").width, 5);
}

TEST_F(PngFile, SaysWhichFileFailed) {
    const auto message_of = [](const auto &action) {
        try {
            action();
        } catch (const std::runtime_error &error) {
            return std::string(error.what());
        }
        return std::string("nothing thrown");
    };
    const std::string missing = (dir / "no" / "a.png").string();
    EXPECT_NE(message_of([&] { write_png(missing, noise(2, 2)); }).find(missing),
              std::string::npos);
    EXPECT_NE(message_of([&] { (void)read_png(missing); }).find(missing), std::string::npos);
    std::ofstream(dir / "text.png") << "not a picture";
    EXPECT_NE(message_of([&] { (void)read_png(dir / "text.png"); }).find("text.png"),
              std::string::npos);
    EXPECT_THROW(write_png(dir / "empty.png", Image()), CheckFailure);
}

} // namespace
} // namespace plumb
