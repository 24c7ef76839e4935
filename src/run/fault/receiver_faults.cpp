// How a receiver misbehaves towards its client.
// Messages and configuration items by the names that people give them.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/number_text.hpp"
#include "base/core/result.hpp"
#include "base/core/words.hpp"
#include "detail/fault_catalogue.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "firmware/ublox/config/config_keys.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/ubx_messages.hpp"
#include "run/fault/parameters.hpp"

namespace skyloop::inline run {

namespace {

using firmware::NamedMessage;

// What clients send that stands in no other table of the firmware: u-blox F9 interface description HPG 1.32, section 3,
// and M8 interface description, 32 and 31.3: CFG-RST, CFG-VALSET, CFG-VALGET, CFG-VALDEL, NAV-RESETODO, PUBX-40 and
// -41.
constexpr UbxMessageId more_messages[] = {{0x06, 0x04}, {0x06, 0x8A}, {0x06, 0x8B}, {0x06, 0x8C},
                                          {0x01, 0x10}, {0xF1, 0x40}, {0xF1, 0x41}};

std::vector<NamedMessage> named_messages() {
    std::vector<NamedMessage> all;
    for (const UbxMessageId id : more_messages)
        if (const auto name = ubx_message_name(id)) all.push_back({id, *name});
    for (const auto& list : {firmware::polled_messages(), firmware::legacy_messages()})
        all.insert(all.end(), list.begin(), list.end());
    for (const firmware::OutputMessage& message : firmware::output_messages())
        all.push_back({message.id, message.name});
    return all;
}

std::optional<std::uint8_t> hexadecimal_byte(std::string_view digits) {
    return digits.size() == 2 ? hexadecimal_number_in<std::uint8_t>(digits) : std::nullopt;
}

// "UBX-0F-01".
std::optional<UbxMessageId> message_by_number(std::string_view name) {
    constexpr std::string_view prefix = "UBX-";
    if (name.size() != 9 || !name.starts_with(prefix) || name[6] != '-') return std::nullopt;
    const auto message_class = hexadecimal_byte(name.substr(4, 2)), id = hexadecimal_byte(name.substr(7, 2));
    if (!message_class || !id) return std::nullopt;
    return UbxMessageId{*message_class, *id};
}

Error nothing_named(std::string_view parameter, std::string_view expected) {
    return {ErrorCode::usage, fmt::format("{} names nothing; expected {}", parameter, expected)};
}

// The message of a name, in letters of any case: "MON-VER", "CFG-VALSET", "GGA", "PUBX,41", "RTCM-1005", or "UBX-0F-01"
// by class and id. Sentences have the ids of u-blox (classes F0, F1). Fails with `usage`; the nearest name is
// suggested.
Result<UbxMessageId> find_message(std::string_view name) {
    std::string wanted = upper_case(name);
    if (const auto id = message_by_number(wanted)) return *id;
    if (wanted.starts_with("PUBX,")) wanted[4] = '-';
    std::vector<std::string_view> known;
    for (const NamedMessage& message : named_messages()) {
        if (message.name == wanted) return message.id;
        known.push_back(message.name);
    }
    return fail(ErrorCode::usage, fmt::format("'{}' is no message that is known{}; expected a name like MON-VER, GGA, "
                                              "PUBX,41 or UBX-0A-04",
                                              name, did_you_mean(wanted, known)));
}

// The messages that a list of names means. Fails with `usage` when it is empty, or a name is not known.
Result<std::set<UbxMessageId>> read_messages(const Parameters& parameters, std::string_view parameter) {
    std::set<UbxMessageId> messages;
    for (const std::string& name : parameters.texts(parameter)) {
        const auto message = find_message(name);
        if (!message) return fail(ErrorCode::usage, fmt::format("{}: {}", parameter, message.error().message));
        messages.insert(*message);
    }
    if (messages.empty()) return fail(nothing_named(parameter, "at least one message"));
    return messages;
}

// The ids of configuration items that a list of names means: "CFG-RATE-MEAS", in letters of any case. Fails as
// read_messages().
Result<std::set<std::uint32_t>> read_items(const Parameters& parameters, std::string_view parameter) {
    std::set<std::uint32_t> items;
    for (const std::string& name : parameters.texts(parameter)) {
        const std::string wanted = upper_case(name);
        const firmware::ConfigKey* key = firmware::find_config_key(wanted);
        if (key == nullptr) {
            std::vector<std::string_view> known;
            for (const firmware::ConfigKey& each : firmware::config_keys())
                known.push_back(each.name);
            return fail(ErrorCode::usage, fmt::format("{}: '{}' is no configuration item{}; expected a name like "
                                                      "CFG-RATE-MEAS",
                                                      parameter, name, did_you_mean(wanted, known)));
        }
        items.insert(key->id);
    }
    if (items.empty()) return fail(nothing_named(parameter, "at least one configuration item"));
    return items;
}

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
     {"receiver_deaf",
      "The receiver hears nothing; its messages go on.",
      "A receive line that is not connected, which naive clients notice at configuration only.",
      {},
      switched<&FirmwareFaults::deaf>},
     {"never_answers",
      "The receiver executes what it hears, and answers nothing.",
      "Clones that take commands and have no acknowledgements.",
      {},
      switched<&FirmwareFaults::unanswering>},
     {"answers_selectively",
      "The receiver executes the named messages, and does not answer them.",
      "Clones and old firmware that know a part of the protocol.",
      {name_list("messages", "names of messages that stay unanswered: MON-VER, CFG-VALSET, UBX-0A-04")},
      of_messages<&FirmwareFaults::unanswered>},
     {"no_version",
      "MON-VER is never answered.",
      "Clones, and receivers that are still busy when the client asks (betaflight #15676).",
      {},
      make_no_version},
     {"withheld_messages",
      "The named messages are not sent with the epochs, whatever is configured.",
      "A configuration that was lost in part, or a message that the firmware no longer has.",
      {name_list("messages", "names of messages that are not sent: NAV-PVT, GGA")},
      of_messages<&FirmwareFaults::withheld>},
     {"refuses_keys",
      "CFG-VALSET with one of the named items is answered with ACK-NAK, and nothing of it is taken.",
      "Items that a firmware does not have, sent together with those that it has.",
      {name_list("keys", "names of configuration items: CFG-ITFM-ENABLE")},
      make_refuses_keys},
     {"refuses_messages",
      "The named messages are answered with ACK-NAK and do nothing; sentences do nothing.",
      "Old and new firmware that does not know each other's configuration messages.",
      {name_list("messages", "names of messages that are refused: CFG-GNSS, CFG-VALSET")},
      of_messages<&FirmwareFaults::refused>},
     {"wrong_version",
      "MON-VER tells another firmware.",
      "Clones with borrowed version strings, and updates that a driver has never seen.",
      {text_parameter("software", "", "swVersion, at most 30 characters; empty: as it is"),
       texts_parameter("extensions", "the extension strings, at most 30 characters each; none: as they are")},
      make_wrong_version},
     {"jamming_flag_hidden",
      "MON-HW and MON-RF say that interference is unknown; SEC-SIG alone tells it, on boards that have it.",
      "F9 HPG 1.50 and later, on which drivers that read MON-RF see no jamming (PX4-GPSDrivers #231).",
      {},
      switched<&FirmwareFaults::jamming_hidden>},
     {"forgets_configuration",
      "All settings are those of the factory, the speed among them, without a banner; it navigates on. "
      "The end of the fault gives nothing back: the client has to.",
      "A dip of the supply with an empty backup battery, in flight (betaflight, INAV #3908).",
      {},
      make_forgets_configuration},
     {"reboots",
      "The receiver starts anew, with what it has stored.",
      "A dip of the supply, a watchdog, or a static discharge.",
      {word_parameter("start", "hot", firmware::start_kind_names, "what it still knows"),
       flag_parameter("banner", true, "it says who it is as it starts")},
      make_reboots},
     {"slow_cold_start",
      "The receiver starts anew knowing nothing, and has no solution for long.",
      "A first start in a new place, without a battery or with a poor sky.",
      {number_parameter("without_fix_s", 120, 0, 1e6, "from the start without a solution, s")},
      make_slow_cold_start},
     {"changed_baud",
      "The speed of the first UART is another one; at the end it is back, unless the client has set one since.",
      "Settings that another client has stored, and drivers that trust what they set once (INAV #3908).",
      {whole_number_parameter("baud", 9600, 300, 12e6, "speed, bit/s")},
      make_changed_baud}}));

constexpr ParameterSpec delay(double standard, std::string_view meaning) {
    return number_parameter("delay_s", standard, 0, longest_delay_s, meaning);
}

constexpr auto slowness_kinds = std::to_array<FaultKind>(
    {{"slow_answers",
      "Answers come later than usual; the receiver goes on working meanwhile.",
      "A receiver that is busy with acquisition or with writing its flash.",
      {delay(1.5, "more before each answer, s")},
      make_slow_answers},
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
