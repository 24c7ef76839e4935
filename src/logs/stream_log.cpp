#include <fmt/format.h>

#include "nmea_epochs.hpp"
#include "skyloop/protocol/stream_splitter.hpp"
#include "ubx_epochs.hpp"

namespace skyloop {

// Both kinds are read at once; the one that fits the other's gaps is not mixed in: UBX tells more.
Result<ReceiverLog> read_stream_log(ByteSpan bytes, const std::string& name, const LogReading& reading) {
    constexpr std::size_t chunk = 65536;
    StreamSplitter splitter;
    UbxEpochs ubx;
    NmeaEpochs nmea(reading);
    const auto take = [&](const std::vector<StreamPiece>& pieces) {
        for (const StreamPiece& piece : pieces) {
            if (piece.kind == StreamKind::ubx)
                if (const auto frame = parse_frame(piece.bytes)) ubx.take(*frame);
            if (piece.kind == StreamKind::nmea) {
                const std::string sentence = to_string(piece.bytes);
                nmea.take(std::string_view(sentence).substr(0, sentence.find('*') + 3));
            }
        }
    };
    for (std::size_t at = 0; at < bytes.size(); at += chunk)
        take(splitter.feed(bytes.subspan(at, std::min(chunk, bytes.size() - at))));
    take(splitter.finish());
    const StreamCounts& counts = splitter.counts();
    if (!ubx.has_solutions() && nmea.fixes() == 0)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} UBX messages and {} NMEA sentences in {} bytes, none of them with a solution; "
                                "expected a UBX, NMEA, ULog or DataFlash log of a receiver",
                                name, counts.frames[static_cast<std::size_t>(StreamKind::ubx)],
                                counts.frames[static_cast<std::size_t>(StreamKind::nmea)], counts.bytes));
    if (reading.receiver != 0)
        return fail(ErrorCode::usage, fmt::format("{}: a stream of one receiver; --gps {} is not in it, expected 0",
                                                  name, reading.receiver));
    Result<ReceiverLog> log = ubx.has_solutions() ? Result<ReceiverLog>(ubx.finish()) : nmea.finish(name);
    if (!log) return log;
    log->name = name;
    if (!ubx.has_solutions())
        if (const ReceiverLog told = ubx.finish(); !told.board.empty())
            log->receiver = told.receiver, log->board = told.board;
    const std::uint64_t bad =
        counts.bad[static_cast<std::size_t>(StreamKind::ubx)] + counts.bad[static_cast<std::size_t>(StreamKind::nmea)];
    add_note(*log, bad, "messages or sentences with a wrong checksum were left out");
    return finish_log(std::move(*log), reading);
}

}  // namespace skyloop
