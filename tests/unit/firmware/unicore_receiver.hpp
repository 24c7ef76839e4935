/// A Unicore receiver with clients at its three ports, and what leaves it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "receiver_rig.hpp"

namespace skyloop::firmware {

/// A line of text, without its end, and when its last byte had left.
struct UnicoreLine {
    std::string text;
    GpsTime at;
};

class UnicoreReceiver : public testing::Test {
protected:
    explicit UnicoreReceiver(const std::string& board = "unicore-um982")
        : receiver_(test::board_named(board), ReceiverOptions{}) {
        receiver_.start(now_);
    }

    // Runs for so long, an epoch each period of the receiver; lines and bytes of the ports are kept.
    void wait(Nanoseconds length) {
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += std::chrono::milliseconds(1);
            for (const Receiver::Sent& sent : receiver_.output(now_))
                keep(sent);
            if (now_.time_since_epoch() % receiver_.settings().navigation_period != Nanoseconds(0)) continue;
            Epoch epoch = epoch_;
            epoch.fix.time = now_;
            if (!epoch.observations.signals.empty()) epoch.observations.receive_time = now_;
            receiver_.on_epoch(epoch);
        }
    }
    void say(const std::string& line, PortId port = PortId::uart1) {
        receiver_.input(port, to_bytes(line + "\r\n"), now_);
    }
    // What comes within 200 ms of a command, by the same port.
    std::vector<std::string> answers(const std::string& line, PortId port = PortId::uart1) {
        lines_[port].clear();
        say(line, port);
        wait(std::chrono::milliseconds(200));
        return texts(port);
    }
    std::vector<std::string> texts(PortId port = PortId::uart1) {
        std::vector<std::string> found;
        for (const UnicoreLine& line : lines_[port])
            found.push_back(line.text);
        return found;
    }
    // Those that begin so.
    std::vector<UnicoreLine> lines(const std::string& begin, PortId port = PortId::uart1) {
        std::vector<UnicoreLine> found;
        for (const UnicoreLine& line : lines_[port])
            if (line.text.starts_with(begin)) found.push_back(line);
        return found;
    }
    void forget() {
        lines_.clear();
        bytes_.clear();
    }

    Receiver receiver_;
    Epoch epoch_{test::driving_fix({})};
    GpsTime now_ = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    std::map<PortId, std::vector<UnicoreLine>> lines_;
    std::map<PortId, Bytes> bytes_;

private:
    void keep(const Receiver::Sent& sent) {
        Bytes& all = bytes_[sent.port];
        all.insert(all.end(), sent.bytes.begin(), sent.bytes.end());
        std::string& begun = begun_[sent.port];
        for (const std::uint8_t byte : sent.bytes) {
            if (byte == '\n') {
                if (begun.ends_with('\r')) begun.pop_back();
                lines_[sent.port].push_back({begun, now_});
                begun.clear();
            } else {
                begun += static_cast<char>(byte);
            }
        }
    }
    std::map<PortId, std::string> begun_;
};

}  // namespace skyloop::firmware
