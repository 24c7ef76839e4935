/// Finds UBX frames, NMEA sentences, RTCM 3 frames and, when asked to, frames of MSP, MAVLink, SBF, Unicore, CAN and
/// CASIC in one stream of bytes (RECEIVER.md 1.3, 1.4).
///
/// A splitter for what a client sends, which tells payloads from false beginnings by the time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline receiver {

/// What a piece of the stream is.
enum class StreamKind : std::uint8_t {
    ubx,      ///< a frame whose checksum holds
    nmea,     ///< a sentence whose checksum holds, with its line end
    rtcm3,    ///< a frame whose CRC-24Q holds
    noise,    ///< anything else, frames with wrong checksums among it
    msp,      ///< a frame of version 1 or 2 whose checksum holds
    mavlink,  ///< a frame of a known message whose checksum holds
    sbf,      ///< a block whose CRC holds
    command,  ///< a line of a command line, which the splitter does not look for: any text could be one
    unicore,  ///< a log, binary or as a line from #, or an answer, whose check holds as Unicore computes it
    can,      ///< a frame of a CAN bus as a line of SLCAN, with its carriage return; it has no checksum
    casic,    ///< a frame whose sum of words holds
};
inline constexpr std::size_t stream_kind_count = 11;

/// Which protocols are looked for.
struct StreamProtocols {
    bool ubx = true, nmea = true, rtcm3 = true;
    bool msp = false, mavlink = false, sbf = false, unicore = false, can = false, casic = false;
    /// What is not yet whole is given up as soon as a whole UBX frame or sentence stands inside it, as by give_way().
    /// For who knows no time, and would rather lose a frame that holds another than wait for a false beginning.
    bool impatient = false;
};

/// What has been found so far, by StreamKind.
struct StreamCounts {
    std::array<std::uint64_t, stream_kind_count> frames{};
    /// Frames that were whole, but whose checksum did not hold; of NMEA: lines from `$` or `!` to their end without a
    /// right checksum. What begins a frame by chance counts too.
    std::array<std::uint64_t, stream_kind_count> bad{};
    std::uint64_t unchecked = 0;  ///< of bad sentences: those that end in no checksum at all
    std::uint64_t bytes = 0;      ///< decided
    std::uint64_t skipped = 0;    ///< of them, in no frame
};

/// Bytes that belong together; all pieces one after the other are the stream.
struct StreamPiece {
    StreamKind kind = StreamKind::noise;
    Bytes bytes;
    bool operator==(const StreamPiece&) const = default;
};

/// RTCM's CRC-24Q, polynomial 0x1864CFB (RTCM 10403.3, section 4.2).
std::uint32_t crc24q(ByteSpan bytes);

/// Cuts a stream into pieces that do not depend on how it arrives.
///
/// What fails its checksum is searched again from the byte after its first. UBX payloads of more than 8192 bytes, MSP
/// payloads and SBF blocks of more than 8192 and lines of more than 256 characters count as noise. State: the bytes not
/// yet decided (at most one frame), the noise before them (at most 256 bytes) and the counts.
class StreamSplitter {
public:
    StreamSplitter() = default;
    explicit StreamSplitter(StreamProtocols protocols) : protocols_(protocols) {}

    /// The pieces that `bytes` completes.
    std::vector<StreamPiece> feed(ByteSpan bytes);
    /// Decides what is left as if nothing followed: at the end, or after a silence that a frame does not have.
    std::vector<StreamPiece> finish();
    /// Whether a whole UBX frame or sentence stands inside something that is not yet whole: either its payload, or what
    /// follows a false beginning.
    [[nodiscard]] bool holds_whole() const;
    /// Decides for the latter: the pieces that then come out.
    std::vector<StreamPiece> give_way();
    [[nodiscard]] const StreamCounts& counts() const { return counts_; }

private:
    // What becomes of something that is not yet whole.
    struct Unfinished {
        bool is_nothing = false;  // nothing follows
        bool gives_way = false;   // to something whole inside it
    };
    void search(Unfinished unfinished, std::vector<StreamPiece>& pieces);
    [[nodiscard]] bool holds_whole_in(ByteSpan unfinished) const;
    void keep_noise(std::uint8_t byte, std::vector<StreamPiece>& pieces);
    void flush_noise(std::vector<StreamPiece>& pieces);

    StreamProtocols protocols_;
    StreamCounts counts_;
    Bytes pending_;
    Bytes noise_;
};

/// Cuts a stream into pieces. A whole frame inside something that is not yet whole is its payload, or what follows a
/// false beginning: the latter after 100 ms without another byte, at the latest after 1 s.
///
/// State: that of its StreamSplitter, and when something inside was whole first.
class PatientSplitter {
public:
    PatientSplitter() = default;
    explicit PatientSplitter(StreamProtocols protocols) : splitter_(protocols) {}

    /// The pieces that `bytes` completes. Where the time of give_way() has come it is called first.
    std::vector<StreamPiece> feed(ByteSpan bytes, GpsTime now);
    /// When a beginning counts as false unless more bytes come; nothing while there is none.
    [[nodiscard]] std::optional<GpsTime> gives_way_at() const { return gives_way_at_; }
    /// The pieces that come out then.
    std::vector<StreamPiece> give_way();
    /// Decides what is left as if nothing followed.
    std::vector<StreamPiece> finish();
    [[nodiscard]] const StreamCounts& counts() const { return splitter_.counts(); }

private:
    StreamSplitter splitter_;
    std::optional<GpsTime> held_since_, gives_way_at_;
};

}  // namespace skyloop::inline receiver
