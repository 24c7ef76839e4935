/// An SBAS satellite of a test, which tells what it is given.
#pragma once

#include <chrono>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "world/flow/observations.hpp"
#include "world/gnss/sbas_grid.hpp"
#include "world/gnss/sbas_message.hpp"

namespace skyloop::test {

struct ToldSatellite {
    double range_m = 0;  // that pseudoranges are too long by
    int iode = 0;
    std::array<double, 3> orbit_m{};
    double clock_s = 0;
    int udrei = 3;
};

/// Messages of corrections of GPS satellites, and of the grid's band around a place.
struct SbasSender {
    SatelliteId satellite{Constellation::sbas, 36};
    std::map<int, ToldSatellite> told{};  // by PRN
    int band = 5;
    std::function<std::optional<double>(const SbasGridPoint&)> delay = [](const SbasGridPoint&) { return 2.0; };

    [[nodiscard]] Subframe sent(const SbasMessage& message, GpsTime end) const {
        const SbasWords words = encode_sbas(message, end - std::chrono::seconds(1));
        return {satellite, Signal::l1, end, 0, {words.begin(), words.end()}};
    }
    [[nodiscard]] SbasPrnMask mask() const {
        SbasPrnMask m;
        for (const auto& [prn, satellite_told] : told)
            m.slots.push_back(prn);
        m.iodp = 1;
        return m;
    }
    [[nodiscard]] std::vector<ToldSatellite> in_order() const {
        std::vector<ToldSatellite> list;
        for (const auto& [prn, satellite_told] : told)
            list.push_back(satellite_told);
        return list;
    }
    [[nodiscard]] std::vector<SbasFastCorrections> fast() const {
        const auto list = in_order();
        std::vector<SbasFastCorrections> blocks((list.size() + sbas_block - 1) / sbas_block);
        for (std::size_t i = 0; i < list.size(); ++i) {
            SbasFastCorrections& block = blocks[i / sbas_block];
            block.block = static_cast<int>(i / sbas_block);
            block.iodp = 1;
            block.satellites[i % sbas_block] = {-list[i].range_m, list[i].udrei};
        }
        return blocks;
    }
    [[nodiscard]] std::vector<SbasLongTermCorrections> slow() const {
        const auto list = in_order();
        std::vector<SbasLongTermCorrections> messages((list.size() + 3) / 4);
        for (std::size_t i = 0; i < list.size(); ++i) {
            SbasLongTermHalf& half = messages[i / 4].halves[i % 4 / 2];
            half.iodp = 1;
            half.satellites[i % 2] = {static_cast<int>(i) + 1, list[i].iode, list[i].orbit_m, list[i].clock_s};
        }
        return messages;
    }
    [[nodiscard]] SbasGridMask grid_mask() const {
        SbasGridMask m{1, band, 1, {}};
        for (std::size_t i = 0; i < sbas_band(band).size(); ++i)
            m.points.push_back(static_cast<int>(i) + 1);
        return m;
    }
    [[nodiscard]] std::vector<SbasIonosphere> grid() const {
        const auto& points = sbas_band(band);
        std::vector<SbasIonosphere> blocks((points.size() + SbasIonosphere::size - 1) / SbasIonosphere::size);
        for (std::size_t i = 0; i < points.size(); ++i) {
            SbasIonosphere& block = blocks[i / SbasIonosphere::size];
            block.band = band;
            block.block = static_cast<int>(i / SbasIonosphere::size);
            block.iodi = 1;
            block.points[i % SbasIonosphere::size] = {delay(points[i]), 1};
        }
        return blocks;
    }
    /// All of it at one instant, which no satellite could do.
    [[nodiscard]] std::vector<Subframe> everything(GpsTime end) const {
        std::vector<Subframe> all{sent(mask(), end), sent(grid_mask(), end)};
        for (const auto& m : fast())
            all.push_back(sent(m, end));
        for (const auto& m : slow())
            all.push_back(sent(m, end));
        for (const auto& m : grid())
            all.push_back(sent(m, end));
        return all;
    }
};

}  // namespace skyloop::test
