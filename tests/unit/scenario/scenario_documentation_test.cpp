// docs/scenario.md and the reader know the same keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
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

// Keys by the heading of the table under which a scenario holds them: "[run]", "[model.baseline]", "[[receiver]]".
std::map<std::string, std::set<std::string>> documented_keys() {
    std::map<std::string, std::set<std::string>> keys;
    std::vector<std::string> headings{"none"};
    std::size_t tables = 0;
    bool in_key_table = false;
    for (const std::string& line : document_lines()) {
        if (line.starts_with("## [") || line.starts_with("### [")) headings = headings_of(line), tables = 0;
        if (line.starts_with("`[")) headings = {between(line, '`', '`').at(0)};
        // Two tables under one heading: the second one is of the second part.
        if (line.starts_with("| key ") && ++tables > 1 && headings.size() > 1) headings.erase(headings.begin());
        if (!line.starts_with('|')) in_key_table = false;
        if (line.starts_with("| key ")) in_key_table = true;
        const std::string& heading = headings.front();
        const bool row = in_key_table && line.starts_with("| `");
        // Paragraphs list keys with their defaults in running text: those of the models, layers and clouds.
        const bool listing =
            !line.starts_with('|') && ((heading.starts_with("[model.") && !heading.starts_with("[model.modern")) ||
                                       heading.starts_with("[[atmosphere."));
        if (row || listing)
            for (const std::string& key : quoted_keys(row ? line.substr(0, line.find('|', 1)) : line))
                keys[heading].insert(key);
    }
    return keys;
}

// Whether the reader asks for a key: a date is the wrong type for all but `start`.
bool reader_knows(const std::string& text) {
    const std::string mistakes = mistakes_of(text);
    return mistakes.find("unknown key") == std::string::npos;
}

bool reader_knows(std::string heading, const std::string& key) {
    // The page tells of the tables of all terms at once.
    if (const std::size_t name = heading.find("NAME"); name != std::string::npos) heading.replace(name, 4, "multipath");
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
         {"[run]", "[sky]", "[trajectory]", "[frame]", "[model.baseline]", "[model.constant-sigma]",
          "[model.satellite-count]", "[model.whole-path]", "[model.refraction]", "[model.modern]",
          "[model.modern.terms.NAME]", "[model.modern.ionosphere]", "[model.modern.solution]", "[atmosphere]",
          "[[atmosphere.layer]]", "[[atmosphere.cloud]]", "[scene]", "[[receiver]]"})
        EXPECT_TRUE(keys.contains(heading)) << heading;
    EXPECT_TRUE(keys.at("[frame]").contains("reach_m"));
    EXPECT_TRUE(keys.at("[model.whole-path]").contains("vapour_db_per_km_per_g_m3"));
}

TEST(ScenarioDocumentation, TheReaderKnowsEveryDocumentedKey) {
    // Words of running text that are values, not keys.
    const std::set<std::string> values{"fog"};
    std::size_t count = 0;
    for (const auto& [heading, keys] : documented_keys())
        for (const std::string& key : keys) {
            if (values.contains(key)) continue;
            EXPECT_TRUE(reader_knows(heading, key))
                << heading << " " << key << ": " << mistakes_of(heading + "\n" + key + " = 1979-05-27\n");
            ++count;
        }
    EXPECT_GT(count, 70U);
    EXPECT_FALSE(reader_knows("[run]", "sede")) << "the check can fail";
}

TEST(ScenarioDocumentation, NamesEveryKeyThatTheReaderKnows) {
    std::string document;
    for (const std::string& line : document_lines())
        document += line + "\n";
    std::size_t count = 0;
    for (const KeyTable& table : scenario_key_tables())
        for (const KeyEntry& key : table.keys) {
            // Headings, and the page of faults, hold the others.
            const bool here = key.type != KeyType::table && key.type != KeyType::tables && table.path != "fault" &&
                              table.path != "command";
            if (!here) continue;
            EXPECT_NE(document.find("`" + key.name + "`"), std::string::npos) << table.path << "." << key.name;
            ++count;
        }
    EXPECT_GT(count, 250U);
}

}  // namespace
}  // namespace skyloop
