#include <fmt/format.h>

#include <algorithm>

#include "detail/nmea_epochs.hpp"
#include "detail/ubx_epochs.hpp"
#include "receiver/protocol/stream_splitter.hpp"

namespace skyloop {

namespace {

std::size_t places_in(const ReceiverLog& log) {
    return static_cast<std::size_t>(std::count_if(
        log.epochs.begin(), log.epochs.end(), [](const LogEpoch& epoch) { return epoch.place && !epoch.is_lost(); }));
}

// UBX, which tells more, unless a few polled messages stand in a log of NMEA, or NMEA alone tells a date. It is told.
Result<ReceiverLog> log_of_more(UbxEpochs& ubx, NmeaEpochs& nmea, const std::string& name) {
    constexpr std::size_t many_more = 2;
    const bool solves = ubx.has_solutions();
    ReceiverLog of_ubx = ubx.finish();
    if (solves && nmea.fixes() == 0) return of_ubx;
    Result<ReceiverLog> of_nmea = nmea.finish(name);
    if (!solves) {
        if (of_nmea && !of_ubx.board.empty()) of_nmea->receiver = of_ubx.receiver, of_nmea->board = of_ubx.board;
        return of_nmea;
    }
    if (!of_nmea) return of_ubx;
    const std::size_t ubx_places = places_in(of_ubx), nmea_places = places_in(*of_nmea);
    const bool dates_it = of_nmea->dated && !of_ubx.dated && nmea_places > 0;
    const bool take_nmea = dates_it || nmea_places > many_more * ubx_places;
    ReceiverLog& taken = take_nmea ? *of_nmea : of_ubx;
    if (take_nmea && !of_ubx.board.empty()) taken.receiver = of_ubx.receiver, taken.board = of_ubx.board;
    if (take_nmea || nmea_places > ubx_places)
        taken.notes.push_back(fmt::format("{} epochs of NMEA and {} of UBX have a place; those of {} are taken",
                                          nmea_places, ubx_places, taken.format));
    return std::move(taken);
}

}  // namespace

// Both kinds are read at once; the one that fits the other's gaps is not mixed in.
Result<ReceiverLog> read_stream_log(ByteSpan bytes, const std::string& name, const LogReading& reading) {
    constexpr std::size_t chunk = 65536;
    StreamSplitter splitter;
    UbxEpochs ubx(reading);
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
    Result<ReceiverLog> log = log_of_more(ubx, nmea, name);
    if (!log) return log;
    log->name = name;
    const std::uint64_t bad =
        counts.bad[static_cast<std::size_t>(StreamKind::ubx)] + counts.bad[static_cast<std::size_t>(StreamKind::nmea)];
    add_note(*log, bad, "messages or sentences with a wrong checksum were left out");
    return finish_log(std::move(*log), reading);
}

}  // namespace skyloop
