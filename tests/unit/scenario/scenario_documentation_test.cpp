// docs/scenario.md and the reader know the same keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>

#include "run/scenario/key_catalogue.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;

std::vector<std::string> document_lines() {
    std::ifstream file(SKYLOOP_SOURCE_DIR "/docs/scenario.md");
    std::vector<std::string> lines;
    for (std::string line; std::getline(file, line);)
        lines.push_back(line);
    return lines;
}

bool is_key(std::string_view word) {
    return !word.empty() && word.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
}

// The texts that stand between an `opening` and the next `closing`.
std::vector<std::string> between(std::string_view text, char opening, char closing) {
    std::vector<std::string> found;
    for (std::size_t at = text.find(opening); at != std::string_view::npos; at = text.find(opening, at)) {
        const std::size_t end = text.find(closing, at + 1);
        if (end == std::string_view::npos) break;
        found.emplace_back(text.substr(at + 1, end - at - 1));
        at = end + 1;
    }
    return found;
}

// The words of a text in `backquotes` that look like keys.
std::vector<std::string> quoted_keys(std::string_view text) {
    std::vector<std::string> keys = between(text, '`', '`');
    std::erase_if(keys, [](const std::string& word) { return !is_key(word); });
    return keys;
}

// "[run]" of "## [run]", "[trajectory]" and "[frame]" of "## [trajectory] and [frame]"; brackets as they stand.
std::vector<std::string> headings_of(const std::string& line) {
    std::vector<std::string> headings;
    std::istringstream words(line.substr(2));
    for (std::string word; words >> word;)
        if (word.starts_with('[')) headings.push_back(word);
    return headings;
}

// Keys by the heading of the table under which a scenario holds them, "[run]", "[[receiver]]": those before the colon
// of
// "- `weather`, `mapping`: what …". Where one heading names several tables, each has a line that links to its keys.
std::map<std::string, std::set<std::string>> documented_keys() {
    std::map<std::string, std::set<std::string>> keys;
    std::vector<std::string> headings{"none"};
    std::size_t links = 0;
    for (const std::string& line : document_lines()) {
        if (line.starts_with("## [") || line.starts_with("### [")) headings = headings_of(line), links = 0;
        if (line.starts_with("`[")) headings = {between(line, '`', '`').at(0)};
        if (line.starts_with("[Keys, ranges") && ++links > 1 && headings.size() > 1) headings.erase(headings.begin());
        if (!line.starts_with("- `")) continue;
        for (const std::string& key : quoted_keys(line.substr(0, line.find(": "))))
            keys[headings.front()].insert(key);
    }
    return keys;
}

// Whether the reader asks for a key: a date is the wrong type for all but `start`.
bool reader_knows(const std::string& text) {
    const std::string mistakes = mistakes_of(text);
    return mistakes.find("unknown key") == std::string::npos;
}

bool reader_knows(const std::string& heading, const std::string& key) {
    const std::string value = key + " = 1979-05-27\n";
    if (heading != "[trajectory]") return reader_knows(heading + "\n" + value);
    if (key == "kind") return reader_knows("[trajectory]\n" + value);
    for (const char* kind : {"fixed", "waypoints", "circle", "file", "live"})
        if (reader_knows("[trajectory]\nkind = \"" + std::string(kind) + "\"\n" + value)) return true;
    return reader_knows("[trajectory]\nkind = \"waypoints\"\n[[trajectory.waypoint]]\n" + value);
}

TEST(ScenarioDocumentation, HasAllParts) {
    const auto keys = documented_keys();
    for (const char* heading :
         {"[run]", "[sky]", "[trajectory]", "[model]", "[model.baseline]", "[model.modern.ionosphere]",
          "[model.modern.solution]", "[atmosphere]", "[scene]", "[[receiver]]", "[[output]]"})
        EXPECT_TRUE(keys.contains(heading)) << heading;
    EXPECT_TRUE(keys.at("[run]").contains("start"));
    EXPECT_TRUE(keys.at("[model.modern.solution]").contains("accuracy_ionosphere_tilt"));
}

TEST(ScenarioDocumentation, TheReaderKnowsEveryDocumentedKey) {
    std::size_t count = 0;
    for (const auto& [heading, keys] : documented_keys())
        for (const std::string& key : keys) {
            EXPECT_TRUE(reader_knows(heading, key))
                << heading << " " << key << ": " << mistakes_of(heading + "\n" + key + " = 1979-05-27\n");
            ++count;
        }
    EXPECT_GT(count, 70U);
    EXPECT_FALSE(reader_knows("[run]", "sede")) << "the check can fail";
}

TEST(ScenarioDocumentation, LinksToTheKeysOfEveryTable) {
    std::string document;
    for (const std::string& line : document_lines())
        document += line + "\n";
    std::size_t count = 0;
    for (const KeyTable& table : scenario_key_tables()) {
        // Of tables within lists and of single terms, the page of keys holds those that their heading leads to.
        const bool inner = table.path.empty() || table.path.starts_with("model.modern.terms.") ||
                           table.path.starts_with("receiver.") || table.path.starts_with("trajectory.") ||
                           table.path.starts_with("campaign.") || table.path == "model.ideal";
        if (inner) continue;
        std::string anchor = table.path == "model.modern.terms" ? "modelmoderntermsname" : table.path;
        std::erase(anchor, '.');
        EXPECT_NE(document.find("(scenario_keys.md#" + anchor + ")"), std::string::npos) << table.path;
        ++count;
    }
    EXPECT_GT(count, 20U);
}

TEST(ScenarioDocumentation, ThePageOfKeysIsTheReadersOwn) {
    std::ifstream file(SKYLOOP_SOURCE_DIR "/docs/scenario_keys.md");
    const std::string page((std::istreambuf_iterator<char>(file)), {});
    EXPECT_TRUE(page == scenario_keys_markdown()) << "skyloop schema --format markdown > docs/scenario_keys.md";
}

}  // namespace
}  // namespace skyloop
