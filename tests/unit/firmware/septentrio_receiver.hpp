/// A Septentrio receiver with an epoch each period, and what leaves it.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "sample_epochs.hpp"

namespace skyloop::firmware {

inline BoardProfile septentrio_board() {
    BoardProfile board = sample_board(NmeaVersion::v4_0, {Constellation::gps, Constellation::galileo});
    board.maker = MakerKind::sbf;
    board.sentences.clear();
    board.baud = 115200;
    board.default_rate_hz = 5;
    board.max_rate_hz = 50;
    board.ports = {PortId::uart1, PortId::usb};
    return board;
}

class SeptentrioReceiver : public testing::Test {
protected:
    SeptentrioReceiver() {
        fix_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500);
        add_satellites(fix_, Constellation::gps, 1, 12);
        receiver_.start(fix_.time);
    }
    // What has left after that long, an epoch each period of the receiver.
    std::vector<StreamPiece> wait(Nanoseconds length) {
        StreamProtocols protocols;
        protocols.sbf = true;
        StreamSplitter splitter(protocols);
        std::vector<StreamPiece> pieces;
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += std::chrono::milliseconds(1);
            for (const Receiver::Sent& sent : receiver_.output(now_))
                for (StreamPiece& piece : splitter.feed(sent.bytes))
                    pieces.push_back(std::move(piece));
            if (now_.time_since_epoch() % receiver_.settings().navigation_period != Nanoseconds(0)) continue;
            fix_.time = now_;
            Epoch epoch{fix_};
            epoch.observations = observations_;
            if (!observations_.signals.empty()) epoch.observations.receive_time = now_;
            epoch.subframes = subframes_;
            receiver_.on_epoch(epoch);
        }
        for (StreamPiece& piece : splitter.finish())
            pieces.push_back(std::move(piece));
        return pieces;
    }
    void say(const std::string& line) { receiver_.input(PortId::uart1, to_bytes(line + "\n"), now_); }

    Receiver receiver_{septentrio_board(), ReceiverOptions{}};
    Fix fix_;
    Observations observations_;
    std::vector<Subframe> subframes_;
    GpsTime now_ = sample_fix("2024-03-05T12:00:00Z", 47, 8, 500).time;
};

}  // namespace skyloop::firmware
