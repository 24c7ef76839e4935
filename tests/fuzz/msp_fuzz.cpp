// MSP: any bytes as a frame and as payloads; what is read must return byte for byte.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "receiver/protocol/msp.hpp"

namespace {

template <class Message>
void check_msp_return(skyloop::ByteSpan payload) {
    const auto message = skyloop::decode_payload<Message>(payload);
    if (message && skyloop::encode_payload(*message) != skyloop::Bytes(payload.begin(), payload.end())) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan bytes(data, size);
    check_msp_return<MspSensorGps>(bytes);
    check_msp_return<MspSetRawGps>(bytes);
    if (const auto frame = parse_msp(bytes); frame && frame->direction == '<') {
        Bytes again = frame->version == 1 ? encode_msp_v1(frame->function, frame->payload)
                                          : encode_msp_v2(frame->function, frame->payload);
        // The flags of version 2 are not kept.
        if (frame->version == 1 && again != Bytes(bytes.begin(), bytes.end())) std::abort();
        if (again.size() != bytes.size()) std::abort();
    }
    if (const auto parsed = parse_msp(encode_msp_v2(0x1F03, bytes)); size <= 0xFFFF && !parsed) std::abort();
    return 0;
}
