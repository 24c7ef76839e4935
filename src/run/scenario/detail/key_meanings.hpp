/// What the keys of scenarios mean, for people. Faults and commands tell of their own keys in their tables.
#pragma once

#include <span>
#include <string_view>

namespace skyloop {

/// One key, or one table, by its place.
struct KeyMeaning {
    std::string_view table;  ///< its path; a last part of `*` stands for any
    std::string_view key;
    std::string_view meaning;        ///< half a sentence
    std::string_view standard = {};  ///< what an absent key stands for, where that is no fixed value
};

/// Of the run, the sky, the way, the receivers and what is expected; in the order of the file.
std::span<const KeyMeaning> run_key_meanings();
/// Of the sensor models and the atmosphere.
std::span<const KeyMeaning> path_key_meanings();
std::span<const KeyMeaning> model_key_meanings();
/// Of [model.modern].
std::span<const KeyMeaning> modern_key_meanings();

/// The one of a key, or null.
const KeyMeaning* find_key_meaning(std::string_view table, std::string_view key);

}  // namespace skyloop
