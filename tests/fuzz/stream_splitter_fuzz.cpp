// Any byte stream, cut in two anywhere: the pieces are the stream, and the same as those of the stream in one; every
// piece can be listed, and SBF blocks that are read are written as they were read.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>
#include <vector>

#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/known_sbf.hpp"

namespace {

std::vector<skyloop::StreamPiece> pieces_of(skyloop::ByteSpan stream, std::size_t cut) {
    skyloop::StreamSplitter splitter({true, true, true, true, true, true});
    auto pieces = splitter.feed(stream.first(cut));
    for (auto& piece : splitter.feed(stream.subspan(cut)))
        pieces.push_back(std::move(piece));
    for (auto& piece : splitter.finish())
        pieces.push_back(std::move(piece));
    if (splitter.counts().bytes != stream.size()) std::abort();
    return pieces;
}

void write_again(const skyloop::StreamPiece& piece) {
    const auto block = skyloop::parse_sbf(piece.bytes);
    if (!block) return;
    skyloop::KnownSbfBlocks::any([&]<class Message>() {
        if (block->number != Message::block_number) return false;
        const auto read = skyloop::decode_sbf<Message>(block->body);
        if (!read) return true;
        const skyloop::Bytes written = skyloop::encode_payload(*read);
        const auto again = skyloop::decode_sbf<Message>(written);
        if (!again || skyloop::encode_payload(*again) != written) std::abort();
        return true;
    });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const skyloop::ByteSpan stream(data, size);
    const auto pieces = pieces_of(stream, size);
    if (pieces_of(stream, size / 2) != pieces) std::abort();
    skyloop::Bytes joined;
    for (const skyloop::StreamPiece& piece : pieces) {
        joined.insert(joined.end(), piece.bytes.begin(), piece.bytes.end());
        if (piece.kind == skyloop::StreamKind::sbf) write_again(piece);
        const skyloop::DecodedMessage message = skyloop::decode_piece(piece);
        if (skyloop::json_line(message, 0).empty() || skyloop::text_line(message).empty()) std::abort();
    }
    if (joined != skyloop::Bytes(stream.begin(), stream.end())) std::abort();
    return 0;
}
