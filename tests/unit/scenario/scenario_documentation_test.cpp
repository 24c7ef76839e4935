// docs/scenario.md and the reader know the same keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

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

// The words of a text in `backquotes` that look like keys.
std::vector<std::string> quoted_keys(const std::string& text) {
    static const std::regex quoted("`([a-z][a-z0-9_]*)`");
    std::vector<std::string> keys;
    for (std::sregex_iterator match(text.begin(), text.end(), quoted), end; match != end; ++match)
        keys.push_back((*match)[1]);
    return keys;
}

// Keys by the heading of the table under which a scenario holds them: "[run]", "[model.baseline]", "[[receiver]]".
std::map<std::string, std::set<std::string>> documented_keys() {
    static const std::regex section("^## (\\[+[a-z]+\\]+)( and (\\[[a-z]+\\]))?");
    static const std::regex paragraph("^`(\\[+[a-z.-]+\\]+)`");
    std::map<std::string, std::set<std::string>> keys;
    std::string heading, second;
    bool table_before = false;
    for (const std::string& line : document_lines()) {
        std::smatch match;
        if (std::regex_search(line, match, section)) {
            heading = match[1];
            second = match[3];
            table_before = false;
            continue;
        }
        if (std::regex_search(line, match, paragraph)) heading = match[1];
        if (line.starts_with("| key ")) {
            // Two tables under one heading: the second one is of the second part.
            if (table_before && !second.empty()) heading = second, second.clear();
            table_before = true;
        }
        const bool row = line.starts_with("| `");
        if (row)
            for (const std::string& key : quoted_keys(line.substr(0, line.find('|', 1))))
                keys[heading].insert(key);
        // Paragraphs list keys with their defaults in running text: those of the models, layers and clouds.
        if (!row && (heading.starts_with("[model.") || heading.starts_with("[[atmosphere.")) && !line.starts_with("|"))
            for (const std::string& key : quoted_keys(line))
                keys[heading].insert(key);
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
    for (const char* kind : {"fixed", "waypoints", "circle"})
        if (reader_knows("[trajectory]\nkind = \"" + std::string(kind) + "\"\n" + value)) return true;
    return reader_knows("[trajectory]\nkind = \"waypoints\"\n[[trajectory.waypoint]]\n" + value);
}

TEST(ScenarioDocumentation, HasAllParts) {
    const auto keys = documented_keys();
    for (const char* heading :
         {"[run]", "[sky]", "[trajectory]", "[frame]", "[model.baseline]", "[model.constant-sigma]",
          "[model.satellite-count]", "[model.whole-path]", "[model.refraction]", "[atmosphere]", "[[atmosphere.layer]]",
          "[[atmosphere.cloud]]", "[[receiver]]"})
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
    static const std::regex assignment("^([a-z][a-z0-9_]*) = ");
    std::istringstream text{std::string(test::every_key_text)};
    for (std::string line; std::getline(text, line);) {
        std::smatch match;
        if (!std::regex_search(line, match, assignment)) continue;
        EXPECT_NE(document.find("`" + match[1].str() + "`"), std::string::npos) << match[1];
    }
}

}  // namespace
}  // namespace skyloop
