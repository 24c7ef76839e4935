/// What faults, settings and expectations need of a receiver for anything to come of them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware/core/board_profile.hpp"
#include "firmware/core/port_id.hpp"
#include "firmware/makers.hpp"
#include "world/flow/receiver_settings.hpp"

namespace skyloop::inline run {

/// A receiver as a run begins with it.
struct UsedReceiver {
    const firmware::BoardProfile& board;  ///< with what the scenario changes of it
    const ReceiverSettings& settings;
    std::vector<firmware::PortId> wired{};  ///< its ports that lead somewhere
    bool measures = true;                   ///< by the model "modern"; sensor models measure nothing
};

/// Something that a receiver has or lacks.
struct ReceiverNeed {
    std::string_view lack{};  ///< said of a receiver without it: "takes no commands"
    bool (*met)(const UsedReceiver&) = nullptr;
};

/// Why a value of a parameter comes to nothing at a receiver: a phrase behind its board's name; empty: it acts.
using IdleValue = std::string (*)(const UsedReceiver&, std::string_view);

/// An ability of the board as it is built, which a client's configuration does not take from it.
template <bool firmware::Abilities::*ability>
bool can(const UsedReceiver& receiver) {
    return firmware::abilities(receiver.board).*ability;
}
bool takes_commands(const UsedReceiver& receiver);
bool reports_heading(const UsedReceiver& receiver);
bool reports_accuracies(const UsedReceiver& receiver);
bool reports_weeks(const UsedReceiver& receiver);
bool reports_time(const UsedReceiver& receiver);
bool reports_calendar(const UsedReceiver& receiver);
bool solves_rtk(const UsedReceiver& receiver);
bool reports_dead_reckoning(const UsedReceiver& receiver);
bool has_texts_at_start(const UsedReceiver& receiver);
bool has_wired_uart1(const UsedReceiver& receiver);
bool is_can_node(const UsedReceiver& receiver);

/// Commands of its client: configuration, polls.
inline constexpr ReceiverNeed command_input{"takes no commands", takes_commands};
inline constexpr ReceiverNeed version_answer{"does not answer MON-VER", can<&firmware::Abilities::version>};
inline constexpr ReceiverNeed hardware_monitor{"has neither MON-HW nor MON-RF",
                                               can<&firmware::Abilities::hardware_monitor>};
inline constexpr ReceiverNeed jamming_report{"has no message that reports jamming", can<&firmware::Abilities::jamming>};
/// NAV-STATUS from u-blox 8 on, SEC-SIG, RFStatus.
inline constexpr ReceiverNeed spoofing_report{"has no message that reports spoofing",
                                              can<&firmware::Abilities::spoofing>};
inline constexpr ReceiverNeed heading_report{"has no message with the vector of a pair", reports_heading};
inline constexpr ReceiverNeed accuracy_report{"has no message with accuracies", reports_accuracies};
inline constexpr ReceiverNeed time_report{"has no message with the time", reports_time};
inline constexpr ReceiverNeed calendar_report{"has no message with the calendar of UTC", reports_calendar};
inline constexpr ReceiverNeed week_report{"has no message with week numbers", reports_weeks};
inline constexpr ReceiverNeed correction_input{"takes no corrections", can<&firmware::Abilities::corrections>};
inline constexpr ReceiverNeed rtk_solution{"has no RTK", solves_rtk};
inline constexpr ReceiverNeed dead_reckoning_report{"never reports dead reckoning", reports_dead_reckoning};
inline constexpr ReceiverNeed time_mode{"has no CFG-TMODE for a fix of time only",
                                        can<&firmware::Abilities::time_mode>};
inline constexpr ReceiverNeed start_texts{"sends no texts when it starts", has_texts_at_start};
inline constexpr ReceiverNeed can_node{"is not a node of a CAN bus", is_can_node};
inline constexpr ReceiverNeed wired_uart1{"has nothing at its UART1", has_wired_uart1};

/// Whether it sends a message with its epochs, from the factory on or once a client has enabled it.
bool sends_periodically(const UsedReceiver& receiver, UbxMessageId message);
/// Whether that is a client's choice by a command line, of which messages there are no rates.
bool sends_by_command_line(const UsedReceiver& receiver, UbxMessageId message);
/// Whether the board can track a system: one of those that it can be set to, where a document says which.
bool can_track(const firmware::BoardProfile& board, Constellation constellation);
/// Whether it receives second signals, where a document says so.
bool has_second_band(const firmware::BoardProfile& board);

/// Whether a receiver of this board can be told to send RTCM.
bool sends_rtcm(const firmware::BoardProfile& board);

/// Why a receiver never sends a message that is called so, as dialogues and expectations name it: a phrase behind its
/// board's name; empty: it sends it, or may. @param wanted as is_message_named() takes it
std::string why_never_sent(const UsedReceiver& receiver, std::string_view wanted);

}  // namespace skyloop::inline run
