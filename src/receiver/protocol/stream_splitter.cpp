#include "receiver/protocol/stream_splitter.hpp"

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "base/core/can_frame.hpp"
#include "receiver/protocol/casic_frame.hpp"
#include "receiver/protocol/mavlink.hpp"
#include "receiver/protocol/msp.hpp"
#include "receiver/protocol/nmea_sentence.hpp"
#include "receiver/protocol/sbf_frame.hpp"
#include "receiver/protocol/ubx_frame.hpp"
#include "receiver/protocol/unicore_frame.hpp"

namespace skyloop::inline receiver {
namespace {

constexpr std::size_t splitter_ubx_limit = 8192;
constexpr std::size_t splitter_payload_limit = 8192;  // of MSP, SBF and Unicore
constexpr std::size_t splitter_line_limit = 256;
constexpr std::size_t splitter_noise_limit = 256;
constexpr std::uint8_t rtcm3_preamble = 0xD3;
constexpr std::size_t rtcm3_head_size = 3, rtcm3_crc_size = 3;

// What starts at a byte: nothing, a `kind` whose checksum is wrong, something not yet whole, or `size` bytes of `kind`.
// A verdict other than `unfinished` never changes when more bytes arrive; that makes the pieces independent of the
// cuts.
struct Candidate {
    enum class Verdict : std::uint8_t { nothing, bad, unfinished, whole } verdict = Verdict::nothing;
    StreamKind kind = StreamKind::noise;
    std::size_t size = 0;
};

constexpr Candidate no_piece{};
constexpr Candidate unfinished_piece{Candidate::Verdict::unfinished, StreamKind::noise, 0};

constexpr Candidate bad_piece(StreamKind kind) { return {Candidate::Verdict::bad, kind, 0}; }

Candidate ubx_at(ByteSpan bytes) {
    if (bytes.size() < 2) return unfinished_piece;
    if (bytes[1] != ubx_sync_2) return no_piece;
    if (bytes.size() < ubx_head_size) return unfinished_piece;
    const std::size_t length = bytes[4] + std::size_t{256} * bytes[5];
    if (length > splitter_ubx_limit) return no_piece;
    const std::size_t size = ubx_head_size + length + ubx_tail_size;
    if (bytes.size() < size) return unfinished_piece;
    if (!parse_frame(bytes.first(size))) return bad_piece(StreamKind::ubx);
    return {Candidate::Verdict::whole, StreamKind::ubx, size};
}

Candidate rtcm3_at(ByteSpan bytes) {
    if (bytes.size() < rtcm3_head_size) {
        return bytes.size() == 2 && (bytes[1] & 0xFC) != 0 ? no_piece : unfinished_piece;
    }
    if ((bytes[1] & 0xFC) != 0) return no_piece;
    const std::size_t covered = rtcm3_head_size + (bytes[1] & 0x03u) * std::size_t{256} + bytes[2];
    if (bytes.size() < covered + rtcm3_crc_size) return unfinished_piece;
    const ByteSpan crc = bytes.subspan(covered, rtcm3_crc_size);
    const std::uint32_t said = static_cast<std::uint32_t>(crc[0]) << 16 | static_cast<std::uint32_t>(crc[1]) << 8 |
                               static_cast<std::uint32_t>(crc[2]);
    if (crc24q(bytes.first(covered)) != said) return bad_piece(StreamKind::rtcm3);
    return {Candidate::Verdict::whole, StreamKind::rtcm3, covered + rtcm3_crc_size};
}

Candidate sentence_at(ByteSpan bytes) {
    const std::size_t seen = std::min(bytes.size(), splitter_line_limit);
    for (std::size_t i = 1; i < seen; ++i) {
        const std::uint8_t byte = bytes[i];
        if (byte == '\n') {
            const std::string_view line(reinterpret_cast<const char*>(bytes.data()), i);
            if (!parse_sentence(line)) return bad_piece(StreamKind::nmea);
            return {Candidate::Verdict::whole, StreamKind::nmea, i + 1};
        }
        if ((bytes[i - 1] == '\r' && byte != '\r') || byte == '$') return no_piece;
        if (byte != '\r' && (byte < 0x20 || byte > 0x7E)) return no_piece;
    }
    return bytes.size() < splitter_line_limit ? unfinished_piece : no_piece;
}

// A line of Unicore's, longer than any sentence: one of measurements has some 60 characters for each signal.
Candidate unicore_line_at(ByteSpan bytes) {
    const std::size_t seen = std::min(bytes.size(), splitter_payload_limit);
    for (std::size_t i = 1; i < seen; ++i) {
        const std::uint8_t byte = bytes[i];
        if (byte == '\n') {
            const std::string_view line(reinterpret_cast<const char*>(bytes.data()), i);
            if (!parse_unicore_line(line)) return bytes[0] == '#' ? bad_piece(StreamKind::unicore) : no_piece;
            return {Candidate::Verdict::whole, StreamKind::unicore, i + 1};
        }
        if (byte == bytes[0] || (byte != '\r' && (byte < 0x20 || byte > 0x7E))) return no_piece;
    }
    return bytes.size() < splitter_payload_limit ? unfinished_piece : no_piece;
}

// A frame of which the head is there, and has told its size.
template <class Parse>
Candidate framed_at(ByteSpan bytes, StreamKind kind, std::optional<std::size_t> size, Parse parse) {
    if (!size || *size > splitter_payload_limit) return no_piece;
    if (bytes.size() < *size) return unfinished_piece;
    if (!parse(bytes.first(*size))) return bad_piece(kind);
    return {Candidate::Verdict::whole, kind, *size};
}

Candidate msp_at(ByteSpan bytes) {
    if (bytes.size() < 3) return unfinished_piece;
    if (bytes[2] != '<' && bytes[2] != '>' && bytes[2] != '!') return no_piece;
    if (bytes.size() < (bytes[1] == 'M' ? msp_v1_head_size : msp_v2_head_size)) return unfinished_piece;
    return framed_at(bytes, StreamKind::msp, msp_frame_size(bytes), parse_msp);
}

Candidate sbf_at(ByteSpan bytes) {
    if (bytes.size() < sbf_head_size) return unfinished_piece;
    return framed_at(bytes, StreamKind::sbf, sbf_block_size(bytes), parse_sbf);
}

Candidate unicore_at(ByteSpan bytes) {
    constexpr std::uint8_t sync[] = {unicore_sync_1, unicore_sync_2, unicore_sync_3};
    for (std::size_t i = 1; i < std::min(bytes.size(), std::size(sync)); ++i)
        if (bytes[i] != sync[i]) return no_piece;
    if (bytes.size() < unicore_head_size) return unfinished_piece;
    return framed_at(bytes, StreamKind::unicore, unicore_frame_size(bytes), parse_unicore_frame);
}

Candidate casic_at(ByteSpan bytes) {
    if (bytes.size() > 1 && bytes[1] != casic_sync_2) return no_piece;
    if (bytes.size() < casic_head_size) return unfinished_piece;
    return framed_at(bytes, StreamKind::casic, casic_frame_size(bytes), parse_casic_frame);
}

Candidate mavlink_at(ByteSpan bytes) {
    if (bytes.size() < (bytes[0] == mavlink_v1_start ? mavlink_v1_head_size : mavlink_v2_head_size))
        return unfinished_piece;
    // Frames of messages that are not known cannot be checked: they are not waited for.
    if (!mavlink_crc_extra(*mavlink_message_id(bytes))) return no_piece;
    return framed_at(bytes, StreamKind::mavlink, mavlink_frame_size(bytes), parse_mavlink);
}

// Its length stands in its head, so that what is no frame is seen at the first wrong character.
Candidate slcan_at(ByteSpan bytes) {
    const std::size_t seen = std::min(bytes.size(), SlcanLines::longest + 1);
    for (std::size_t i = 1; i < seen; ++i) {
        const std::uint8_t c = bytes[i];
        if (c == '\r') {
            const std::string_view line(reinterpret_cast<const char*>(bytes.data()), i);
            return parse_slcan_line(line) ? Candidate{Candidate::Verdict::whole, StreamKind::can, i + 1} : no_piece;
        }
        if ((c < '0' || c > '9') && (c < 'A' || c > 'F') && (c < 'a' || c > 'f')) return no_piece;
    }
    return bytes.size() <= SlcanLines::longest ? unfinished_piece : no_piece;
}

Candidate dollar_at(ByteSpan bytes, const StreamProtocols& protocols) {
    if (bytes.size() < 2) return unfinished_piece;
    if (protocols.sbf && bytes[1] == sbf_sync_2) return sbf_at(bytes);
    if (protocols.msp && (bytes[1] == 'M' || bytes[1] == 'X')) {
        // A sentence may begin with the same two letters.
        const Candidate found = msp_at(bytes);
        if (found.verdict != Candidate::Verdict::nothing || !protocols.nmea) return found;
    }
    if (!protocols.nmea) return protocols.unicore ? unicore_line_at(bytes) : no_piece;
    const Candidate sentence = sentence_at(bytes);
    // An answer is a sentence whose checksum covers its dollar, too.
    if (!protocols.unicore || sentence.verdict != Candidate::Verdict::bad) return sentence;
    const Candidate answer = unicore_line_at(bytes);
    return answer.verdict == Candidate::Verdict::whole ? answer : sentence;
}

Candidate piece_at(ByteSpan bytes, const StreamProtocols& protocols) {
    switch (bytes[0]) {
        case ubx_sync_1:
            return protocols.ubx ? ubx_at(bytes) : no_piece;
        case rtcm3_preamble:
            return protocols.rtcm3 ? rtcm3_at(bytes) : no_piece;
        case mavlink_v1_start:
        case mavlink_v2_start:
            return protocols.mavlink ? mavlink_at(bytes) : no_piece;
        case unicore_sync_1:
            return protocols.unicore ? unicore_at(bytes) : no_piece;
        case casic_sync_1:
            return protocols.casic ? casic_at(bytes) : no_piece;
        case '#':
            return protocols.unicore ? unicore_line_at(bytes) : no_piece;
        case '$':
            return dollar_at(bytes, protocols);
        case '!':
            return protocols.nmea ? sentence_at(bytes) : no_piece;
        case 'T':
        case 't':
            return protocols.can ? slcan_at(bytes) : no_piece;
        default:
            return no_piece;
    }
}

// Of a line, a right checksum or a wrong one.
bool ends_in_checksum(ByteSpan line) {
    const auto end = std::find_if(line.begin(), line.end(), [](std::uint8_t c) { return c == '\r' || c == '\n'; });
    return end - line.begin() > 3 && *(end - 3) == '*';
}

constexpr std::size_t index_of(StreamKind kind) { return static_cast<std::size_t>(kind); }

}  // namespace

std::uint32_t crc24q(ByteSpan bytes) {
    std::uint32_t crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc ^= static_cast<std::uint32_t>(byte) << 16;
        for (int bit = 0; bit < 8; ++bit) {
            crc <<= 1;
            if ((crc & 0x1000000u) != 0) crc ^= 0x1864CFBu;
        }
    }
    return crc;
}

