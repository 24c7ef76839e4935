/// What a recorded receiver sent, with its times.
/// What clients sent in a run that was recorded, to be heard again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/core/port_id.hpp"

namespace skyloop::inline run {

/// Bytes that left at one instant.
struct RecordedWrite {
    Nanoseconds at{0};                   ///< on a clock that all ports of a recording share
    std::size_t offset = 0, length = 0;  ///< of RecordedPort::bytes
};

/// One port of a recording.
struct RecordedPort {
    Bytes bytes;
    std::vector<RecordedWrite> writes;  ///< by time; they follow each other without a gap in `bytes`
    std::string warning;                ///< what a recording that was cut short lacks; empty: nothing
};

/// Reads the lines of portN.times: nanoseconds of the monotonic clock and of GPS time, offset, length.
///
/// A run that was killed may leave half a line, and bytes without a line: they are left out, and `warning` says so.
/// Fails with `input`, naming the line, when one is not understood, goes back in time, leaves a gap, or tells of bytes
/// that are not there.
/// @param name of the file, for messages
Result<RecordedPort> read_recorded_times(std::string_view times, Bytes bytes, std::string_view name);

/// Reads port0.out with port0.times, port1.out …, of the folder of `run --record` or `simulate --out` (INTERFACE.md
/// section 3). Fails with `outside` when there is none or it cannot be read, or as read_recorded_times() does.
Result<std::vector<RecordedPort>> read_recorded_output(const std::filesystem::path& folder);

/// Bytes without times, as a UART of this speed would send them: ten bits each, without a pause, a piece a millisecond.
/// @param baud bit/s, more than 0
RecordedPort paced_output(Bytes bytes, std::uint32_t baud);

/// The part of a recording from an instant on, for a while; both count from its first write on any port.
/// Fails with `usage` when nothing was sent then.
Result<std::vector<RecordedPort>> part_of(std::vector<RecordedPort> ports, Nanoseconds from, Nanoseconds duration);

/// Bytes that reached a receiver at one instant.
struct HeardBytes {
    GpsTime at{};
    std::size_t wire = 0;
    firmware::PortId port = firmware::PortId::uart1;
    Bytes bytes;
};

/// The input of one receiver, ascending in time: portN.in by the lines of portN.in_times.
/// @param folder of its recording @param ports of its wires
/// Fails with `outside` for a missing file, with `input` for lines that do not fit it, naming file and line.
Result<std::vector<HeardBytes>> read_repeated_input(const std::filesystem::path& folder,
                                                    const std::vector<firmware::PortId>& ports);

}  // namespace skyloop::inline run
