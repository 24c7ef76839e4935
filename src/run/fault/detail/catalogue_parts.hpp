/// The kinds of each layer, which fault_kinds() puts in a row.
#pragma once

#include <initializer_list>
#include <utility>
#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// The kinds that each of these gives, one list after the other.
inline std::vector<FaultKind> all_kinds_of(std::initializer_list<std::vector<FaultKind> (*)()> parts) {
    std::vector<FaultKind> all;
    for (auto* const part : parts)
        for (FaultKind& kind : part())
            all.push_back(std::move(kind));
    return all;
}

/// The same kinds, as those that are there or are not.
inline std::vector<FaultKind> without_strength(std::vector<FaultKind> kinds) {
    for (FaultKind& kind : kinds)
        kind.has_strength = false;
    return kinds;
}

std::vector<FaultKind> reception_fault_kinds();  ///< outage, antenna, interference
std::vector<FaultKind> spoofing_fault_kinds();   ///< false signals
std::vector<FaultKind> satellite_fault_kinds();  ///< clocks, records, the air
std::vector<FaultKind> position_fault_kinds();   ///< of the solution
std::vector<FaultKind> time_fault_kinds();       ///< of the solution
std::vector<FaultKind> receiver_fault_kinds();
std::vector<FaultKind> wire_fault_kinds();

}  // namespace skyloop
