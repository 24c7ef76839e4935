// How a receiver misbehaves towards its client.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "detail/fault_catalogue.hpp"
#include "detail/named_messages.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "run/fault/parameters.hpp"

namespace skyloop::inline run {

namespace {

using firmware::FirmwareFaults;

constexpr UbxMessageId mon_ver{0x0A, 0x04};
constexpr double longest_delay_s = 3600;

template <bool FirmwareFaults::*flag>
Result<Fault> switched(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::firmware>([](FirmwareFaults& faults, const FaultMoment&) { faults.*flag = true; });
}

// Messages that fall into one of the sets.
template <std::set<UbxMessageId> FirmwareFaults::*set>
Result<Fault> of_messages(const Parameters& parameters, const FaultContext&) {
    auto messages = read_messages(parameters, "messages");
    if (!messages) return fail(messages.error());
    return fault_of<&Fault::firmware>([messages = std::move(*messages)](FirmwareFaults& faults, const FaultMoment&) {
        (faults.*set).insert(messages.begin(), messages.end());
    });
}

Result<Fault> make_refuses_keys(const Parameters& parameters, const FaultContext&) {
    auto items = read_items(parameters, "keys");
    if (!items) return fail(items.error());
    return fault_of<&Fault::firmware>([items = std::move(*items)](FirmwareFaults& faults, const FaultMoment&) {
        faults.refused_keys.insert(items.begin(), items.end());
    });
}

Result<Fault> make_no_version(const Parameters&, const FaultContext&) {
    return fault_of<&Fault::firmware>(
        [](FirmwareFaults& faults, const FaultMoment&) { faults.unanswered.insert(mon_ver); });
}

Result<Fault> make_wrong_version(const Parameters& parameters, const FaultContext&) {
    const std::string software = parameters.text("software");
    const std::vector<std::string> extensions = parameters.texts("extensions");
    if (software.empty() && extensions.empty())
        return fail(ErrorCode::usage, "neither software nor extensions is given; expected one of them");
    constexpr std::size_t longest_text = 30;  // CH[30] of MON-VER
    std::vector<std::string> all = extensions;
    all.push_back(software);
    for (const std::string& text : all)
        if (text.size() > longest_text)
            return fail(ErrorCode::usage,
                        fmt::format("'{}' has {} characters; expected at most {}", text, text.size(), longest_text));
    return fault_of<&Fault::firmware>([=](FirmwareFaults& faults, const FaultMoment&) {
        if (!software.empty()) faults.software = software;
        if (!extensions.empty()) faults.extensions = extensions;
    });
}

Result<Fault> make_forgets_configuration(const Parameters&, const FaultContext&) {
    Fault fault;
    fault.at_start.emplace_back(firmware::ForgetConfiguration{});
    return fault;
}

Result<Fault> make_reboots(const Parameters& parameters, const FaultContext&) {
    Fault fault;
    const StartKind start = firmware::start_kind(parameters.text("start")).value_or(StartKind::hot);
    fault.at_start.emplace_back(firmware::Reboot{start, parameters.flag("banner")});
    return fault;
}

// After the cold start it has satellites and no solution for so long.
Result<Fault> make_slow_cold_start(const Parameters& parameters, const FaultContext&) {
    const double without_fix = parameters.number("without_fix_s");
    Fault fault = fault_of<&Fault::epoch>([without_fix](Epoch& epoch, const FaultMoment& moment) {
        if (moment.since_start.value() >= without_fix) return;
        epoch.fix.type = FixType::none;
        for (SatelliteStatus& s : epoch.fix.satellites)
            s.used = false;
    });
    fault.at_start.emplace_back(firmware::Reboot{StartKind::cold, true});
    return fault;
}

Result<Fault> make_changed_baud(const Parameters& parameters, const FaultContext&) {
    Fault fault;
    fault.at_start.emplace_back(firmware::ForceBaud{static_cast<std::uint32_t>(parameters.number("baud"))});
    fault.at_end.emplace_back(firmware::ForceBaud{0});
    return fault;
}

Result<Fault> make_slow_answers(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::firmware>(
        [delay = parameters.number("delay_s")](FirmwareFaults& faults, const FaultMoment& moment) {
            faults.answer_delay += Seconds(delay * moment.strength);
        });
}

Result<Fault> make_solution_latency(const Parameters& parameters, const FaultContext&) {
    const double delay = parameters.number("delay_s"), growth = parameters.number("growth_s_per_s");
    return fault_of<&Fault::firmware>([=](FirmwareFaults& faults, const FaultMoment& moment) {
        const double grown = std::min(longest_delay_s, delay + growth * moment.since_start.value());
        faults.solution_delay += Seconds(grown * moment.strength);
    });
}

Result<Fault> make_clock_drift(const Parameters& parameters, const FaultContext&) {
    return fault_of<&Fault::pace>([ppm = parameters.number("ppm")](PaceConditions& pace, const FaultMoment& moment) {
        pace.rate *= 1 + ppm * 1e-6 * moment.strength;
    });
}

constexpr ParameterSpec name_list(std::string_view name, std::string_view meaning) {
    return texts_parameter(name, meaning).that_is_needed();
}

constexpr auto switched_kinds = without_strength(std::to_array<FaultKind>(
    {{"receiver_silent",
      "The receiver sends nothing at all, and hears and navigates on.",
      "Firmware that hangs or a transmit pin that is dead, in flight (betaflight #13946, #15685).",
      {},
      switched<&FirmwareFaults::mute>},
     FaultKind{"receiver_deaf",
               "The receiver hears nothing; its messages go on.",
               "A receive line that is not connected, which naive clients notice at configuration only.",
               {},
               switched<&FirmwareFaults::deaf>}
         .that_needs(command_input),
     FaultKind{"never_answers",
               "The receiver executes what it hears, and answers nothing.",
               "Clones that take commands and have no acknowledgements.",
               {},
               switched<&FirmwareFaults::unanswering>}
         .that_needs(command_input),
     {"answers_selectively",
      "The receiver executes the named messages, and does not answer them.",
      "Clones and old firmware that know a part of the protocol.",
      {name_list("messages", "names of messages that stay unanswered: MON-VER, CFG-VALSET, UBX-0A-04")
           .judged_by(why_not_answered)},
      of_messages<&FirmwareFaults::unanswered>},
     FaultKind{"no_version",
               "MON-VER is never answered.",
               "Clones, and receivers that are still busy when the client asks (betaflight #15676).",
               {},
               make_no_version}
         .that_needs(version_answer),
     {"withheld_messages",
      "The named messages are not sent with the epochs, whatever is configured.",
      "A configuration that was lost in part, or a message that the firmware no longer has.",
      {name_list("messages", "names of messages that are not sent: NAV-PVT, GGA").judged_by(why_not_withheld)},
      of_messages<&FirmwareFaults::withheld>},
     {"refuses_keys",
      "CFG-VALSET with one of the named items is answered with ACK-NAK, and nothing of it is taken.",
      "Items that a firmware does not have, sent together with those that it has.",
      {name_list("keys", "names of configuration items: CFG-ITFM-ENABLE").judged_by(why_no_item)},
      make_refuses_keys},
     {"refuses_messages",
      "The named messages are answered with ACK-NAK and do nothing; sentences do nothing.",
      "Old and new firmware that does not know each other's configuration messages.",
      {name_list("messages", "names of messages that are refused: CFG-GNSS, CFG-VALSET").judged_by(why_not_refused)},
      of_messages<&FirmwareFaults::refused>},
     FaultKind{"wrong_version",
               "MON-VER tells another firmware.",
               "Clones with borrowed version strings, and updates that a driver has never seen.",
               {text_parameter("software", "", "swVersion, at most 30 characters; empty: as it is"),
                texts_parameter("extensions", "the extension strings, at most 30 characters each; none: as they are")},
               make_wrong_version}
         .that_needs(version_answer),
     FaultKind{"jamming_flag_hidden",
               "MON-HW and MON-RF say that interference is unknown; SEC-SIG alone tells it, on boards that have it.",
               "F9 HPG 1.50 and later, on which drivers that read MON-RF see no jamming (PX4-GPSDrivers #231).",
               {},
               switched<&FirmwareFaults::jamming_hidden>}
         .that_needs(hardware_monitor),
     FaultKind{"forgets_configuration",
               "All settings are those of the factory, the speed among them, without a banner; it navigates on. "
               "The end of the fault gives nothing back: the client has to.",
               "A dip of the supply with an empty backup battery, in flight (betaflight, INAV #3908).",
               {},
               make_forgets_configuration}
         .that_needs(command_input),
     {"reboots",
      "The receiver starts anew, with what it has stored.",
      "A dip of the supply, a watchdog, or a static discharge.",
      {word_parameter("start", "hot", firmware::start_kind_names, "what it still knows"),
       flag_parameter("banner", true, "it says who it is as it starts").that_needs(start_texts)},
      make_reboots},
     {"slow_cold_start",
      "The receiver starts anew knowing nothing, and has no solution for long.",
      "A first start in a new place, without a battery or with a poor sky.",
      {number_parameter("without_fix_s", 120, 0, 1e6, "from the start without a solution, s")},
      make_slow_cold_start},
     FaultKind{
         "changed_baud",
         "The speed of the first UART is another one; at the end it is back, unless the client has set one since.",
         "Settings that another client has stored, and drivers that trust what they set once (INAV #3908).",
         {whole_number_parameter("baud", 9600, 300, 12e6, "speed, bit/s")},
         make_changed_baud}
         .that_needs(wired_uart1)}));

constexpr ParameterSpec delay(double standard, std::string_view meaning) {
    return number_parameter("delay_s", standard, 0, longest_delay_s, meaning);
}

constexpr auto slowness_kinds = std::to_array<FaultKind>(
    {FaultKind{"slow_answers",
               "Answers come later than usual; the receiver goes on working meanwhile.",
               "A receiver that is busy with acquisition or with writing its flash.",
               {delay(1.5, "more before each answer, s")},
               make_slow_answers}
         .that_needs(command_input),
     {"solution_latency",
      "Solutions leave the receiver later after their epoch.",
      "Many signals at a high rate: the processor falls behind.",
      {delay(0.2, "more from the epoch to the first byte, s"),
       number_parameter("growth_s_per_s", 0, 0, 10, "growth of the delay, s per s of the fault")},
      make_solution_latency},
     {"clock_drift",
      "The receiver's clock, and with it the rate of its epochs, runs off the client's; all receivers of a run "
      "have one clock. Seen in runs against the clock alone: virtual time has no other clock.",
      "Crystals of flight controllers that are off by tens of ppm (ArduPilot #20566).",
      {number_parameter("ppm", 100, -100'000, 100'000, "how much faster the receiver is, 1e-6")},
      make_clock_drift}});

}  // namespace

std::vector<FaultKind> receiver_fault_kinds() {
    return all_kinds_of(FaultLayer::receiver, {switched_kinds, slowness_kinds});
}

}  // namespace skyloop::inline run
