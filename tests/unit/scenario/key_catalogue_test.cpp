// The catalogue of keys and the reader agree: names, types, limits, defaults and rules.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "run/scenario/key_catalogue.hpp"
#include "scenario_text.hpp"

namespace skyloop {
namespace {

using test::mistakes_of;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double catalogue_no_limit = std::numeric_limits<double>::max();

const KeyTable& table_of(std::string_view path) {
    for (const KeyTable& table : scenario_key_tables())
        if (table.path == path) return table;
    throw std::out_of_range(std::string(path));
}

const KeyEntry& key_of(std::string_view path, std::string_view name) {
    for (const KeyEntry& key : table_of(path).keys)
        if (key.name == name) return key;
    throw std::out_of_range(std::string(name));
}

std::string heading_of(const KeyTable& table) {
    return fmt::format("{0}{1}{2}\n", table.list ? "[[" : "[", table.path, table.list ? "]]" : "]");
}

// Headings under which a key of a table may stand, with the words of `kind` that let it.
std::string frame_of(const KeyTable& table, const std::string& kind) {
    std::string text;
    const std::size_t dot = table.path.rfind('.');
    if (dot != std::string::npos) {
        const KeyTable& above = table_of(table.path.substr(0, dot));
        const KeyEntry& own = key_of(above.path, table.path.substr(dot + 1));
        // A table of a list stands below a heading of that list.
        if (!own.kinds.empty() || above.list)
            text = frame_of(above, own.kinds.empty() ? std::string() : own.kinds.front());
    }
    text += heading_of(table);
    return kind.empty() ? text : text + "kind = \"" + kind + "\"\n";
}

bool is_in(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Texts that a key needs beside it: one of each set of alternatives, if the key is none of them and may stand with it.
std::string company_of(const KeyTable& table, const KeyEntry& key) {
    std::string text;
    std::vector<std::string> there{key.name};
    for (const KeyRule& rule : table.one_of) {
        const bool met = std::ranges::any_of(rule.keys, [&](const std::string& one) { return is_in(there, one); });
        if (!rule.kinds.empty() || met) continue;
        for (const std::string& other : rule.keys) {
            const bool apart = std::any_of(table.not_both.begin(), table.not_both.end(), [&](const KeyRule& both) {
                return is_in(both.keys, key.name) && is_in(both.keys, other);
            });
            const KeyType type = key_of(table.path, other).type;
            if (apart || (type != KeyType::text && type != KeyType::text_or_texts)) continue;
            text += other + " = \"x\"\n";
            there.push_back(other);
            break;
        }
    }
    return text;
}

// What the reader says of one key with this value. Every kind of a key is alike by the rules of the catalogue.
std::string said_of(const KeyTable& table, const KeyEntry& key, const std::string& value) {
    std::string kind = key.kinds.empty() ? std::string() : key.kinds.front();
    if (kind.empty() && key.name != "kind" && !table.kinds.empty()) kind = table.kinds.front();
    return mistakes_of(frame_of(table, kind) + company_of(table, key) + key.name + " = " + value + "\n");
}

std::string place_in(const KeyTable& table, const KeyEntry& key) { return table.path + "." + key.name + ": "; }

struct Samples {
    std::vector<std::string> good{}, bad{};
};

std::string number_text(const KeyEntry& key, double value) {
    const bool whole = key.type == KeyType::whole_number || key.type == KeyType::whole_numbers;
    return whole ? fmt::format("{}", static_cast<std::int64_t>(value)) : fmt::format("{:.17g}", value);
}

// At the limits and beyond them.
Samples numbers_around(const KeyEntry& key) {
    Samples samples{{}, {"true", "\"x\""}};
    constexpr double most_whole = 9e18;
    if (key.least > -catalogue_no_limit) {
        const bool above_zero = key.least == std::numeric_limits<double>::min();
        samples.good.push_back(number_text(key, above_zero ? 1e-3 : key.least));
        samples.bad.push_back(number_text(key, above_zero ? 0 : key.least - std::max(1.0, std::abs(key.least) * 1e-3)));
    }
    if (key.most < catalogue_no_limit) {
        samples.good.push_back(number_text(key, key.most));
        if (key.most < most_whole)
            samples.bad.push_back(number_text(key, key.most + std::max(1.0, std::abs(key.most) * 1e-3)));
    }
    if (key.name == "when_inside" || key.name == "inside")
        samples.good = {"-90", "90"};  // of its pairs the first is a latitude
    if (samples.good.empty()) samples.good.emplace_back("1");
    if (key.type == KeyType::whole_number) samples.bad.emplace_back("1.5");
    if (key.type == KeyType::number) samples.bad.emplace_back("nan");
    return samples;
}

std::string list_of(const std::string& item, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i)
        text += (i > 0 ? ", " : "") + item;
    return "[" + text + "]";
}

Samples lists_around(const KeyEntry& key) {
    const Samples single = numbers_around(key);
    const std::size_t least = std::max<std::size_t>(key.count_least, 1);
    Samples samples{{}, {"1", "\"x\""}};
    for (const std::string& good : single.good)
        samples.good.push_back(list_of(good, least));
    for (const std::string& bad : single.bad)
        samples.bad.push_back(list_of(bad, least));
    if (key.count_least > 1) samples.bad.push_back(list_of(single.good.front(), key.count_least - 1));
    if (key.count_most < 100) samples.bad.push_back(list_of(single.good.front(), key.count_most + 1));
    return samples;
}

Samples words_around(const KeyEntry& key) {
    Samples samples{{}, {"1", "\"no such word\""}};
    const bool list = key.type == KeyType::words;
    for (const std::string& word : key.choices)
        samples.good.push_back(fmt::format(fmt::runtime(list ? "[\"{}\"]" : "\"{}\""), word));
    if (key.type == KeyType::word_or_words) samples.good.push_back(fmt::format("[\"{}\"]", key.choices.front()));
    if (key.type != KeyType::word) samples.bad.emplace_back("[\"no such word\"]");
    if (list) samples.bad.emplace_back("[]");
    return samples;
}

// Values that the catalogue says a key takes, and others.
Samples samples_of(const KeyEntry& key) {
    switch (key.type) {
        case KeyType::number:
        case KeyType::whole_number:
            return numbers_around(key);
        case KeyType::flag:
            return {{"true", "false"}, {"1", "\"true\""}};
        case KeyType::time:
            return {{"2024-03-05T12:00:00Z", "\"2024-03-05T12:00:00Z\""}, {"1", "true"}};
        case KeyType::word:
        case KeyType::words:
        case KeyType::word_or_words:
            return words_around(key);
        case KeyType::numbers:
        case KeyType::whole_numbers:
        case KeyType::number_groups:
            return lists_around(key);
        case KeyType::place:
            return {{"[90, 360]", "[-90, -360, -1e4]", "[1, 2, 1e7]"},
                    {"[91, 0]", "[0, 361]", "[0, 0, 1.1e7]", "[0]", "[0, 0, 0, 0]", "\"x\""}};
        case KeyType::text:
            return {{"\"x\""}, {"1", "true", "[\"x\"]"}};
        case KeyType::texts:
            return {{"[\"x\", \"y\"]"}, {"1", "\"x\"", "[]"}};
        case KeyType::text_or_texts:
            return {{"\"x\"", "[\"x\", \"y\"]"}, {"1", "true", key.count_least > 0 ? "[]" : "[1]"}};
        default:
            return {};
    }
}

// Mistakes of type, range or choice; of what a value means to others nothing is said here.
bool refuses_the_value(const KeyEntry& key, const std::string& said, const std::string& place) {
    const bool text = key.type == KeyType::text || key.type == KeyType::texts || key.type == KeyType::text_or_texts;
    const std::vector<std::string_view> words =
        text ? std::vector<std::string_view>{"expected a text", "list of texts", "expected at least one text"}
             : std::vector<std::string_view>{
                   "expected a number", "expected a whole number", "expected a list", "expected one of",
                   "expected some of",  "expected true or false",  "expected a date", "degrees",
                   "height is",         "numbers; expected"};
    for (std::size_t at = said.find(place); at != std::string::npos; at = said.find(place, at + 1)) {
        const std::string line = said.substr(at, said.find('\n', at) - at);
        if (std::any_of(words.begin(), words.end(), [&](std::string_view w) { return line.find(w) != line.npos; }))
            return true;
    }
    return false;
}

template <class Check>
void for_each_key(Check check) {
    std::size_t count = 0;
    for (const KeyTable& table : scenario_key_tables())
        for (const KeyEntry& key : table.keys)
            if (!table.path.empty() && key.type != KeyType::table && key.type != KeyType::tables)
                check(table, key), ++count;
    EXPECT_GT(count, 400U);
}

TEST(KeyCatalogue, HoldsWhatTheReaderAsksFor) {
    EXPECT_EQ(key_of("run", "speed").least, 1e-3);
    EXPECT_EQ(key_of("run", "speed").standard, ParameterValue(1.0));
    EXPECT_EQ(key_of("run", "duration_s").standard, std::nullopt) << "until stopped is no number";
    EXPECT_EQ(key_of("sky", "constellations").type, KeyType::words);
    EXPECT_EQ(key_of("model", "name").standard, ParameterValue(std::string("modern")));
    EXPECT_EQ(key_of("model.modern.link", "man_made_noise").standard, ParameterValue(std::string("none")));
    EXPECT_EQ(key_of("atmosphere", "tec_source").standard, ParameterValue(std::string("automatic")));
    EXPECT_EQ(key_of("trajectory", "sway_m").kinds, std::vector<std::string>{"hover"});
    EXPECT_TRUE(key_of("trajectory", "heading_deg").kinds.empty());
    EXPECT_TRUE(key_of("trajectory", "waypoint").needed);
    EXPECT_TRUE(key_of("fault", "kind").needed);
    EXPECT_TRUE(table_of("expect").list);
    EXPECT_EQ(table_of("expect").one_of, (std::vector<KeyRule>{{{"what", "command"}, {}}}));
}

TEST(KeyCatalogue, EveryKindOfPathIsKnownToTheReader) {
    const std::vector<std::string>& kinds = table_of("trajectory").kinds;
    EXPECT_THAT(kinds, testing::IsSupersetOf({"circle", "file", "live", "hover", "sequence"}));
    for (const std::string& kind : kinds)
        EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"" + kind + "\"\n"), Not(HasSubstr("trajectory.kind: is")));
}

