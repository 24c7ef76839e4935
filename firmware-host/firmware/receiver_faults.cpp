// What faults make of a receiver.
#include <algorithm>

#include "base/core/number_text.hpp"
#include "base/core/std_additions.hpp"
#include "firmware/config/config_handler.hpp"
#include "firmware/config/config_keys.hpp"
#include "firmware/messages/make_message.hpp"
#include "firmware/port_id.hpp"
#include "firmware/receiver_core.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"

namespace skyloop::firmware {

UbxMessageId sentence_id(const SentenceView& sentence) {
    if (sentence.address != "PUBX") {
        const auto polls = polled_messages();
        const auto poll = std::find_if(polls.begin(), polls.end(), [&](const NamedMessage& m) {
            return m.id.message_class == class_nmea && m.name == sentence.formatter();
        });
        return poll == polls.end() ? UbxMessageId{} : poll->id;
    }
    // PUBX,41 is F1-41: the digits are those of the id.
    const std::string_view digits = sentence.field(0);
    const auto id = hexadecimal_number_in<std::uint8_t>(digits);
    return id ? UbxMessageId{class_pubx, *id} : UbxMessageId{};
}

void Receiver::Core::happen(const ReceiverEvent& event, GpsTime now) {
    std::visit(Overloaded{[&](const Reboot& e) {
                              if (e.loses_battery) store_.clear(in_battery);
                              reboot(Forgotten::of(e.kind), now, BootCause::power, e.banner);
                          },
                          [&](const RestartNavigation& e) {
                              restart_navigation(Forgotten::of(e.kind), now, board_.timing.signal_restart);
                          },
                          [&](const ForgetConfiguration&) { forget_configuration(now); },
                          [&](const ForceBaud& e) { force_baud(e, now); }},
               event);
}

// Without a word: what was queued still leaves, at the speed that the factory gave.
void Receiver::Core::forget_configuration(GpsTime now) {
    store_.clear(in_battery | in_flash);
    store_.reload();
    values_.cancel();
    forced_speed_.reset();
    adopt_settings();
    change_speeds_at_once(now);
}

void Receiver::Core::force_baud(const ForceBaud& wanted, GpsTime now) {
    const bool holds = holds_forced_speed();
    if (holds) store_.set(in_ram, key::uart1_baudrate, forced_speed_->before);
    if (wanted.baud == 0) {
        forced_speed_.reset();
    } else if (holds || !wanted.given_back) {
        const auto before = static_cast<std::uint32_t>(store_.value(key::uart1_baudrate));
        forced_speed_ = ForcedSpeed{wanted.baud, before, is_in_range(board_, key::uart1_baudrate, wanted.baud)};
        if (forced_speed_->is_setting) store_.set(in_ram, key::uart1_baudrate, wanted.baud);
    }
    adopt_settings();
    change_speeds_at_once(now);
}

// Until a client sets another one.
bool Receiver::Core::holds_forced_speed() const {
    if (!forced_speed_) return false;
    return store_.value(key::uart1_baudrate) ==
           (forced_speed_->is_setting ? forced_speed_->forced : forced_speed_->before);
}

// By the settings. A forced speed that the board cannot be set to stands in none of them: it would refuse all that it
// is told, and what it saved.
std::uint32_t Receiver::Core::wanted_baud(PortId port) const {
    if (port != PortId::uart1 || !holds_forced_speed()) return configured_baud(store_, port);
    return std::clamp(forced_speed_->forced, slowest_baud, fastest_baud);
}

void Receiver::Core::change_speeds_at_once(GpsTime now) {
    for (PortUnit& unit : units_) {
        const std::uint32_t baud = wanted_baud(unit.id);
        if (baud == unit.configured_baud) continue;
        unit.configured_baud = baud;
        const PortId port = unit.id;
        outbox_.plan(unit.transmit.between_bytes(now), [this, port](GpsTime then) { change_speed(port, then); });
    }
}

bool Receiver::Core::refuses_items(const UbxFrameView& frame) const {
    if (faults_.refused_keys.empty()) return false;
    const auto message = decode_payload<CfgValset>(frame.payload);
    return message && std::any_of(message->pairs.begin(), message->pairs.end(),
                                  [&](const ConfigPair& pair) { return faults_.refused_keys.contains(pair.key); });
}

bool Receiver::Core::stays_silent_to(UbxMessageId message) const {
    return faults_.unanswering || faults_.unanswered.contains(message);
}

std::vector<Bytes> Receiver::Core::answers_of(UbxMessageId polled, PortId port) {
    const ReportContext asked = context(port);
    const bool disguised = faults_.software || faults_.extensions;
    if (polled != MonVer::message_id || !disguised) return make_message(polled, asked);
    BoardProfile board = board_;
    if (faults_.software) board.identity.software = *faults_.software;
    if (faults_.extensions) board.identity.extensions = *faults_.extensions;
    return make_message(polled, {board, store_, asked.state, asked.ports, port});
}

void Receiver::Core::report(const NavigationState& state) {
    reported_ = std::make_shared<const NavigationState>(state);
}

void Receiver::Core::reset_odometer() {
    tracker_.reset_odometer();
    NavigationState shown = *reported_;
    shown.odometer_m = shown.odometer_deviation_m = 0;
    report(shown);
}

}  // namespace skyloop::firmware
