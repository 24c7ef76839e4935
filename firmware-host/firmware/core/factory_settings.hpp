/// How receivers that are no u-blox begin: by the board file and by what a run says.
#pragma once

#include <array>
#include <set>

#include "firmware/core/board_profile.hpp"
#include "firmware/core/receiver.hpp"
#include "firmware/core/receiver_config.hpp"

namespace skyloop::firmware {

/// Systems, signals, rate, mask, motion, sentences' form and speeds.
ReceiverConfig factory_settings(const BoardProfile& board, const ReceiverOptions& options);

/// Systems in the order of ReceiverConfig::systems.
inline constexpr std::array<Constellation, 7> systems_in_order{
    Constellation::gps,  Constellation::sbas,    Constellation::galileo, Constellation::beidou,
    Constellation::qzss, Constellation::glonass, Constellation::navic};
/// Whether a system does so by itself: GPS, GLONASS, BeiDou and Galileo do.
bool gives_position(Constellation system);
/// The signals of a system that the board tracks from the factory on.
std::set<SystemSignal> factory_signals(const BoardProfile& board, Constellation system);

/// The period of so many measurements of `measurement` each, made longer by whole ones until the board can follow.
Nanoseconds feasible_period(Nanoseconds measurement, std::int64_t measurements, const BoardProfile& board);
/// The measurement period of a rate, in whole milliseconds, 1 … 65535. @param rate_hz 0: the board's own
std::uint64_t measurement_period_ms(const BoardProfile& board, double rate_hz);
/// Puts a navigation period in force: beyond a certain rate a board solves with fewer satellites.
void set_navigation_period(ReceiverSettings& settings, Nanoseconds period, const BoardProfile& board);

}  // namespace skyloop::firmware