TEST(KeyCatalogue, TheReaderKnowsEveryKey) {
    for_each_key([](const KeyTable& table, const KeyEntry& key) {
        for (const std::string& kind : key.kinds.empty() ? std::vector<std::string>{""} : key.kinds) {
            if (kind.empty() && !table.kinds.empty()) continue;  // without its kind the reader knows nothing else
            const std::string text = frame_of(table, kind) + company_of(table, key) + key.name + " = 1979-05-27\n";
            EXPECT_THAT(mistakes_of(text), Not(HasSubstr("unknown key"))) << text;
        }
    });
    EXPECT_THAT(mistakes_of("[trajectory]\nkind = \"fixed\"\nradius_m = 1\n"), HasSubstr("unknown key"))
        << "the check can fail";
}

TEST(KeyCatalogue, TheReaderTakesAndRefusesTheSameValues) {
    for_each_key([](const KeyTable& table, const KeyEntry& key) {
        const Samples samples = samples_of(key);
        const std::string place = place_in(table, key);
        for (const std::string& value : samples.good) {
            const std::string said = said_of(table, key, value);
            EXPECT_FALSE(refuses_the_value(key, said, place)) << place << value << ": " << said;
        }
        for (const std::string& value : samples.bad)
            EXPECT_THAT(said_of(table, key, value), HasSubstr(place)) << value;
    });
}

