/// The items of CFG-SIGNAL, system by system (F9 interface description HPG 1.32, CFG-SIGNAL).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/config/config_store.hpp"
#include "skyloop/gnss/satellite.hpp"

namespace skyloop::firmware {

inline constexpr std::uint32_t signal_group = 0x31;

/// 0 stands for no item.
struct SystemKeys {
    Constellation constellation;
    std::uint32_t enable;
    /// Of the band around 1575 MHz, and the only ones of systems that have no other; one of them must be on.
    std::array<std::uint32_t, 2> first;
    std::uint32_t second;  ///< what a receiver of two frequencies tracks besides
    bool is_major;         ///< counts among the systems that a receiver tracks at once (MON-GNSS)
};

inline constexpr std::array<SystemKeys, 7> system_keys_of_signals{{
    {Constellation::gps, 0x1031001F, {0x10310001, 0}, 0x10310003, true},
    {Constellation::sbas, 0x10310020, {0x10310005, 0}, 0, false},
    {Constellation::galileo, 0x10310021, {0x10310007, 0}, 0x1031000A, true},
    {Constellation::beidou, 0x10310022, {0x1031000D, 0x1031000F}, 0x1031000E, true},
    {Constellation::qzss, 0x10310024, {0x10310012, 0x10310014}, 0x10310015, false},
    {Constellation::glonass, 0x10310025, {0x10310018, 0}, 0x1031001A, true},
    {Constellation::navic, 0x10310026, {0x1031001D, 0}, 0, false},
}};

/// Systems that are switched on (CFG-SIGNAL-…_ENA).
std::vector<Constellation> enabled_systems(const ConfigStore& config);

}  // namespace skyloop::firmware
