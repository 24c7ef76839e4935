/// Messages and configuration items by the names that people give them.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "base/core/result.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "run/fault/parameters.hpp"
#include "run/fault/receiver_needs.hpp"

namespace skyloop::inline run {

/// The message of a name, in letters of any case: "MON-VER", "CFG-VALSET", "GGA", "PUBX,41", "RTCM-1005", or
/// "UBX-0F-01" by class and id. Sentences have the ids of u-blox (classes F0, F1). Fails with `usage`; the nearest name
/// is suggested.
Result<UbxMessageId> find_message(std::string_view name);
/// The messages that a list of names means. Fails with `usage` when it is empty, or a name is not known.
Result<std::set<UbxMessageId>> read_messages(const Parameters& parameters, std::string_view parameter);
/// The ids of configuration items that a list of names means: "CFG-RATE-MEAS", in letters of any case. Fails as
/// read_messages().
Result<std::set<std::uint32_t>> read_items(const Parameters& parameters, std::string_view parameter);

// What a name stands for is out of a fault's reach; each as IdleValue.
std::string why_not_answered(const UsedReceiver& receiver, std::string_view name);
std::string why_not_refused(const UsedReceiver& receiver, std::string_view name);
std::string why_not_withheld(const UsedReceiver& receiver, std::string_view name);
std::string why_no_item(const UsedReceiver& receiver, std::string_view name);

}  // namespace skyloop::inline run
