// MAVLink: any bytes as a frame and as payloads of every length; what is written must be read again.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "receiver/protocol/mavlink_vehicle.hpp"

namespace {

template <class Message>
void check_mavlink_return(skyloop::ByteSpan payload) {
    const auto message = skyloop::decode_mavlink<Message>(payload);
    const skyloop::Bytes frame = skyloop::encode_mavlink({}, message);
    const auto view = skyloop::parse_mavlink(frame);
    if (!view) std::abort();
    const auto again = skyloop::decode_mavlink<Message>(view->payload);
    if (skyloop::encode_payload(again) != skyloop::encode_payload(message)) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan bytes(data, size);
    check_mavlink_return<MavlinkHeartbeat>(bytes);
    check_mavlink_return<MavlinkGpsInput>(bytes);
    check_mavlink_return<MavlinkGpsRawInt>(bytes);
    check_mavlink_return<MavlinkGpsRtcmData>(bytes);
    check_mavlink_return<MavlinkCommandLong>(bytes);
    check_mavlink_return<MavlinkCommandInt>(bytes);
    check_mavlink_return<MavlinkCommandAck>(bytes);
    check_mavlink_return<MavlinkSystemTime>(bytes);
    check_mavlink_return<MavlinkAttitude>(bytes);
    check_mavlink_return<MavlinkAttitudeQuaternion>(bytes);
    check_mavlink_return<MavlinkLocalPositionNed>(bytes);
    check_mavlink_return<MavlinkGlobalPositionInt>(bytes);
    check_mavlink_return<MavlinkGpsGlobalOrigin>(bytes);
    check_mavlink_return<MavlinkSimState>(bytes);
    check_mavlink_return<MavlinkHilGps>(bytes);
    check_mavlink_return<MavlinkHilStateQuaternion>(bytes);
    check_mavlink_return<MavlinkOdometry>(bytes);
    if (const auto frame = parse_mavlink(bytes); frame && frame->payload.size() > 0xFF) std::abort();
    std::size_t found = 0;
    for (const MavlinkFrameView& frame : mavlink_frames(bytes)) {
        found += mavlink_crc_size + frame.payload.size();
        check_mavlink_return<MavlinkHeartbeat>(frame.payload);
    }
    if (found > size) std::abort();
    return 0;
}
