/// Transfers of DroneCAN: a message, request or response in the frames that carry it.
///
/// Facts: dronecan.github.io, specification 4 (transport layer); dronecan/pydronecan, transport.py. The code is our
/// own, since Debian has no libcanard.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/can_frame.hpp"
#include "base/time/gps_time.hpp"
#include "receiver/protocol/dronecan_messages.hpp"

namespace skyloop::inline receiver {

/// One transfer. Node ids are 1 … 127; 0 is nobody: the source of an anonymous message, the destination of any message.
struct DronecanTransfer {
    DronecanKind kind = DronecanKind::message;
    std::uint16_t type_id = 0;   ///< of an anonymous message its lowest two bits
    std::uint8_t priority = 24;  ///< 0 … 31, the lower the sooner
    std::uint8_t source = 0, destination = 0;
    std::uint8_t transfer_id = 0;  ///< 0 … 31
    Bytes payload;
    [[nodiscard]] bool operator==(const DronecanTransfer&) const = default;
};

/// Its frames, in the order in which they are sent. An anonymous message of more than seven bytes has none, nor has a
/// transfer of more bytes than any type has.
/// @param signature of its type
std::vector<CanFrame> dronecan_frames(const DronecanTransfer& transfer, std::uint64_t signature);

/// What became of the frames that TransferReceiver was given.
struct DronecanCounts {
    std::uint64_t transfers = 0;     ///< whole, with a right CRC
    std::uint64_t malformed = 0;     ///< frames that no transfer has: short ones, standard ids, a wrong first toggle
    std::uint64_t out_of_order = 0;  ///< frames whose toggle or transfer id is not the next one, or that nothing began
    std::uint64_t bad_crc = 0;       ///< transfers
    std::uint64_t repeated = 0;      ///< transfers that came again
    std::uint64_t unfinished = 0;    ///< transfers that another one, or 2 s of silence, ended
    [[nodiscard]] bool operator==(const DronecanCounts&) const = default;
};

/// Puts transfers together from frames. Those of types that are not known are left alone.
///
/// State: of each kind, type, source and destination the unfinished transfer and the id of the last one, of at most
/// `most_sessions`; the counts.
class TransferReceiver {
public:
    static constexpr std::size_t most_sessions = 256;
    static constexpr std::size_t longest_payload = 512;  ///< more than any type here has

    /// The transfer that this frame completes. Times do not go back.
    std::optional<DronecanTransfer> take(const CanFrame& frame, GpsTime now);
    [[nodiscard]] const DronecanCounts& counts() const { return counts_; }

private:
    struct Session {
        Bytes bytes;  ///< so far, the CRC before them
        bool begun = false, toggle = false;
        std::uint8_t transfer_id = 0;
        std::optional<std::uint8_t> last_id{};  ///< of the last whole one
        GpsTime last{};
    };
    struct Piece {
        ByteSpan bytes{};  ///< without the tail
        bool starts = false, ends = false, toggle = false;
        std::uint8_t transfer_id = 0;
    };
    static Piece piece_of(const CanFrame& frame);
    Session* session_of(std::uint32_t key, GpsTime now);
    bool begins(Session& session, const Piece& piece, GpsTime now);
    bool continues(Session& session, const Piece& piece, GpsTime now);
    std::optional<Bytes> payload_of(const Session& session, const DronecanType& type);
    std::optional<Bytes> collect(Session& session, const Piece& piece, const DronecanType& type);

    std::map<std::uint32_t, Session> sessions_;
    DronecanCounts counts_;
};

/// The head of a transfer that a frame belongs to, without its payload. Nothing for frames that no transfer has.
std::optional<DronecanTransfer> dronecan_head(const CanFrame& frame);

}  // namespace skyloop::inline receiver
