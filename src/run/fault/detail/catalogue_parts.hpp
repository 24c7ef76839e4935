/// The kinds of each layer, which fault_kinds() puts in a row.
#pragma once

#include <array>
#include <initializer_list>
#include <span>
#include <vector>

#include "run/fault/fault_kind.hpp"

namespace skyloop {

/// The kinds of these tables, one table after the other, all of one layer.
inline std::vector<FaultKind> all_kinds_of(FaultLayer layer, std::initializer_list<std::span<const FaultKind>> tables) {
    std::vector<FaultKind> all;
    for (const auto table : tables)
        all.insert(all.end(), table.begin(), table.end());
    for (FaultKind& kind : all)
        kind.layer = layer;
    return all;
}

/// The same kinds, as those that are there or are not.
template <std::size_t n>
constexpr std::array<FaultKind, n> without_strength(std::array<FaultKind, n> kinds) {
    for (FaultKind& kind : kinds)
        kind.has_strength = false;
    return kinds;
}

extern const FaultKind jamming_fault;            ///< by J/S, or by where the jammer stands and how strong it is
extern const FaultKind multipath_burst_fault;    ///< echoes that come and go
std::vector<FaultKind> reception_fault_kinds();  ///< outage, antenna, interference
std::vector<FaultKind> spoofing_fault_kinds();   ///< false signals
std::vector<FaultKind> satellite_fault_kinds();  ///< clocks, records, the air
std::vector<FaultKind> range_fault_kinds();      ///< measurements that are wrong in the receiver
std::vector<FaultKind> position_fault_kinds();   ///< of the solution
std::vector<FaultKind> report_fault_kinds();     ///< of what is reported while the receiver itself knows better
std::vector<FaultKind> time_fault_kinds();       ///< of the solution
std::vector<FaultKind> receiver_fault_kinds();
std::vector<FaultKind> wire_fault_kinds();

}  // namespace skyloop
