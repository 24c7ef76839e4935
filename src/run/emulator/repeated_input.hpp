/// What clients sent in a run that was recorded, to be heard again.
#pragma once

#include <filesystem>
#include <vector>

#include "base/core/bytes.hpp"
#include "base/core/result.hpp"
#include "base/time/gps_time.hpp"
#include "firmware/port_id.hpp"

namespace skyloop {

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

}  // namespace skyloop
