#include "firmware/receiver.hpp"

#include <algorithm>
#include <cmath>

namespace skyloop::firmware {
namespace {

// Receivers store the period as a 16-bit number of milliseconds (CFG-RATE measRate, RECEIVER.md 3.3).
Nanoseconds navigation_period(const BoardProfile& board, double rate_hz) {
    constexpr double longest_ms = 65535;
    const double rate = std::min(rate_hz > 0 ? rate_hz : board.default_rate_hz, board.max_rate_hz);
    return std::chrono::milliseconds(std::llround(std::clamp(1000.0 / rate, 1.0, longest_ms)));
}

constexpr int text_of_error = 0;

}  // namespace

Receiver::Receiver(BoardProfile board, double rate_hz, ReceiverSettings settings)
    : board_(std::move(board)),
      settings_(std::move(settings)),
      nmea_(board_),
      port_(board_.baud, board_.transmit_buffer_bytes) {
    settings_.navigation_period = navigation_period(board_, rate_hz);
}

void Receiver::input(ByteSpan bytes, GpsTime) { counters_.bytes_received += bytes.size(); }

void Receiver::on_epoch(const Epoch& epoch) {
    const GpsTime ready = advanced(epoch.fix.time, board_.solution_latency);
    const auto send = [&](const std::string& sentence) {
        const bool queued = port_.queue(to_bytes(sentence), ready);
        ++(queued ? counters_.messages_sent : counters_.messages_dropped);
        return queued;
    };
    bool overflow = false;
    for (const std::string& sentence : nmea_.sentences(epoch, counters_.epochs))
        overflow |= !send(sentence);
    if (overflow && board_.quirks.overflow_notice) send(nmea_.text_message(text_of_error, "txbuf alloc"));
    ++counters_.epochs;
}

Bytes Receiver::output(GpsTime now) { return port_.take(now); }

std::optional<GpsTime> Receiver::drained_at() const { return port_.drained_at(); }

}  // namespace skyloop::firmware
