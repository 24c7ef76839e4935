// Unicore's frames: what is read is written again as it was, and pieces of a stream do not depend on how it arrives.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "../support/split_stream.hpp"
#include "receiver/protocol/decoded_message.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/unicore_frame.hpp"
#include "receiver/protocol/unicore_logs.hpp"
#include "require.hpp"

namespace {

using namespace skyloop;

template <class Message>
bool reads_its_own_text(std::span<const std::string_view> fields) {
    const auto read = read_unicore_body<Message>(fields);
    if (!read) return false;
    const std::string once = unicore_body(*read);
    const std::string line = unicore_log_line(Message::message_name, {}, once);
    const auto again = parse_unicore_line(line);
    require(again.has_value());
    const auto second = read_unicore_body<Message>(again->fields);
    // A text with a quotation mark or a star in it is no longer what it was.
    if (second) require(unicore_body(*second) == once || once.find('"') != std::string::npos);
    return false;
}

template <class Message>
bool reads_its_own_bytes(ByteSpan payload) {
    if constexpr (UnicoreBinaryLog<Message>)
        if (const auto read = decode_payload<Message>(payload)) static_cast<void>(unicore_body(*read));
    return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const ByteSpan bytes(data, size);
    const std::string text(reinterpret_cast<const char*>(data), size);
    // The check of a mutated log is seldom right: its fields count.
    std::vector<std::string_view> fields;
    for (std::string_view left = text; !left.empty();) {
        const std::size_t end = std::min(left.find(','), left.size());
        fields.push_back(left.substr(0, end));
        left.remove_prefix(std::min(end + 1, left.size()));
    }
    KnownUnicoreLogs::any([&]<class Message>() { return reads_its_own_text<Message>(fields); });
    KnownUnicoreLogs::any([&]<class Message>() { return reads_its_own_bytes<Message>(bytes); });
    const std::vector<StreamPiece> pieces =
        test::split_stream({.unicore = true}, bytes, std::max<std::size_t>(size, 1));
    require(pieces == test::split_stream({.unicore = true}, bytes, 3));
    for (const StreamPiece& piece : pieces)
        static_cast<void>(text_line(decode_piece(piece)));
    return 0;
}