std::vector<StreamPiece> StreamSplitter::feed(ByteSpan bytes) {
    std::vector<StreamPiece> pieces;
    // In portions, so that a long stream handed over at once needs no more memory than a slow one.
    while (!bytes.empty()) {
        const std::size_t portion = std::min(bytes.size(), splitter_ubx_limit);
        pending_.insert(pending_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(portion));
        bytes = bytes.subspan(portion);
        search({false, protocols_.impatient}, pieces);
    }
    return pieces;
}

std::vector<StreamPiece> StreamSplitter::give_way() {
    std::vector<StreamPiece> pieces;
    search({false, true}, pieces);
    return pieces;
}

std::vector<StreamPiece> StreamSplitter::finish() {
    std::vector<StreamPiece> pieces;
    search({true, false}, pieces);
    flush_noise(pieces);
    return pieces;
}

void StreamSplitter::search(Unfinished unfinished, std::vector<StreamPiece>& pieces) {
    const ByteSpan bytes(pending_);
    std::size_t at = 0;
    while (at < bytes.size()) {
        const Candidate found = piece_at(bytes.subspan(at), protocols_);
        const bool waits = !unfinished.is_nothing && !(unfinished.gives_way && holds_whole_in(bytes.subspan(at)));
        if (found.verdict == Candidate::Verdict::unfinished && waits) break;
        if (found.verdict == Candidate::Verdict::bad) {
            ++counts_.bad[index_of(found.kind)];
            if (found.kind == StreamKind::nmea && !ends_in_checksum(bytes.subspan(at))) ++counts_.unchecked;
        }
        if (found.verdict != Candidate::Verdict::whole) {
            keep_noise(bytes[at], pieces);
            ++at;
            continue;
        }
        flush_noise(pieces);
        const ByteSpan piece = bytes.subspan(at, found.size);
        pieces.push_back({found.kind, Bytes(piece.begin(), piece.end())});
        ++counts_.frames[index_of(found.kind)];
        counts_.bytes += found.size;
        at += found.size;
    }
    pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(at));
}

