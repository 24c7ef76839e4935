#include "world/gnss/gps_blocks.hpp"

#include <array>
#include <chrono>

namespace skyloop {
namespace {

using namespace std::chrono_literals;

constexpr std::chrono::sys_days gps_epoch = 1980y / 1 / 6;
constexpr int last_prn = 32;

enum class Block { iir_m, iif_or_iii };

// A satellite under a PRN from its launch on, or where it had been launched long before, from when it got that PRN.
struct Satellite {
    int prn;
    std::chrono::sys_days from;
    Block block;
};

// Blocks IIR-M and IIF as in GPS World's almanac of active satellites (2018; launches in UTC), PRN 1 as in the IGS
// satellite metadata (SATELLITE/PRN), Block III by its announced launches. In order of PRN and time; a PRN that is not
// here has been of Block IIR or before so far. Left out are the months when SVN 49 tested other PRNs, unhealthy.
constexpr std::array launched{
    Satellite{1, 2009y / 3 / 24, Block::iir_m},         // SVN 49
    Satellite{1, 2011y / 7 / 16, Block::iif_or_iii},    // SVN 63
    Satellite{1, 2024y / 4 / 22, Block::iir_m},         // SVN 49
    Satellite{1, 2024y / 12 / 17, Block::iif_or_iii},   // SVN 80
    Satellite{3, 2014y / 10 / 29, Block::iif_or_iii},   // SVN 69
    Satellite{4, 2018y / 12 / 23, Block::iif_or_iii},   // SVN 74
    Satellite{5, 2009y / 8 / 17, Block::iir_m},         // SVN 50
    Satellite{6, 2014y / 5 / 17, Block::iif_or_iii},    // SVN 67
    Satellite{7, 2008y / 3 / 15, Block::iir_m},         // SVN 48
    Satellite{8, 2015y / 7 / 15, Block::iif_or_iii},    // SVN 72
    Satellite{9, 2014y / 8 / 2, Block::iif_or_iii},     // SVN 68
    Satellite{10, 2015y / 10 / 31, Block::iif_or_iii},  // SVN 73
    Satellite{11, 2021y / 6 / 17, Block::iif_or_iii},   // SVN 78
    Satellite{12, 2006y / 11 / 17, Block::iir_m},       // SVN 58
    Satellite{14, 2020y / 11 / 5, Block::iif_or_iii},   // SVN 77
    Satellite{15, 2007y / 10 / 17, Block::iir_m},       // SVN 55
    Satellite{17, 2005y / 9 / 26, Block::iir_m},        // SVN 53
    Satellite{18, 2019y / 8 / 22, Block::iif_or_iii},   // SVN 75
    Satellite{21, 2025y / 5 / 30, Block::iif_or_iii},   // SVN 81
    Satellite{23, 2020y / 6 / 30, Block::iif_or_iii},   // SVN 76
    Satellite{24, 2012y / 10 / 4, Block::iif_or_iii},   // SVN 65
    Satellite{25, 2010y / 5 / 28, Block::iif_or_iii},   // SVN 62
    Satellite{26, 2015y / 3 / 25, Block::iif_or_iii},   // SVN 71
    Satellite{27, 2013y / 5 / 15, Block::iif_or_iii},   // SVN 66
    Satellite{28, 2023y / 1 / 18, Block::iif_or_iii},   // SVN 79
    Satellite{29, 2007y / 12 / 20, Block::iir_m},       // SVN 57
    Satellite{30, 2014y / 2 / 21, Block::iif_or_iii},   // SVN 64
    Satellite{31, 2006y / 9 / 25, Block::iir_m},        // SVN 52
    Satellite{32, 2016y / 2 / 5, Block::iif_or_iii},    // SVN 70
};

// The rows of a PRN are [first_row[prn], first_row[prn + 1]).
constexpr auto first_row = [] {
    std::array<std::size_t, last_prn + 2> first{};
    for (std::size_t prn = 0; prn < first.size(); ++prn) {
        while (first[prn] < launched.size() && launched[first[prn]].prn < static_cast<int>(prn))
            ++first[prn];
    }
    return first;
}();

}  // namespace

bool gps_sends(int prn, Signal signal, GpsTime when) {
    if (signal == Signal::l1 || prn > last_prn) return true;
    const auto n = static_cast<std::size_t>(prn);
    const std::chrono::nanoseconds since_epoch = when.time_since_epoch();
    for (std::size_t row = first_row.at(n + 1); row > first_row.at(n); --row) {
        const Satellite& s = launched.at(row - 1);
        if (s.from - gps_epoch <= since_epoch) return signal == Signal::l2 || s.block == Block::iif_or_iii;
    }
    return false;
}

}  // namespace skyloop
