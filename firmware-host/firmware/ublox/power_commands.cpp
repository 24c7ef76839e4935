// Commands that put a receiver off, and UBX-UPD-SOS.
#include <algorithm>

#include "base/core/number_text.hpp"
#include "firmware/ublox/ublox.hpp"
#include "receiver/protocol/ubx_cfg_device.hpp"
#include "receiver/protocol/ubx_hardware.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_raw.hpp"

namespace skyloop::firmware {
namespace {

constexpr std::uint32_t flag_backup = 1u << 1, flag_force = 1u << 2;
constexpr Nanoseconds longest_backup = std::chrono::hours(12 * 24);

}  // namespace

// A command without an answer. That it came by USB shows a host there, for which it stays on unless it is forced;
// without one it is woken by any pin in its short form, by those that it names in its longer one.
std::optional<SleepRequest> requested_backup(const UbxFrameView& frame, PortId from, const PowerAbility& ability) {
    RxmPmreq asked;
    asked.wakeup_sources = wake_by_every_pin;
    if (const auto whole = decode_payload<RxmPmreq>(frame.payload)) {
        asked = *whole;
    } else if (const auto brief = decode_payload<RxmPmreqShort>(frame.payload)) {
        asked.duration = brief->duration;
        asked.flags = brief->flags;
    } else {
        return std::nullopt;
    }
    const bool forced = (asked.flags & flag_force) != 0;
    const bool stays_on = !forced && (from == PortId::usb || ability.backup_needs_force);
    if (asked.version != 0 || (asked.flags & flag_backup) == 0 || stays_on) return std::nullopt;
    SleepRequest request{.wakes = asked.wakeup_sources & wake_by_every_pin};
    if (asked.duration > 0)
        request.length = std::min<Nanoseconds>(std::chrono::milliseconds(asked.duration), longest_backup);
    return request;
}

// On, GNSS stopped, or backup without USB.
CommandOutcome change_power_state(const UbxFrameView& frame) {
    const auto asked = decode_payload<CfgPwr>(frame.payload);
    const bool known = asked && asked->version == 1 &&
                       (asked->state == power_run || asked->state == power_stop || asked->state == power_backup);
    CommandOutcome outcome;
    outcome.verdict = acknowledgement(frame.id, known);
    if (!known) return outcome;
    if (asked->state == power_backup)
        outcome.sleep = SleepRequest{.wakes = wake_by_every_pin};
    else
        outcome.navigating = asked->state == power_run;
    return outcome;
}

// There is no backup, and none is made; to clear it is easily done.
CommandOutcome save_on_shutdown(const UbxFrameView& frame) {
    constexpr std::uint8_t create = 0, clear = 1, created = 2, restored = 3, no = 0, no_backup = 3;
    const auto status = [](std::uint8_t subject, std::uint8_t response) {
        return encode_frame(UpdSosStatus{.cmd = subject, .reserved0 = {}, .response = response, .reserved1 = {}});
    };
    CommandOutcome outcome;
    const auto asked = decode_payload<UpdSos>(frame.payload);
    if (frame.payload.empty())
        outcome.answers.push_back(status(restored, no_backup));
    else if (asked && asked->cmd == create)
        outcome.answers.push_back(status(created, no));
    else
        outcome.verdict = acknowledgement(frame.id, asked && asked->cmd == clear);
    return outcome;
}

UbxMessageId sentence_id(const SentenceView& sentence) {
    if (sentence.address != "PUBX") {
        const auto polls = polled_messages();
        const auto poll = std::ranges::find_if(polls, [&](const NamedMessage& m) {
            return m.id.message_class == class_nmea && m.name == sentence.formatter();
        });
        return poll == polls.end() ? UbxMessageId{} : poll->id;
    }
    // PUBX,41 is F1-41: the digits are those of the id.
    const auto id = hexadecimal_number_in<std::uint8_t>(sentence.field(0));
    return id ? UbxMessageId{class_pubx, *id} : UbxMessageId{};
}

}  // namespace skyloop::firmware
