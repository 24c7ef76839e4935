/// A receiver with one client at UART1, whose pieces it answers with pieces.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

#include "firmware/core/receiver.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "support/receiver_rig.hpp"

namespace skyloop::firmware {

class DialogueReceiver {
public:
    explicit DialogueReceiver(const BoardProfile& board, const ReceiverOptions& options = {})
        : receiver_(board, options), board_(board) {
        receiver_.start(now_);
    }
    explicit DialogueReceiver(const std::string& board) : DialogueReceiver(test::board_named(board)) {}

    // Runs for so long, an epoch each period of the receiver.
    void wait(Nanoseconds length) {
        for (const GpsTime end = now_ + length; now_ < end;) {
            now_ += std::chrono::milliseconds(1);
            for (const Receiver::Sent& sent : receiver_.output(now_)) {
                if (sent.port != PortId::uart1) continue;
                for (StreamPiece& piece : splitter_.feed(sent.bytes))
                    pieces_.push_back(std::move(piece));
            }
            if (now_.time_since_epoch() % receiver_.settings().navigation_period != Nanoseconds(0)) continue;
            Epoch epoch = epoch_;
            epoch.fix.time = now_;
            receiver_.on_epoch(epoch);
        }
    }
    void write(const Bytes& bytes) { receiver_.input(PortId::uart1, bytes, now_); }
    // A sentence's body, without the dollar and the checksum.
    void say(const std::string& body) { write(to_bytes(Sentence(body).finish())); }
    // Lines that begin so and come within the time of a sentence.
    std::vector<std::string> answers(const std::string& body, const std::string& begin,
                                     Nanoseconds length = std::chrono::milliseconds(400)) {
        forget();
        say(body);
        wait(length);
        return lines(begin);
    }
    [[nodiscard]] std::vector<std::string> lines(const std::string& begin = "$") const {
        std::vector<std::string> found;
        for (const StreamPiece& piece : pieces_) {
            const std::string text = to_string(piece.bytes);
            if (text.starts_with(begin) && piece.kind != StreamKind::casic)
                found.push_back(text.substr(0, text.find_last_not_of("\r\n") + 1));
        }
        return found;
    }
    [[nodiscard]] std::vector<Bytes> frames(StreamKind kind) const {
        std::vector<Bytes> found;
        for (const StreamPiece& piece : pieces_)
            if (piece.kind == kind) found.push_back(piece.bytes);
        return found;
    }
    void forget() { pieces_.clear(); }

    Receiver& receiver() { return receiver_; }
    [[nodiscard]] const BoardProfile& board() const { return board_; }
    [[nodiscard]] GpsTime now() const { return now_; }
    Epoch epoch_{test::driving_fix({})};

private:
    Receiver receiver_;
    BoardProfile board_;
    GpsTime now_ = to_gps_time(*parse_utc("2024-03-05T12:00:00Z"), LeapSeconds::announced());
    StreamSplitter splitter_{{.casic = true}};
    std::vector<StreamPiece> pieces_;
};

}  // namespace skyloop::firmware
