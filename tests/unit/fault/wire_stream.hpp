/// Streams of messages for tests of wires.
#pragma once

#include <string>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"

namespace skyloop::test {

inline constexpr GpsTime wire_start{std::chrono::seconds(1'400'000'000)};

inline GpsTime wire_time(double seconds) { return advanced(wire_start, Seconds(seconds)); }

/// Message `number` of a stream, a sentence and a UBX frame in turn; all differ.
inline Bytes wire_message(int number) {
    if (number % 2 == 0) {
        Sentence sentence("GNGGA");
        sentence.number(number, 6).decimal(48.1 + number, 3).letter('N').number(8);
        return to_bytes(sentence.finish());
    }
    Bytes payload(28);
    for (std::size_t i = 0; i < payload.size(); ++i)
        payload[i] = static_cast<std::uint8_t>(static_cast<std::size_t>(number) * 7 + i * 13);
    payload[0] = static_cast<std::uint8_t>(number);
    payload[1] = static_cast<std::uint8_t>(number >> 8);
    return encode_frame({0x01, 0x07}, payload);
}

inline void append_bytes(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

inline Bytes wire_messages(int count) {
    Bytes stream;
    for (int i = 0; i < count; ++i)
        append_bytes(stream, wire_message(i));
    return stream;
}

/// What a client makes of a stream: its whole messages, and those with wrong checksums.
struct HeardStream {
    std::vector<Bytes> messages;
    StreamCounts counts;
};

inline HeardStream heard_stream(ByteSpan stream) {
    HeardStream heard;
    StreamSplitter splitter;
    const auto keep = [&](const std::vector<StreamPiece>& pieces) {
        for (const StreamPiece& piece : pieces)
            if (piece.kind != StreamKind::noise) heard.messages.push_back(piece.bytes);
    };
    keep(splitter.feed(stream));
    keep(splitter.finish());
    heard.counts = splitter.counts();
    return heard;
}

}  // namespace skyloop::test