bool StreamSplitter::holds_whole() const { return holds_whole_in(pending_); }

// Whether a whole UBX frame or sentence stands behind the first byte of something unfinished.
bool StreamSplitter::holds_whole_in(ByteSpan unfinished) const {
    for (std::size_t i = 1; i < unfinished.size(); ++i) {
        const Candidate inner = piece_at(unfinished.subspan(i), protocols_);
        if (inner.verdict == Candidate::Verdict::whole && inner.kind != StreamKind::rtcm3) return true;
    }
    return false;
}

void StreamSplitter::keep_noise(std::uint8_t byte, std::vector<StreamPiece>& pieces) {
    noise_.push_back(byte);
    ++counts_.bytes;
    ++counts_.skipped;
    if (noise_.size() == splitter_noise_limit) flush_noise(pieces);
}

void StreamSplitter::flush_noise(std::vector<StreamPiece>& pieces) {
    if (noise_.empty()) return;
    pieces.push_back({StreamKind::noise, std::exchange(noise_, {})});
}

namespace {

using namespace std::chrono_literals;

// A beginning that goes on no further is false: a client waits for its answer. So is one that goes on for longer than
// the longest settings take at 9600 baud: clients that never pause must not wait for 8192 bytes, nor those that poll
// more often than every silence.
constexpr Nanoseconds silence_of_false_beginning = 100ms, longest_of_false_beginning = 1s;

}  // namespace

std::vector<StreamPiece> PatientSplitter::feed(ByteSpan bytes, GpsTime now) {
    std::vector<StreamPiece> pieces = splitter_.feed(bytes);
    gives_way_at_.reset();
    if (!splitter_.holds_whole()) {
        held_since_.reset();
        return pieces;
    }
    if (!held_since_) held_since_ = now;
    gives_way_at_ = std::min(now + silence_of_false_beginning, *held_since_ + longest_of_false_beginning);
    return pieces;
}

std::vector<StreamPiece> PatientSplitter::give_way() {
    held_since_.reset();
    gives_way_at_.reset();
    return splitter_.give_way();
}

std::vector<StreamPiece> PatientSplitter::finish() {
    held_since_.reset();
    gives_way_at_.reset();
    return splitter_.finish();
}

}  // namespace skyloop::inline receiver
