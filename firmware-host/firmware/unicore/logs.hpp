/// From the receiver's state to the logs of a Unicore receiver.
#pragma once

#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/core/maker.hpp"
#include "firmware/unicore/settings.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "receiver/protocol/unicore_logs.hpp"

namespace skyloop::firmware {

/// The head of a log of the last epoch. Before the time is known the week is 1 and the time of week that since the
/// start (a capture of such a receiver; gnss_parse tests on GitHub show `UNKNOWN,1,8338000`).
UnicoreHeader unicore_header(const ReportContext& context);

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
std::vector<Bytes> unicore_messages(const UnicoreLogKind& kind, EpochMessages& made, PortId port,
                                    std::span<const UbxMessageId> following);

}  // namespace skyloop::firmware
