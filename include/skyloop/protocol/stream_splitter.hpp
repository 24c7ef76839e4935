/// Finds UBX frames, NMEA sentences and RTCM 3 frames in one stream of bytes (RECEIVER.md 1.3, 1.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "skyloop/base/bytes.hpp"

namespace skyloop {

/// What a piece of the stream is.
enum class StreamKind : std::uint8_t {
    ubx,    ///< a frame whose checksum holds
    nmea,   ///< a sentence whose checksum holds, with its line end
    rtcm3,  ///< a frame whose CRC-24Q holds
    noise,  ///< anything else, frames with wrong checksums among it
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
/// What fails its checksum is searched again from the byte after its first. UBX payloads of more than 8192 bytes and
/// lines of more than 256 characters count as noise. State: the bytes not yet decided (at most one frame) and the
/// noise before them (at most 256 bytes).
class StreamSplitter {
public:
    /// The pieces that `bytes` completes.
    std::vector<StreamPiece> feed(ByteSpan bytes);
    /// Decides what is left as if nothing followed: at the end, or after a silence that a frame does not have.
    std::vector<StreamPiece> finish();

private:
    void search(bool at_end, std::vector<StreamPiece>& pieces);
    void keep_noise(std::uint8_t byte, std::vector<StreamPiece>& pieces);
    void flush_noise(std::vector<StreamPiece>& pieces);

    Bytes pending_;
    Bytes noise_;
};

}  // namespace skyloop
