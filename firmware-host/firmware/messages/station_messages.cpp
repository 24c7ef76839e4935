#include "firmware/messages/station_messages.hpp"

#include "firmware/core/port_id.hpp"
#include "receiver/protocol/rtcm3.hpp"
#include "receiver/protocol/rtcm3_descriptors.hpp"

namespace skyloop::firmware {

// 1006 is 1005 and the height of the antenna above the marker, which is 0 here; 1033 says who sends.
std::vector<Bytes> make_station_message(UbxMessageId message, EpochMessages& made, PortId port,
                                        std::span<const UbxMessageId> following) {
    constexpr std::uint8_t id_1005 = 5, id_1006 = 6, id_1033 = 33;
    if (message.id == id_1006) {
        std::vector<Bytes> frames = made.of({class_rtcm, id_1005}, port, following);
        for (Bytes& frame : frames) {
            auto station = decode_station(*parse_rtcm3(frame));
            station->antenna_height = 0;
            frame = encode(*station);
        }
        return frames;
    }
    if (message.id != id_1033) return made.of(message, port, following);
    const ReportContext context = made.context(port);
    Rtcm3Descriptors told;
    told.number = 1033;
    told.station = context.config.station;
    told.receiver = context.board.identity.hardware;
    told.firmware = context.board.identity.software;
    return {encode(told)};
}

}  // namespace skyloop::firmware