std::string written(const ParameterValue& value) {
    if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
    if (const auto* text = std::get_if<std::string>(&value)) return "\"" + *text + "\"";
    if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.12g}", *number);
    if (const auto* numbers = std::get_if<std::vector<double>>(&value))
        return fmt::format("[{:.12g}]", fmt::join(*numbers, ", "));
    return "[\"" + fmt::format("{}", fmt::join(std::get<std::vector<std::string>>(value), "\", \"")) + "\"]";
}

TEST(KeyCatalogue, TheReaderTakesEveryDefault) {
    for_each_key([](const KeyTable& table, const KeyEntry& key) {
        if (!key.standard) return;
        const std::string said = said_of(table, key, written(*key.standard));
        EXPECT_FALSE(refuses_the_value(key, said, place_in(table, key))) << written(*key.standard) << ": " << said;
    });
}

TEST(KeyCatalogue, WhatIsNeededIsMissed) {
    std::size_t count = 0;
    for (const KeyTable& table : scenario_key_tables()) {
        std::vector<KeyRule> needed = table.one_of;
        for (const KeyEntry& key : table.keys)
            if (key.needed && !table.path.empty()) needed.push_back({{key.name}, key.kinds});
        for (const KeyRule& rule : needed) {
            const bool is_kind = rule.keys.front() == "kind";
            const std::string kind = is_kind || rule.kinds.empty() ? std::string() : rule.kinds.front();
            EXPECT_NE(mistakes_of(frame_of(table, kind)), "accepted") << table.path << "." << rule.keys.front();
            ++count;
        }
    }
    EXPECT_GT(count, 10U);
}

