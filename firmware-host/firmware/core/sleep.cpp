#include "firmware/core/sleep.hpp"

#include <algorithm>
#include <utility>

namespace skyloop::firmware {
namespace {

// UART2, UART3 and I2C wake nobody.
std::uint32_t wake_source(PortId port) {
    switch (port) {
        case PortId::uart1:
            return wake_by_uart_rx;
        case PortId::spi:
            return wake_by_spi_cs;
        case PortId::usb:
            return wake_by_usb;
        case PortId::i2c:
        case PortId::uart2:
        case PortId::uart3:
            break;
    }
    return 0;
}

}  // namespace

void SleepControl::plan(const Sleep& sleep, GpsTime from) {
    planned_ = sleep;
    try_at(from);
}

void SleepControl::try_at(GpsTime at) {
    tried_at_ = at;
    parts_.outbox.plan(at, [this](GpsTime t) { enter(t); });
}

// What was to be sent still leaves; nothing is measured meanwhile.
void SleepControl::enter(GpsTime now) {
    if (!planned_ || now < tried_at_) return;
    GpsTime drained = now;
    for (const PortUnit& unit : parts_.units)
        drained = std::max(drained, unit.transmit.drained_at().value_or(now));
    if (drained > now) return try_at(drained);
    const Sleep sleep = *std::exchange(planned_, std::nullopt);
    // Not worth it.
    if (sleep.saves_power && sleep.until && *sleep.until <= now) return;
    under_way_ = sleep;
    under_way_->since = now;
    parts_.outbox.clear();
    entered_();
}

bool SleepControl::is_ended_by(PortId port) const { return is_off() && (under_way_->wakes & wake_source(port)) != 0; }

Sleep SleepControl::end() {
    planned_.reset();
    return *std::exchange(under_way_, std::nullopt);
}

std::optional<GpsTime> SleepControl::next_change() const {
    if (is_off()) return under_way_->until;
    return planned_ ? std::optional(tried_at_) : std::nullopt;
}

}  // namespace skyloop::firmware
