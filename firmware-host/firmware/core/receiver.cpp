#include "firmware/core/receiver.hpp"

#include "firmware/core/core.hpp"
#include "firmware/makers.hpp"
#include "firmware/sentences/nmea_report.hpp"

namespace skyloop::firmware {

Receiver::Receiver(BoardProfile board, const ReceiverOptions& options) {
    const MakerRow& row = maker_row(board.maker);
    core_ = std::make_unique<Core>(std::move(board), options, row);
}
Receiver::Receiver(BoardProfile board, const ReceiverOptions& options, const MakerRow& row)
    : core_(std::make_unique<Core>(std::move(board), options, row)) {}
Receiver::~Receiver() = default;
Receiver::Receiver(Receiver&&) noexcept = default;
Receiver& Receiver::operator=(Receiver&&) noexcept = default;

void Receiver::start(GpsTime now) { core_->start(now); }
void Receiver::input(PortId port, ByteSpan bytes, GpsTime now) { core_->input(port, bytes, now); }
void Receiver::on_epoch(const Epoch& epoch, const ReportEdit& edit) { core_->on_epoch(epoch, edit); }
void Receiver::set_faults(const FirmwareFaults& faults) { core_->parts().faults = faults; }
void Receiver::happen(const ReceiverEvent& event, GpsTime now) { core_->happen(event, now); }
std::vector<Receiver::Sent> Receiver::output(GpsTime now) { return core_->output(now); }
std::optional<GpsTime> Receiver::drained_at() const { return core_->parts().outbox.drained_at(); }
std::optional<GpsTime> Receiver::next_output(PortId port) const { return core_->parts().outbox.next_at(port); }
std::optional<GpsTime> Receiver::next_change() const { return core_->next_change(); }

bool Receiver::has(PortId port) const { return find_unit(core_->parts().units, port) != nullptr; }
std::uint32_t Receiver::baud(PortId port) const {
    const PortUnit* unit = find_unit(core_->parts().units, port);
    return unit == nullptr ? 0 : unit->transmit.baud();
}
PortStatus Receiver::port_status(PortId port) const {
    const PortUnit* unit = find_unit(core_->parts().units, port);
    return unit == nullptr ? PortStatus{port} : unit->status;
}
PortTotals Receiver::port_totals(PortId port) const {
    const PortUnit* unit = find_unit(core_->parts().units, port);
    return unit == nullptr ? PortTotals{} : unit->totals;
}
const ReceiverSettings& Receiver::settings() const { return core_->settings(); }
const ReceiverSettings& Receiver::settings_at(GpsTime epoch) { return core_->settings_at(epoch); }
ReceiverCounters Receiver::counters() const { return core_->counters(); }
const BoardProfile& Receiver::board() const { return core_->parts().board; }
const NavigationState& Receiver::state() const { return *core_->parts().reported; }
std::shared_ptr<const NavigationState> Receiver::kept_state() const { return core_->parts().reported; }
std::string Receiver::position_sentence() const {
    constexpr UbxMessageId gga{0xF0, 0x00};
    const ReceiverParts& parts = core_->parts();
    const NmeaReport report = nmea_report({parts.board, parts.maker->config(), *parts.reported});
    if (!report.valid || !report.position) return {};
    std::string sentence = to_string(make_nmea_message(gga, report).front());
    sentence.erase(sentence.find_last_not_of("\r\n") + 1);
    return sentence;
}
std::optional<GpsTime> Receiver::report_time() const { return core_->report_time(); }
std::string Receiver::persistent_text() const { return core_->parts().maker->stored_text(); }

Result<void> Receiver::configure(const std::map<std::uint32_t, std::uint64_t>& items) {
    auto configured = core_->parts().maker->configure(items);
    if (configured) core_->begin_as_stored();
    return configured;
}
Result<void> Receiver::restore(const std::string& text, const std::string& name) {
    auto restored = core_->parts().maker->restore(text, name);
    if (restored) core_->begin_as_stored();
    return restored;
}
void Receiver::remember(const Geodetic& position, Metres geoid_undulation) {
    core_->remember(position, geoid_undulation);
}

}  // namespace skyloop::firmware
