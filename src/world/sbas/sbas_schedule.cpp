#include "world/sbas/sbas_schedule.hpp"

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
    cycle_.push_back({6});
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

SbasSlot SbasSchedule::fast(int block, GpsTime start) const {
    const bool tested = traffic_.under_test && block == 0;
    const bool mixed = traffic_.mixed_last && block + 1 == traffic_.fast_blocks;
    const int type = tested ? 0 : mixed ? 24 : 2 + block;
    return {type, 0, block, iodf(start), frame_of(start)};
}

SbasSlot SbasSchedule::at(GpsTime start) const {
    const std::int64_t slot = second_of(start) % frame_s, blocks = traffic_.fast_blocks;
    if (slot < blocks) return fast(static_cast<int>(slot), start);
    const auto count = frame_of(start) * (frame_s - blocks) + slot - blocks + traffic_.first_slot;
    return cycle_[static_cast<std::size_t>(count) % cycle_.size()];
}

int SbasSchedule::iodf(GpsTime start) { return static_cast<int>(frame_of(start) % issues_of_fast); }

}  // namespace skyloop::inline world
