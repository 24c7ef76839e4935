/// The three parts in which NAV and TIM messages are made, and what they share.
#pragma once

#include <vector>

#include "firmware/navigation_state.hpp"

namespace skyloop::firmware {

/// NAV messages of position, velocity and quality. Empty for any other.
std::vector<Bytes> make_solution_message(UbxMessageId message, const ReportContext& context);
/// NAV-TIME…, NAV-CLOCK and class TIM. Empty for any other.
std::vector<Bytes> make_time_message(UbxMessageId message, const ReportContext& context);
/// The other NAV messages without satellites: covariances, odometer, base station, fences, end of the epoch. Empty for
/// any other.
std::vector<Bytes> make_service_message(UbxMessageId message, const ReportContext& context);

/// A DOP of a message: 0.01, 99.99 at most and where it was not computed.
std::uint16_t dop_field(double dop, bool computed);
/// Satellites in the solution; 0 without one.
std::uint8_t used_satellites(const Fix& fix);
/// The course, frozen at low speed, 1e-5 deg, 0 … 35 999 999.
std::int32_t course_field(const NavigationState& state);
/// 1 σ of it, 1e-5 deg, 180° at most and while it is frozen.
std::uint32_t heading_accuracy_field(const NavigationState& state);

}  // namespace skyloop::firmware
