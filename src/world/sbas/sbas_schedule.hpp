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
    int fast_blocks = 1;             ///< of 13 satellites, the last one perhaps of fewer
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
    std::int64_t turn = 0;  ///< of fast corrections: how often they have all been sent
};

/// Frames of six seconds: integrity (6), one message of fast corrections, and four of all others in a cycle: 1, 18 and
/// 26 of each band, 25, 7, 9, 10, 17 and 27, once each. Under test the last of the four is message 0. So bounds come
/// every six seconds, fast corrections every six for each block, at most 24, and a cycle of EGNOS takes 42 s: none is
/// longer than the intervals of DO-229, table A-25 (6; 60 with degradation indicator 0; 120, and 300 of 17, 18, 26 and
/// 27).
class SbasSchedule {
public:
    explicit SbasSchedule(SbasTraffic traffic);
    /// @param start of the message's second
    [[nodiscard]] SbasSlot at(GpsTime start) const;
    /// What the last message of a block of fast corrections before a frame was numbered.
    [[nodiscard]] int iodf_before(int block, GpsTime start) const;
    /// Seconds in which all but fast corrections are sent once.
    [[nodiscard]] int cycle_s() const;

private:
    [[nodiscard]] SbasSlot fast(int block, std::int64_t turn) const;

    SbasTraffic traffic_;
    std::vector<SbasSlot> cycle_;
};

}  // namespace skyloop::inline world
