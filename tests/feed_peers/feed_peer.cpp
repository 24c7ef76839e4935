// The project's end of the tests with other programs' words.
//   feed_peer write OUT       MAVLink frames of ours, of both versions
//   feed_peer again IN OUT    the MAVLink frames of IN, decoded and encoded again
//   feed_peer truth IN        what the dialect reads from each MAVLink frame of IN, a JSON object a line
//   feed_peer say DIALECT OUT what a dialect says at first
//   feed_peer hear DIALECT IN [LATITUDE LONGITUDE HEIGHT]
//                             what it reads from the pieces of IN, each after its arrival (ns, 8 bytes) and size (4);
//                             degrees and metres above the ellipsoid of its origin
#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include "base/geo/simulator_frames.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/mavlink_vehicle.hpp"
#include "run/feed/feed_dialect.hpp"

namespace skyloop {
namespace {

Bytes read_file(const char* name) {
    std::ifstream file(name, std::ios::binary);
    if (!file) throw std::runtime_error(std::string("cannot read ") + name);
    return Bytes(std::istreambuf_iterator<char>(file), {});
}

void write_file(const char* name, const Bytes& bytes) {
    std::ofstream file(name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

void append_frame(Bytes& bytes, const Bytes& frame) {
    if (frame.empty()) throw std::runtime_error("a message without a frame");
    bytes.insert(bytes.end(), frame.begin(), frame.end());
}

// Version 1 has no extensions.
template <class Message>
Bytes frame_of(int version, MavlinkSource source, const Message& message) {
    if (version == 2) return encode_mavlink(source, message);
    return encode_mavlink_v1(source, Message::message_id, ByteSpan(encode_payload(message)).first(Message::base_size));
}

template <class Message>
void append_both(Bytes& bytes, const Message& message) {
    for (const int version : {1, 2})
        if (version == 2 || Message::message_id <= 255) append_frame(bytes, frame_of(version, {3, 220, 9}, message));
}

// The same numbers stand in mavlink_test.mjs.
Bytes own_frames() {
    Bytes bytes;
    append_both(bytes, MavlinkGpsInput{1700000000123456, 477314000, 473977421, 85455943, 488.25F, 0.75F, 1.25F, 3.5F,
                                       -4.25F, -2.125F, 0.25F, 1.5F, 2.5F, 0x88, 2445, 1, 3, 17, 5313});
    append_both(bytes, MavlinkGpsRawInt{1700000000123456, 473977421, 85455943, 488123, 75, 125, 551, 30950, 3, 17,
                                        535456, 1500, 2500, 250, 123456, 5313});
    append_both(bytes, MavlinkHilGps{1700000000123456, 473977421, 85455943, 488123, 75, 125, 551, 350, -425, -212,
                                     30950, 3, 17, 1, 5313});
    append_both(bytes, MavlinkHeartbeat{77, 18, 8, 81, 4, 3});
    append_both(bytes, MavlinkCommandLong{115, 20000, 3, 4, 5, 6, 7, 511, 1, 2, 1});
    append_both(bytes, MavlinkHilStateQuaternion{12345678,
                                                 {0.5F, -0.5F, 0.25F, 0.75F},
                                                 0.125F,
                                                 -0.25F,
                                                 0.5F,
                                                 473977421,
                                                 85455943,
                                                 488123,
                                                 350,
                                                 -425,
                                                 -212,
                                                 551,
                                                 552,
                                                 10,
                                                 -20,
                                                 -998});
    append_both(bytes, MavlinkGlobalPositionInt{12345, 473977421, 85455943, 488123, 10123, 350, -425, -212, 5313});
    append_both(bytes, MavlinkLocalPositionNed{12345, 1.5F, -2.5F, -3.5F, 4.5F, -5.5F, 6.5F});
    append_both(bytes, MavlinkAttitude{12345, 0.25F, -0.5F, 0.75F, 0.125F, -0.25F, 0.5F});
    append_both(bytes, MavlinkGpsGlobalOrigin{473977421, 85455943, 488123, 12345678});
    append_both(bytes, MavlinkSystemTime{1700000000123456, 12345});
    return bytes;
}

template <class... Message>
bool append_again(Bytes& bytes, const MavlinkFrameView& frame) {
    const auto one = [&]<class M>(M) {
        if (M::message_id != frame.message) return false;
        append_frame(bytes, frame_of(frame.version, frame.source, decode_mavlink<M>(frame.payload)));
        return true;
    };
    return (one(Message{}) || ...);
}

Bytes frames_again(const Bytes& bytes) {
    Bytes again;
    for (const MavlinkFrameView& frame : mavlink_frames(bytes))
        if (!append_again<MavlinkHilStateQuaternion, MavlinkSimState, MavlinkGlobalPositionInt, MavlinkAttitude,
                          MavlinkAttitudeQuaternion, MavlinkLocalPositionNed, MavlinkGpsGlobalOrigin, MavlinkOdometry,
                          MavlinkGpsInput, MavlinkHilGps, MavlinkGpsRawInt, MavlinkHeartbeat, MavlinkSystemTime>(again,
                                                                                                                 frame))
            throw std::runtime_error(fmt::format("message {} is not known", frame.message));
    return again;
}

std::string sample_line(const TruthSample& sample) {
    const Geodetic place = to_geodetic(sample.position);
    const Eigen::Vector3d velocity = sample.velocity ? sample.velocity->vector() : Eigen::Vector3d::Zero();
    const Eigen::Vector3d ned = ned_to_ecef(place).conjugate() * velocity;
    const Attitude attitude = sample.attitude.value_or(Attitude());
    return fmt::format(
        "{{\"vehicle\":\"{}\",\"time\":{},\"place\":[{:.9f},{:.9f},{:.4f}],\"ned\":[{:.5f},{:.5f},{:.5f}],"
        "\"angles\":[{:.5f},{:.5f},{:.5f}]}}",
        sample.vehicle, sample.source_time ? fmt::format("{}", sample.source_time->count()) : "null",
        place.latitude.deg(), place.longitude.deg(), place.height.above_ellipsoid.value(), ned.x(), ned.y(), ned.z(),
        attitude.roll().deg(), attitude.pitch().deg(), attitude.yaw().deg());
}

void print_truth(const Bytes& bytes) {
    // Half a minute between frames: every kind of message counts in its turn.
    constexpr std::int64_t pause_ns = 30'000'000'000;
    const auto dialect = make_dialect("mavlink", {});
    std::int64_t now = 0;
    for (ByteSpan left(bytes); !left.empty();) {
        const auto size = mavlink_frame_size(left);
        if (!size || *size > left.size()) throw std::runtime_error("bytes that are no frame");
        const FeedNews news = dialect->hear(left.first(*size), now += pause_ns);
        if (news.refused > 0) throw std::runtime_error(news.refusal);
        for (const TruthSample& sample : news.samples)
            fmt::print("{}\n", sample_line(sample));
        left = left.subspan(*size);
    }
}

void write_words(const std::string& name, const char* file) {
    Bytes words;
    for (const Bytes& word : make_dialect(name, {})->say())
        words.insert(words.end(), word.begin(), word.end());
    write_file(file, words);
}

struct HeardPiece {
    std::int64_t received_ns = 0;
    std::uint32_t size = 0;
    template <class M, class V>
    static void fields(M& m, V& v) {
        v(m.received_ns, m.size);
    }
};

void print_heard(const std::string& name, const FeedContext& context, const Bytes& bytes) {
    constexpr std::size_t head_size = 12;
    const auto dialect = make_dialect(name, context);
    for (ByteSpan left(bytes); !left.empty();) {
        const auto piece = decode_front<HeardPiece>(left);
        if (!piece || left.size() - head_size < piece->size) throw std::runtime_error("pieces that are cut");
        const FeedNews news = dialect->hear(left.subspan(head_size, piece->size), piece->received_ns);
        if (news.refused > 0) fmt::print("{{\"refused\":{},\"why\":{}}}\n", news.refused, json_string(news.refusal));
        for (const TruthSample& sample : news.samples)
            fmt::print("{}\n", sample_line(sample));
        left = left.subspan(head_size + piece->size);
    }
}

void run_command(int count, char** words) {
    const std::string what = count > 1 ? words[1] : "";
    if (what == "write" && count == 3) return write_file(words[2], own_frames());
    if (what == "again" && count == 4) return write_file(words[3], frames_again(read_file(words[2])));
    if (what == "truth" && count == 3) return print_truth(read_file(words[2]));
    if (what == "say" && count == 4) return write_words(words[2], words[3]);
    FeedContext context;
    if (what == "hear" && count == 7)
        context.origin = Geodetic::degrees(std::stod(words[4]), std::stod(words[5]), std::stod(words[6]));
    if (what == "hear" && (count == 4 || count == 7)) return print_heard(words[2], context, read_file(words[3]));
    throw std::runtime_error("expected write OUT, again IN OUT, truth IN, say DIALECT OUT or hear DIALECT IN");
}

}  // namespace
}  // namespace skyloop

int main(int count, char** words) {
    try {
        skyloop::run_command(count, words);
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "feed_peer: {}\n", error.what());
        return 1;
    }
}
