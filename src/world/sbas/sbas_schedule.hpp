/// Which message an SBAS satellite sends in which second.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/time/gps_time.hpp"

namespace skyloop::inline world {

/// How much there is to send.
struct SbasTraffic {
    int fast_blocks = 1;             ///< of 13 satellites, the last one perhaps of fewer; at most four
    bool mixed_last = false;         ///< the last block has at most six, and goes in message 24
    std::vector<int> grid_blocks{};  ///< of 15 points, of each band that is sent
    int long_term_messages = 0;      ///< 25
    bool under_test = false;         ///< message 0 with the corrections of the first block in the place of message 2
    int first_slot = 0;              ///< where the cycle is, so that satellites of one system differ
};

/// One message of the schedule.
struct SbasSlot {
    int type = 63;
    int band = 0;           ///< of messages 18 and 26, counted among those that are sent
    int block = 0;          ///< of fast corrections, of message 26, or which message 25
    int iodf = 0;           ///< of fast corrections
    std::int64_t turn = 0;  ///< of fast corrections: the number of their frame
};

/// Frames of six seconds: each block of fast corrections, then what comes next in a cycle of all others: 1, 6, 18 and
/// 26 of each band, 25, 7, 9, 10, 17 and 27, once each. So fast corrections and their bounds come every six seconds,
/// and a cycle of EGNOS takes a minute: nothing takes longer than the intervals of DO-229, table A-25 (bounds 6; 60
/// with degradation indicator 0; 120, and 300 of 17, 18, 26 and 27). MSAS in RTKLIB's record ubx_20080526.ubx
/// (test/data/rcvraw) begins each frame with 2, 3 and 4 as well, and sends 1 every 50 to 60 s. Under test message 0 is
/// in the place of 2.
class SbasSchedule {
public:
    explicit SbasSchedule(SbasTraffic traffic);
    /// @param start of the message's second
    [[nodiscard]] SbasSlot at(GpsTime start) const;
    /// What the fast corrections of a frame are numbered.
    [[nodiscard]] static int iodf(GpsTime start);

private:
    [[nodiscard]] SbasSlot fast(int block, GpsTime start) const;

    SbasTraffic traffic_;
    std::vector<SbasSlot> cycle_;
};

}  // namespace skyloop::inline world
