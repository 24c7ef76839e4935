#include <gtest/gtest.h>

#include <fstream>

#include "temporary_folder.hpp"
#include "wire/transport/serial.hpp"

namespace skyloop {
namespace {

TEST(PlaceOfDevice, IsOneForAllItsNames) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "ttyS7") << "a device";
    std::filesystem::create_symlink("ttyS7", folder / "by-id");
    EXPECT_EQ(place_of_device(folder / "by-id"), place_of_device(folder / "ttyS7"));
    EXPECT_EQ(place_of_device(folder.path() / "." / "ttyS7"), place_of_device(folder / "ttyS7"));
    std::filesystem::create_symlink("b", folder / "a");
    std::filesystem::create_symlink("a", folder / "b");
    EXPECT_NE(place_of_device(folder / "a" / "x"), place_of_device(folder / "b" / "y")) << "links that lead nowhere";
}

}  // namespace
}  // namespace skyloop
