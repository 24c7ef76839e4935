/// How an entry of the timeline is told: the keys that every fault and command has besides its own.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "run/fault/parameters.hpp"
#include "run/fault/timeline.hpp"

namespace skyloop::inline run {

/// Of faults; a command has those that timeline_keys_of_commands() gives.
std::span<const ParameterSpec> timeline_keys();
/// The same without length and ramps.
std::span<const ParameterSpec> timeline_keys_of_commands();

/// An entry by its checked keys; its name is empty where none is given. Fails with every contradiction among them.
struct TimelineReading {
    TimelineEntry entry;
    std::vector<ParameterMistake> mistakes;
};
TimelineReading read_timeline_entry(const Parameters& keys);

/// What is wrong with the name of an entry, of a scenario or of a live fault; nothing of an empty one.
std::optional<ParameterMistake> entry_name_mistake(const std::string& name);

/// What is wrong with the entries of a run together: `after` that names nobody, or a circle of them.
/// @return by place in the list
std::vector<std::pair<std::size_t, ParameterMistake>> timeline_mistakes(const std::vector<TimelineEntry>& entries);

}  // namespace skyloop::inline run