TEST(KeyCatalogue, WhatDoesNotStandTogetherIsRefused) {
    std::size_t count = 0;
    for (const KeyTable& table : scenario_key_tables())
        for (const KeyRule& rule : table.not_both) {
            std::string text = frame_of(table, rule.kinds.empty() ? std::string() : rule.kinds.front());
            for (const std::string& name : rule.keys) {
                const Samples samples = samples_of(key_of(table.path, name));
                text += name + " = " + (samples.good.empty() ? "{}" : samples.good.front()) + "\n";
            }
            EXPECT_NE(mistakes_of(text), "accepted") << text;
            ++count;
        }
    EXPECT_GT(count, 8U);
}

TEST(KeyCatalogue, NoReaderLooksForAKeyThatItNeverReads) {
    for (const KeyTable& table : scenario_key_tables())
        EXPECT_THAT(table.unread, IsEmpty()) << table.path;
}

TEST(KeyCatalogue, EveryKeyHasASentence) {
    for (const KeyTable& table : scenario_key_tables())
        for (const KeyEntry& key : table.keys)
            EXPECT_FALSE(key.meaning.empty()) << "the reader's call has no text for " << table.path << "." << key.name;
    EXPECT_EQ(key_of("run", "seed").meaning, "the same scenario, seed and inputs give the same bytes");
    EXPECT_EQ(key_of("run", "duration_s").standard_words, "until stopped");
}

TEST(KeyCatalogue, GivesOptionsTheirHelp) {
    EXPECT_EQ(key_help(scenario_key("receiver.0.rate_hz")),
              "Navigation rate at the factory, Hz; 0.01 to 100; default the board's");
    EXPECT_EQ(key_help(scenario_key("run.seed")),
              "The same scenario, seed and inputs give the same bytes; at least 0; default 1");
    EXPECT_EQ(scenario_key("trajectory.speed_mps", "file").least, 0.01);
    EXPECT_EQ(scenario_key("trajectory.speed_mps", "circle").least, -12000);
    EXPECT_THROW((void)scenario_key("run.sede"), std::out_of_range);
}

TEST(KeyCatalogue, TellsUnitsBySuffixes) {
    EXPECT_EQ(key_unit("speed_mps"), "m/s");
    EXPECT_EQ(key_unit("noise_figure_db"), "dB");
    EXPECT_EQ(key_unit("canopy_db_per_m"), "dB/m");
    EXPECT_EQ(key_unit("vapour_db_per_km_per_g_m3"), "dB/km per g/m³");
    EXPECT_EQ(key_unit("frequency_per_k"), "1/K");
    EXPECT_EQ(key_unit("seed"), "");
}

}  // namespace
}  // namespace skyloop
