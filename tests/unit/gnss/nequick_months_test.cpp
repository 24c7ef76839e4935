// The tables of the months: each is whole, and its ionosphere is one that could be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "support/oracle_table.hpp"
#include "world/gnss/nequick_g.hpp"

namespace skyloop {
namespace {

NequickTables tables_of(int month) {
    const auto read = read_nequick_tables(std::filesystem::path(SKYLOOP_SOURCE_DIR) / "data/nequick_g", month);
    if (!read) throw std::runtime_error(read.error().message);
    return *read;
}

std::vector<double> coefficients_of(const NequickTables& tables) {
    std::vector<double> all;
    for (const auto& map : tables.ccir.critical_frequency)
        for (const auto& row : map)
            all.insert(all.end(), row.begin(), row.end());
    for (const auto& map : tables.ccir.transmission_factor)
        for (const auto& row : map)
            all.insert(all.end(), row.begin(), row.end());
    return all;
}

double vertical_content(const NequickTables& tables, double latitude, double longitude, double hour) {
    return nequick_slant_content(tables, {120, 0, 0}, Geodetic::degrees(latitude, longitude, 0),
                                 Geodetic::degrees(latitude, longitude, 20200e3), hour)
        .value();
}

TEST(NequickMonths, EveryMonthIsThereAndPossibleEverywhere) {
    for (int month = 1; month <= 12; ++month) {
        SCOPED_TRACE(month);
        const NequickTables tables = tables_of(month);
        for (double latitude = -75; latitude <= 75; latitude += 30)
            for (double longitude = -180; longitude < 180; longitude += 90)
                for (const double hour : {0.0, 12.0}) {
                    const double content = vertical_content(tables, latitude, longitude, hour);
                    EXPECT_GT(content, 0.5) << latitude << " " << longitude << " " << hour;
                    EXPECT_LT(content, 120) << latitude << " " << longitude << " " << hour;
                }
    }
}

// The year turns: no coefficient of a month is far beyond what the other months have, as one with a wrong exponent or a
// lost digit would be.
TEST(NequickMonths, NoCoefficientStandsOut) {
    std::vector<std::vector<double>> months;
    for (int month = 1; month <= 12; ++month)
        months.push_back(coefficients_of(tables_of(month)));
    for (std::size_t i = 0; i < months[0].size(); ++i) {
        std::vector<double> sizes;
        for (const auto& month : months)
            sizes.push_back(std::abs(month[i]));
        const auto largest = std::max_element(sizes.begin(), sizes.end());
        const double size = *largest;
        const auto month = largest - sizes.begin() + 1;
        std::sort(sizes.begin(), sizes.end());
        EXPECT_LT(size, 12 * sizes[10]) << "coefficient " << i << ", month " << month;
    }
}

// Neighbouring months are more alike than opposite seasons.
TEST(NequickMonths, MonthsFollowEachOther) {
    std::vector<NequickTables> year;
    for (int month = 1; month <= 12; ++month)
        year.push_back(tables_of(month));
    double neighbours = 0, opposites = 0;
    for (std::size_t m = 0; m < 12; ++m)
        for (const double latitude : {-45.0, 0.0, 45.0})
            for (const double longitude : {-120.0, 0.0, 120.0}) {
                const double here = vertical_content(year[m], latitude, longitude, 12);
                neighbours += std::abs(here - vertical_content(year[(m + 1) % 12], latitude, longitude, 12));
                opposites += std::abs(here - vertical_content(year[(m + 6) % 12], latitude, longitude, 12));
            }
    EXPECT_LT(neighbours, 0.8 * opposites);
}

}  // namespace
}  // namespace skyloop
