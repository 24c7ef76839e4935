/// The receiver's state as CASIC's binary messages tell it.
#pragma once

#include <optional>

#include "base/core/bytes.hpp"
#include "firmware/core/navigation_state.hpp"
#include "receiver/protocol/casic_messages.hpp"

namespace skyloop::firmware {

CasicNavDop casic_dop(const ReportContext& context);
CasicNavSol casic_solution(const ReportContext& context);
CasicNavPv casic_position(const ReportContext& context);
CasicNavTimeutc casic_time(const ReportContext& context);

/// The frame of one of casic_periodic; nothing for another message.
std::optional<Bytes> casic_frame(CasicMessageId message, const ReportContext& context);
/// The sentence about the antenna.
Bytes casic_antenna_text(const ReportContext& context);

}  // namespace skyloop::firmware
