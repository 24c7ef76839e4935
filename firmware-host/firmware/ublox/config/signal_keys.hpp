/// The items of CFG-SIGNAL, system by system (F9 interface description HPG 1.32, CFG-SIGNAL).
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "firmware/ublox/config/config_store.hpp"
#include "world/flow/receiver_settings.hpp"
#include "world/gnss/satellite.hpp"

namespace skyloop::firmware {

inline constexpr std::uint32_t signal_group = 0x31;

/// 0 stands for no item.
struct SystemKeys {
    Constellation constellation;
    std::uint32_t enable;
    /// Of the band around 1575 MHz, and the only ones of systems that have no other; one of them must be on.
    std::array<std::uint32_t, 2> first;
    bool is_major;  ///< counts among the systems that a receiver tracks at once (MON-GNSS)
};

inline constexpr std::array<SystemKeys, 7> system_keys_of_signals{{
    {Constellation::gps, 0x1031001F, {0x10310001, 0}, true},
    {Constellation::sbas, 0x10310020, {0x10310005, 0}, false},
    {Constellation::galileo, 0x10310021, {0x10310007, 0}, true},
    {Constellation::beidou, 0x10310022, {0x1031000D, 0x1031000F}, true},
    {Constellation::qzss, 0x10310024, {0x10310012, 0x10310014}, false},
    {Constellation::glonass, 0x10310025, {0x10310018, 0}, true},
    {Constellation::navic, 0x10310026, {0x1031001D, 0}, false},
}};

/// An item of CFG-SIGNAL and what it lets a receiver measure.
struct SignalKey {
    SystemSignal signal;
    std::uint32_t enable;
};
/// B1C is measured as B1I is, of the satellites that send it, and E5a and B2a as the signals of their carrier.
inline constexpr std::array<SignalKey, 19> signal_keys{{{{Constellation::gps, Signal::l1}, 0x10310001},
                                                        {{Constellation::gps, Signal::l2}, 0x10310003},
                                                        {{Constellation::gps, Signal::l5}, 0x10310004},
                                                        {{Constellation::sbas, Signal::l1}, 0x10310005},
                                                        {{Constellation::galileo, Signal::l1}, 0x10310007},
                                                        {{Constellation::galileo, Signal::l5}, 0x10310009},
                                                        {{Constellation::galileo, Signal::e5b}, 0x1031000A},
                                                        {{Constellation::galileo, Signal::e6}, 0x1031000B},
                                                        {{Constellation::beidou, Signal::b1i}, 0x1031000D},
                                                        {{Constellation::beidou, Signal::e5b}, 0x1031000E},
                                                        {{Constellation::beidou, Signal::b1i}, 0x1031000F},
                                                        {{Constellation::beidou, Signal::b3i}, 0x10310010},
                                                        {{Constellation::qzss, Signal::l1}, 0x10310012},
                                                        {{Constellation::qzss, Signal::l2}, 0x10310015},
                                                        {{Constellation::qzss, Signal::l5}, 0x10310017},
                                                        {{Constellation::glonass, Signal::g1}, 0x10310018},
                                                        {{Constellation::glonass, Signal::g2}, 0x1031001A},
                                                        {{Constellation::navic, Signal::l5}, 0x1031001D},
                                                        {{Constellation::beidou, Signal::l5}, 0x10310028}}};

/// What can be measured: signals that are on, of systems that are on.
std::set<SystemSignal> enabled_signals(const ConfigStore& config);
/// Systems that can be heard: switched on (CFG-SIGNAL-…_ENA), and with a signal of theirs that is on too.
std::vector<Constellation> enabled_systems(const ConfigStore& config);
/// Whether that one is among them.
bool is_enabled(const ConfigStore& config, Constellation system);

}  // namespace skyloop::firmware
