/// From the receiver's state to the logs of a Unicore receiver.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/unicore/settings.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "receiver/protocol/unicore_logs.hpp"

namespace skyloop::firmware {

/// The head of a log of the last epoch. Before the time is known the week is 1 and the time of week that since the
/// start (`UNKNOWN,1,8338000` in a log of such a receiver).
/// @param asked when it was asked for, which tells its delay (captures: 813 and 969 ms); nothing: it comes with the
///        epoch
UnicoreHeader unicore_header(const ReportContext& context, std::optional<GpsTime> asked = {});

UnicoreBestNav unicore_best_nav(const ReportContext& context);
UnicoreRecTime unicore_rec_time(const ReportContext& context);
/// @param text the log is text, which has the whole name of the firmware where binary has the build alone (capture)
UnicoreVersion unicore_version(const BoardProfile& board, bool text);
UnicoreAgric unicore_agric(const ReportContext& context);
/// From this antenna, the master, to the other one of the pair, the slave.
UnicoreHeading unicore_heading(const ReportContext& context);
UnicorePvtsln unicore_pvtsln(const ReportContext& context);
UnicoreObsVm unicore_obs_vm(const ReportContext& context);

/// The messages of a log: one most often, none before there is anything to tell.
/// @param following corrections that leave by the port in the same epoch after it
std::vector<Bytes> unicore_messages(const UnicoreLogKind& kind, EpochMessages& made, PortId port,
                                    std::span<const UbxMessageId> following, std::optional<GpsTime> asked = {});

}  // namespace skyloop::firmware
