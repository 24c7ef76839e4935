// UBX: any byte stream through the splitter and the messages; what decodes must return byte for byte.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "../support/ubx_message_types.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_cfg.hpp"
#include "receiver/protocol/ubx_mon.hpp"
#include "receiver/protocol/ubx_nav.hpp"
#include "receiver/protocol/ubx_satellites.hpp"

namespace {

template <class Message>
void check_return(skyloop::ByteSpan payload) {
    const auto message = skyloop::decode_payload<Message>(payload);
    if (!message) return;
    if (skyloop::encode_payload(*message) != skyloop::Bytes(payload.begin(), payload.end())) std::abort();
}

// Whatever the frame says that it is: every decoder must stand any payload.
void check_payload(skyloop::ByteSpan payload) {
    using namespace skyloop;
    check_return<NavPvt>(payload);
    check_return<NavCov>(payload);
    check_return<NavSat>(payload);
    check_return<NavSvinfo>(payload);
    check_return<RxmRawx>(payload);
    check_return<RxmSfrbx>(payload);
    check_return<MonVer>(payload);
    check_return<SecUniqid>(payload);
    check_return<InfNotice>(payload);
    check_return<CfgPrt>(payload);
    check_return<CfgGnss>(payload);
    check_return<CfgCfg>(payload);
    check_return<CfgValset>(payload);
    check_return<CfgValgetPoll>(payload);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    const ByteSpan stream(data, size);
    check_payload(stream);
    StreamSplitter splitter;
    auto pieces = splitter.feed(stream.first(size / 2));
    for (auto& piece : splitter.feed(stream.subspan(size / 2)))
        pieces.push_back(std::move(piece));
    for (auto& piece : splitter.finish())
        pieces.push_back(std::move(piece));
    Bytes joined;
    for (const StreamPiece& piece : pieces) {
        joined.insert(joined.end(), piece.bytes.begin(), piece.bytes.end());
        if (piece.kind != StreamKind::ubx) continue;
        const auto frame = parse_frame(piece.bytes);
        if (!frame || encode_frame(frame->id, frame->payload) != piece.bytes) std::abort();
        if (UbxOutputTypes::written_again(*frame).value_or(piece.bytes) != piece.bytes) std::abort();
        check_payload(frame->payload);
    }
    if (joined != Bytes(stream.begin(), stream.end())) std::abort();
    return 0;
}
