// RTCM 3: any bytes through the splitter, the readers and the firmware's book-keeping of corrections.
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "firmware/core/corrections.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"
#include "receiver/protocol/rtcm3_ephemeris.hpp"
#include "receiver/protocol/rtcm3_legacy.hpp"
#include "receiver/protocol/rtcm3_ublox.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "require.hpp"

namespace {

void read(skyloop::ByteSpan frame) {
    using namespace skyloop;
    const auto message = parse_rtcm3(frame);
    if (!message) return;
    require(message->number >= 0 && message->number <= 4095);
    // What we write we must be able to read, and it must be the same.
    if (const auto station = decode_station(*message)) {
        const Bytes again = encode(*station);
        require(decode_station(*parse_rtcm3(again)) == station);
    }
    if (const auto biases = decode_glonass_biases(*message)) {
        const Bytes again = encode(*biases);
        require(decode_glonass_biases(*parse_rtcm3(again)) == biases);
    }
    if (const auto header = decode_msm_header(*message)) {
        const Bytes again = encode(*header);
        require(decode_msm_header(*parse_rtcm3(again)) == header);
    }
    if (const auto descriptors = decode_descriptors(*message)) {
        const Bytes once = encode(*descriptors);  // which cuts long texts
        require(encode(*decode_descriptors(*parse_rtcm3(once))) == once);
    }
    if (const auto station = decode_moving_station(*message)) {
        const Bytes again = encode(*station);
        require(decode_moving_station(*parse_rtcm3(again)) == station);
    }
    if (const auto biases = decode_station_biases(*message)) {
        const Bytes again = encode(*biases);
        require(decode_station_biases(*parse_rtcm3(again)) == biases);
    }
    const GpsTime near = gps_calendar_time(2025, 4, 11, 23, 14, 30);
    if (const auto record = decode_ephemeris(*message, near)) {
        const Bytes once = encode_ephemeris(*record, near);
        const auto again = decode_ephemeris(*parse_rtcm3(once), near);
        require(again && encode_ephemeris(*again, near) == once);
    }
    if (const auto observables = decode_legacy(*message)) {
        const Bytes once = encode(*observables);
        if (!once.empty()) require(encode(*decode_legacy(*parse_rtcm3(once))) == once);
    }
}

void require_frames(const skyloop::firmware::CorrectionAnswer& answer) {
    using namespace skyloop;
    require(parse_frame(answer.rtcm).has_value());
    require(parse_frame(answer.cor).has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    firmware::CorrectionAbility ability;
    ability.rtk = true;
    firmware::CorrectionInput input(ability);
    GpsTime now = to_gps_time(2300, 0.0);
    StreamSplitter splitter;
    for (const StreamPiece& piece : splitter.feed({data, size})) {
        if (piece.kind != StreamKind::rtcm3) continue;
        read(piece.bytes);
        require_frames(input.take(piece.bytes, now));
        now += std::chrono::milliseconds(700);
        const auto status = input.status(now, firmware::CorrectionLimits{});
        require(status.state == CorrectionState::none || (status.age && status.station));
    }
    // The same bytes as the payload of one frame, so that a checksum does not stand in the way.
    const Bytes frame = encode_rtcm3({data, size});
    if (frame.empty()) return 0;
    read(frame);
    require_frames(input.take(frame, now));
    return 0;
}
