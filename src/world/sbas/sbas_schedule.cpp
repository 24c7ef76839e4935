#include "world/sbas/sbas_schedule.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace skyloop::inline world {
namespace {

constexpr std::int64_t frame_s = 6;
constexpr std::int64_t issues_of_fast = 3;  // the fourth is an alarm's

std::int64_t second_of(GpsTime time) {
    return std::chrono::floor<std::chrono::seconds>(time.time_since_epoch()).count();
}
std::int64_t frame_of(GpsTime time) { return second_of(time) / frame_s; }

}  // namespace

SbasSchedule::SbasSchedule(SbasTraffic traffic) : traffic_(std::move(traffic)) {
    cycle_.push_back({1});
    for (std::size_t band = 0; band < traffic_.grid_blocks.size(); ++band)
        cycle_.push_back({18, static_cast<int>(band)});
    for (std::size_t band = 0; band < traffic_.grid_blocks.size(); ++band)
        for (int block = 0; block < traffic_.grid_blocks[band]; ++block)
            cycle_.push_back({26, static_cast<int>(band), block});
    for (int i = 0; i < traffic_.long_term_messages; ++i)
        cycle_.push_back({25, 0, i});
    for (const int type : {7, 9, 10, 17, 27})
        cycle_.push_back({type});
}

// Under test the first block goes by itself, in every frame.
SbasSlot SbasSchedule::fast(int block, std::int64_t turn) const {
    const bool tested = traffic_.under_test && block == 0;
    const bool mixed = traffic_.mixed_last && block + 1 == traffic_.fast_blocks;
    const int type = tested ? 0 : mixed ? 24 : 2 + block;
    return {type, 0, block, static_cast<int>(turn % issues_of_fast), turn};
}

SbasSlot SbasSchedule::at(GpsTime start) const {
    const std::int64_t frame = frame_of(start), slot = second_of(start) % frame_s;
    const int from = traffic_.under_test ? 1 : 0;
    const int blocks = traffic_.fast_blocks - from;
    if (slot == 0) return {6};
    if (slot == 1) return blocks > 0 ? fast(from + static_cast<int>(frame % blocks), frame / blocks) : SbasSlot();
    if (traffic_.under_test && slot == frame_s - 1) return fast(0, frame);
    const std::int64_t others = traffic_.under_test ? 3 : 4;
    const std::int64_t count = frame * others + slot - 2 + traffic_.first_slot;
    return cycle_[static_cast<std::size_t>(count) % cycle_.size()];
}

int SbasSchedule::iodf_before(int block, GpsTime start) const {
    const std::int64_t last = frame_of(start) - 1;
    if (traffic_.under_test && block == 0) return static_cast<int>(last % issues_of_fast);
    const int from = traffic_.under_test ? 1 : 0;
    const std::int64_t blocks = std::max(traffic_.fast_blocks - from, 1);
    const std::int64_t behind = (last - (block - from)) % blocks;
    return static_cast<int>((last - behind) / blocks % issues_of_fast);
}

int SbasSchedule::cycle_s() const {
    const auto others = traffic_.under_test ? 3u : 4u;
    return static_cast<int>((cycle_.size() + others - 1) / others * frame_s);
}

}  // namespace skyloop::inline world
