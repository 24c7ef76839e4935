#include "run/scenario/navigation_mirrors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "unit/transport/temporary_folder.hpp"

namespace skyloop::test {
namespace {

using ::testing::HasSubstr;

std::string mistakes_of_mirrors(std::string_view text) {
    const auto read = read_navigation_mirrors(text, "m.toml");
    return read ? "taken" : read.error().message;
}

TEST(NavigationMirrors, TheListOfTheProgramCanBeUsed) {
    const std::filesystem::path folders[] = {std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data"};
    const auto mirrors = find_navigation_mirrors(folders);
    ASSERT_TRUE(mirrors) << mirrors.error().message;
    std::vector<std::string> names;
    for (const NavigationMirror& mirror : *mirrors) {
        names.push_back(mirror.name);
        for (const std::string& address : mirror.addresses)
            EXPECT_THAT(address,
                        testing::AllOf(testing::StartsWith("https://"), HasSubstr("{year}"), HasSubstr("{doy}")));
    }
    EXPECT_THAT(names, testing::ElementsAre("bkg", "ign", "cddis"));
}

TEST(NavigationMirrors, MistakesAreToldByLine) {
    EXPECT_EQ(mistakes_of_mirrors("[[mirror]]\nname = \"a\"\naddresses = [\"https://a/{doy}\"]"), "taken");
    EXPECT_THAT(mistakes_of_mirrors(""), HasSubstr("m.toml:1:1: has no mirror; expected tables headed [[mirror]]"));
    EXPECT_THAT(mistakes_of_mirrors("[[mirror]]\nname = \"a\"\naddresses = [\"ftp://a\"]"),
                HasSubstr("m.toml:3:13: mirror.addresses: 'ftp://a'; expected an address"));
    EXPECT_THAT(mistakes_of_mirrors("[[mirror]]\nname = \"a\""), HasSubstr("expected name and addresses"));
    EXPECT_THAT(mistakes_of_mirrors("[[mirror]]\nname = \"a\"\naddresses = [\"https://a\"]\nurl = 1"),
                HasSubstr("url"));
}

TEST(NavigationMirrors, TheFirstFolderThatHasTheListWins) {
    const TemporaryFolder first, second;
    for (const auto* folder : {&first, &second})
        std::ofstream(*folder / "navigation_mirrors.toml")
            << "[[mirror]]\nname = \"" << (folder == &first ? "one" : "two") << "\"\naddresses = [\"https://a\"]\n";
    const std::filesystem::path folders[] = {"/nowhere", second / "", first / ""};
    EXPECT_EQ(find_navigation_mirrors(folders).value().front().name, "two");
    const auto none = find_navigation_mirrors(std::span(folders).first(1));
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message,
              "no navigation_mirrors.toml in /nowhere; SKYLOOP_DATA_DIR may name the folder that holds it");
}

}  // namespace
}  // namespace skyloop::test
