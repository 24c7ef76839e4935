#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <utility>

#include "detail/observed_parts.hpp"
#include "receiver/observed/nmea_epochs.hpp"
#include "receiver/observed/sbf_epochs.hpp"
#include "receiver/observed/ubx_epochs.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/stream_splitter.hpp"
#include "receiver/protocol/ubx_mon.hpp"

namespace skyloop::inline receiver {
namespace {

template <std::size_t N>
std::string text_of(const std::array<char, N>& characters) {
    return {characters.begin(), std::find(characters.begin(), characters.end(), '\0')};
}

// The profile whose chip, and module where that is told, MON-VER names (boards/receivers, [identity]).
std::string board_of_version(const std::string& hardware, const std::string& texts) {
    if (texts.find("MOD=ZED-F9") != std::string::npos) return "ublox-f9p";
    if (texts.find("MOD=NEO-M9") != std::string::npos) return "ublox-m9";
    if (hardware == "000A0000") return texts.find("SPGL1L5") != std::string::npos ? "ublox-f10" : "ublox-m10";
    if (hardware == "00190000") return texts.find("HPG") != std::string::npos ? "ublox-f9p" : "ublox-m9";
    if (hardware == "00080000") return "ublox-m8";
    if (hardware == "00040007" || hardware == "00070000") return "ublox-6";
    return {};
}

// The address of the sentence "$ttfff," that begins the text; empty where none does.
std::string_view address_of(std::string_view text) {
    constexpr std::size_t length = 5;
    if (text.size() <= length + 1 || text[length + 1] != ',') return {};
    const std::string_view address = text.substr(1, length);
    const bool plain = std::all_of(address.begin(), address.end(),
                                   [](char c) { return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9'); });
    return plain && address[0] != 'P' ? address : std::string_view();
}

bool ends_in_any(std::string_view address, std::initializer_list<std::string_view> kinds) {
    return std::any_of(kinds.begin(), kinds.end(), [&](std::string_view kind) { return address.ends_with(kind); });
}

std::size_t places_in(const ObservedLog& log) {
    return static_cast<std::size_t>(std::count_if(log.epochs.begin(), log.epochs.end(), [](const ObservedEpoch& epoch) {
        return epoch.place && !epoch.is_lost();
    }));
}

// What one binary protocol tells. Signals told beside an epoch without a solution are of the next one that has one.
struct BinaryEpochs {
    ObservedLog log;
    std::vector<ObservedSignal> apart;

    void add(std::optional<ObservedEpoch> epoch) {
        if (!epoch) return;
        if (epoch->is_solution) {
            log.epochs.push_back(std::move(*epoch));
            if (!log.epochs.back().lists_satellites) share_apart();
            apart.clear();
        } else {
            for (const ObservedSignal& signal : epoch->signals)
                add_signal(apart, signal);
        }
    }
    void share_apart() {
        if (apart.empty() || log.epochs.empty()) return;
        log.epochs.back().lists_satellites = true;
        for (const ObservedSignal& signal : std::exchange(apart, {}))
            add_signal(log.epochs.back().signals, signal);
    }
};

class StreamReader {
public:
    StreamReader(const std::string& name, const ObservedReading& reading)
        : name_(name),
          reading_(reading),
          ubx_(reading.use == ObservedUse::fixes),
          sbf_(reading.use == ObservedUse::fixes),
          nmea_(reading.use == ObservedUse::fixes) {}
    Result<ObservedLog> read(ByteSpan bytes);

private:
    void take(const StreamPiece& piece);
    void take_ubx(ByteSpan bytes);
    void take_sbf(ByteSpan bytes);
    void take_version(const UbxFrameView& frame);
    void take_sentence(std::string_view sentence);
    void take_stray(ByteSpan bytes);
    void end_stray_line(bool ended);
    void count_stray(std::string_view sentence, bool ended);
    ObservedLog finish_ubx();
    ObservedLog finish_sbf();
    void note_time_only(ObservedLog& log) const;
    Result<ObservedLog> finish_nmea();
    void place(ObservedEpoch& epoch);
    Result<ObservedLog> log_of_more();
    [[nodiscard]] std::vector<std::string> damage_notes() const;
    [[nodiscard]] tl::unexpected<Error> no_solution() const;

    const std::string& name_;
    const ObservedReading& reading_;
    StreamSplitter splitter_{StreamProtocols{.sbf = true}};
    UbxEpochs ubx_;
    SbfEpochs sbf_;
    NmeaEpochs nmea_;
    BinaryEpochs of_ubx_, of_sbf_;
    std::vector<NmeaEpoch> of_nmea_;
    std::string stray_;        // a line in no piece
    std::uint8_t before_ = 0;  // the last byte in none
    std::size_t line_ = 1, senseless_ = 0, senseless_blocks_ = 0, senseless_sentences_ = 0;
    std::size_t damaged_messages_ = 0, damaged_ = 0, damaged_of_satellites_ = 0, unchecked_ = 0;
    std::size_t without_separation_ = 0, without_altitude_ = 0;
    bool separated_ = false;       // some sentence tells how high the geoid lies
    std::string first_senseless_;  // and where it stands
};

void StreamReader::take(const StreamPiece& piece) {
    if (piece.kind == StreamKind::noise) return take_stray(piece.bytes);
    end_stray_line(false);
    before_ = 0;
    if (piece.kind == StreamKind::ubx) take_ubx(piece.bytes);
    if (piece.kind == StreamKind::sbf) take_sbf(piece.bytes);
    if (piece.kind == StreamKind::nmea) take_sentence(to_string(piece.bytes));
    line_ += static_cast<std::size_t>(std::count(piece.bytes.begin(), piece.bytes.end(), '\n'));
}

void StreamReader::take_ubx(ByteSpan bytes) {
    const auto frame = parse_frame(bytes);
    if (!frame) return;
    UbxEpochs::Taken taken = ubx_.take(*frame);
    if (taken.is_senseless) ++senseless_;
    of_ubx_.add(std::move(taken.ended));
    take_version(*frame);
}

void StreamReader::take_sbf(ByteSpan bytes) {
    const auto block = parse_sbf(bytes);
    if (!block) return;
    SbfEpochs::Taken taken = sbf_.take(*block);
    if (taken.is_senseless) ++senseless_blocks_;
    of_sbf_.add(std::move(taken.ended));
}

void StreamReader::take_version(const UbxFrameView& frame) {
    if (frame.id != MonVer::message_id || !of_ubx_.log.receiver.empty()) return;
    const auto version = decode_payload<MonVer>(frame.payload);
    if (!version) return;
    std::string texts = text_of(version->sw_version);
    for (const auto& extension : version->extensions)
        texts += ", " + text_of(extension);
    of_ubx_.log.receiver = "MON-VER " + text_of(version->hw_version) + ", " + texts;
    of_ubx_.log.board = board_of_version(text_of(version->hw_version), texts);
}

void StreamReader::take_sentence(std::string_view sentence) {
    NmeaEpochs::Taken taken = nmea_.take(sentence.substr(0, sentence.find('*') + 3));
    if (taken.mistake && senseless_sentences_++ == 0)
        first_senseless_ = fmt::format("line {}: {}", line_, taken.mistake->message);
    if (taken.ended) of_nmea_.push_back(std::move(*taken.ended));
}

// Loggers end lines in CR and CR CR LF, too, write something of their own behind a checksum, or stop after it.
void StreamReader::take_stray(ByteSpan bytes) {
    constexpr std::size_t longest = 1024;
    for (const std::uint8_t byte : bytes) {
        const bool ends = byte == '\n' || byte == '\r';
        if (std::exchange(before_, byte) == ubx_sync_1 && byte == ubx_sync_2) ++damaged_messages_;
        if (ends || stray_.size() >= longest) end_stray_line(ends);
        if (byte == '\n') ++line_;
        if (!ends) stray_ += static_cast<char>(byte);
    }
}

void StreamReader::end_stray_line(bool ended) {
    const std::string line = std::exchange(stray_, {});
    for (std::size_t at = line.find('$'); at != std::string::npos;) {
        const std::size_t next = line.find('$', at + 1);
        count_stray(std::string_view(line).substr(at, next - at), ended && next == std::string::npos);
        at = next;
    }
}

void StreamReader::count_stray(std::string_view sentence, bool ended) {
    const std::size_t star = sentence.find('*');
    const std::string_view checked = sentence.substr(0, star == std::string_view::npos ? 0 : star + 3);
    if (parse_sentence(checked)) return take_sentence(checked);
    const std::string_view address = address_of(sentence);
    const bool of_satellites = ends_in_any(address, {"GSV", "GSA"});
    if (!of_satellites && !ends_in_any(address, {"GGA", "GNS", "RMC"})) return;
    const bool plain = std::all_of(sentence.begin(), sentence.end(), [](char c) { return c >= ' ' && c <= '~'; });
    ++(of_satellites                                      ? damaged_of_satellites_
       : star == std::string_view::npos && ended && plain ? unchecked_
                                                          : damaged_);
}

ObservedLog StreamReader::finish_ubx() {
    of_ubx_.share_apart();
    ObservedLog log = std::move(of_ubx_.log);
    log.format = "UBX";
    log.dated = date_by_weeks(log.epochs);
    const auto weekless = [](const ObservedEpoch& epoch) { return !epoch.dated; };
    if (reading_.use == ObservedUse::events || (log.dated && reading_.use == ObservedUse::track))
        add_note(log, std::erase_if(log.epochs, weekless), "epochs before the receiver knew the week were left out");
    add_note(log, senseless_, "UBX messages of a wrong length or time of week were left out");
    note_time_only(log);
    if (reading_.use == ObservedUse::fixes)
        add_note(log, ubx_.untyped(),
                 "positions without a message that tells whether they are fixes were taken as fixes");
    return log;
}

ObservedLog StreamReader::finish_sbf() {
    of_sbf_.share_apart();
    ObservedLog log = std::move(of_sbf_.log);
    log.format = "SBF";
    log.board = "septentrio-sbf";
    const auto untimed = [](const ObservedEpoch& epoch) { return !epoch.timed; };
    if (reading_.use != ObservedUse::fixes)
        add_note(log, std::erase_if(log.epochs, untimed), "epochs before the receiver knew the time were left out");
    add_note(log, senseless_blocks_, "SBF blocks of a wrong length or time were left out");
    note_time_only(log);
    return log;
}

void StreamReader::note_time_only(ObservedLog& log) const {
    const auto time_only = std::count_if(log.epochs.begin(), log.epochs.end(),
                                         [](const ObservedEpoch& epoch) { return epoch.type == FixType::time_only; });
    if (reading_.use == ObservedUse::fixes)
        add_note(log, static_cast<std::size_t>(time_only),
                 "epochs with a time-only fix are not counted as fixes: the receiver was told its position");
}

// Altitude and the sentence's own undulation undo what the receiver did; where all are 0 it does not know them
// (FEEDS.md 1.5). Up is not told: two thirds of a velocity are none.
void StreamReader::place(ObservedEpoch& epoch) {
    const ObservedMotion& motion = epoch.motion;
    if (epoch.type == FixType::none || !motion.latitude) return;
    if (!motion.altitude) return static_cast<void>(++without_altitude_);
    const bool told = motion.separation && separated_;
    if (!told) ++without_separation_;
    const Metres undulation = told             ? *motion.separation
                              : reading_.geoid ? reading_.geoid->undulation(*motion.latitude, *motion.longitude)
                                               : Metres(0);
    epoch.place =
        observed_place(motion.latitude->deg(), motion.longitude->deg(), (*motion.altitude + undulation).value());
}

Result<ObservedLog> StreamReader::finish_nmea() {
    ObservedLog log;
    log.format = "NMEA";
    if (!of_nmea_.empty()) {
        log.receiver = fmt::format("talkers {}", fmt::join(nmea_.talkers(), ", "));
        log.board = "nmea-generic";
    }
    log.dated = date_by_days(of_nmea_);
    if (!log.dated && !of_nmea_.empty() && reading_.use == ObservedUse::events)
        return fail(ErrorCode::input,
                    fmt::format("{}: {} epochs and no date in them; expected RMC or ZDA sentences with one", name_,
                                of_nmea_.size()));
    separated_ = std::any_of(of_nmea_.begin(), of_nmea_.end(), [](const NmeaEpoch& epoch) {
        return epoch.told.motion.separation.value_or(Metres(0)).value() != 0;
    });
    for (NmeaEpoch& epoch : of_nmea_) {
        if (reading_.use == ObservedUse::fixes && !epoch.told.is_solution) continue;
        place(epoch.told);
        log.epochs.push_back(std::move(epoch.told));
    }
    if (reading_.use == ObservedUse::track) return log;
    add_note(log, without_altitude_, "positions without an altitude are not counted as fixes");
    add_note(log, without_separation_,
             reading_.geoid ? "fixes without a geoid separation took it from EGM96"
                            : "fixes without a geoid separation: their heights above sea level stand for heights above "
                              "the ellipsoid, the geoid's grid not being there");
    return log;
}

// UBX or SBF, which tell more, unless a few polled messages stand in a log of NMEA, or NMEA alone tells a date. It is
// told.
Result<ObservedLog> StreamReader::log_of_more() {
    constexpr std::size_t many_more = 2;
    const bool sbf = of_sbf_.log.epochs.size() > of_ubx_.log.epochs.size();
    const bool solves = sbf || !of_ubx_.log.epochs.empty();
    ObservedLog binary = sbf ? finish_sbf() : finish_ubx();
    if (solves && of_nmea_.empty()) return binary;
    Result<ObservedLog> of_nmea = finish_nmea();
    if (!of_nmea) return solves ? Result<ObservedLog>(std::move(binary)) : of_nmea;
    const std::size_t binary_places = places_in(binary), nmea_places = places_in(*of_nmea);
    const bool dates_it = of_nmea->dated && !binary.dated && nmea_places > 0;
    const bool take_nmea = !solves || dates_it || nmea_places > many_more * binary_places;
    ObservedLog& taken = take_nmea ? *of_nmea : binary;
    if (take_nmea && !binary.board.empty()) taken.receiver = binary.receiver, taken.board = binary.board;
    if (solves && (take_nmea || nmea_places > binary_places))
        taken.notes.push_back(fmt::format("{} epochs of NMEA and {} of {} have a place; those of {} are taken",
                                          nmea_places, binary_places, binary.format, taken.format));
    return std::move(taken);
}

std::vector<std::string> StreamReader::damage_notes() const {
    ObservedLog notes;
    add_note(notes, damaged_messages_, "UBX messages with a wrong checksum or a cut end were left out");
    add_note(notes, damaged_, "GGA, GNS or RMC sentences with a wrong checksum or stray bytes were left out");
    add_note(notes, unchecked_, "GGA, GNS or RMC sentences without a checksum were left out");
    add_note(notes, damaged_of_satellites_, "damaged GSA or GSV sentences were left out");
    add_note(notes, senseless_sentences_,
             "sentences with a right checksum that make no sense were left out, the first in " + first_senseless_);
    return notes.notes;
}

tl::unexpected<Error> StreamReader::no_solution() const {
    const StreamCounts& counts = splitter_.counts();
    const std::vector<std::string> notes = damage_notes();
    return fail(ErrorCode::input,
                fmt::format("{}: {} UBX messages and {} NMEA sentences in {} bytes, none of them with a solution; "
                            "expected a UBX, NMEA, SBF, ULog or DataFlash log of a receiver, with NAV-PVT (bytes B5 62 "
                            "01 07), NAV-PVAT, NAV-SOL, NAV-POSLLH, PVTGeodetic, GGA, GNS or RMC{}{}",
                            name_, counts.frames[static_cast<std::size_t>(StreamKind::ubx)],
                            counts.frames[static_cast<std::size_t>(StreamKind::nmea)], counts.bytes,
                            notes.empty() ? "" : "; ", fmt::join(notes, ", ")));
}

Result<ObservedLog> StreamReader::read(ByteSpan bytes) {
    constexpr std::size_t chunk = 65536;
    for (std::size_t at = 0; at < bytes.size(); at += chunk)
        for (const StreamPiece& piece : splitter_.feed(bytes.subspan(at, std::min(chunk, bytes.size() - at))))
            take(piece);
    for (const StreamPiece& piece : splitter_.finish())
        take(piece);
    end_stray_line(true);
    if (auto last = nmea_.end()) of_nmea_.push_back(std::move(*last));
    of_ubx_.add(ubx_.end());
    of_sbf_.add(sbf_.end());
    if (of_ubx_.log.epochs.empty() && of_sbf_.log.epochs.empty() && of_nmea_.empty()) return no_solution();
    if (reading_.receiver != 0)
        return fail(ErrorCode::usage, fmt::format("{}: a stream of one receiver; --gps {} is not in it, expected 0",
                                                  name_, reading_.receiver));
    Result<ObservedLog> log = log_of_more();
    if (!log) return log;
    log->name = name_;
    for (std::string& note : damage_notes())
        log->notes.push_back(std::move(note));
    return finish_log(std::move(*log), reading_);
}

}  // namespace

Result<ObservedLog> read_observed_stream(ByteSpan bytes, const std::string& name, const ObservedReading& reading) {
    return StreamReader(name, reading).read(bytes);
}

}  // namespace skyloop::inline receiver
