/// NeQuick-G: the three-dimensional ionosphere model that is driven by the Galileo broadcast.
///
/// The two tables that NeQuick-G stands on: the CCIR coefficients of the F2 layer and the grid of modified dip
/// latitude.
#pragma once

#include <array>
#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "world/gnss/shell_ionosphere.hpp"

namespace skyloop::inline world {

/// One month of the CCIR numerical maps (ITU-R P.1239; CCIR Atlas, Report 340): for sunspot number 0 and 100, by term
/// of place, then of time.
struct CcirMonth {
    template <std::size_t Places, std::size_t Times>
    using Map = std::array<std::array<std::array<double, Times>, Places>, 2>;
    Map<76, 13> critical_frequency;  ///< foF2, MHz
    Map<49, 9> transmission_factor;  ///< M(3000)F2
};

/// Reads the 2858 numbers of a file ccir11.asc (January) … ccir22.asc (December), as the European Commission annexes
/// them to its NeQuick-G document. Fails with `input` and FILE:LINE when there are more, fewer, or something else.
Result<CcirMonth> read_ccir_month(std::string_view text, std::string_view name);

/// Modified dip latitude, degrees, every 5° of latitude from −95° to 95° and every 10° of longitude from −190° to 190°:
/// one step more than the globe on each side.
struct ModipGrid {
    static constexpr std::size_t size = 39;
    std::array<std::array<double, size>, size> degrees;
};

/// Reads the 39 × 39 numbers of modipNeQG_wrapped.asc. Fails as read_ccir_month does.
Result<ModipGrid> read_modip_grid(std::string_view text, std::string_view name);

/// Modified dip latitude of a place by third-order interpolation (NeQuick-G document, MODIP interpolation).
Angle modified_dip_latitude(const ModipGrid& grid, Angle latitude, Angle longitude);

/// Both tables for one month.
struct NequickTables {
    int month = 1;  ///< 1 … 12
    ModipGrid modip;
    CcirMonth ccir;
};

/// Reads both from a folder with the Commission's files. Fails as read_text_file and the readers do.
/// @param month 1 … 12
Result<NequickTables> read_nequick_tables(const std::filesystem::path& folder, int month);

/// The effective ionisation level Az of a receiver, solar flux units: a0 + a1 μ + a2 μ² with its modified dip latitude
/// μ in degrees, held within 0 … 400; default_ionisation_level where none is given (NeQuick-G document, effective
/// ionisation level).
double nequick_ionisation(const EffectiveIonisation& broadcast, Angle modified_dip_latitude);

/// The slant electron content from a receiver to a satellite above its horizon (European Commission, Ionospheric
/// Correction Algorithm for Galileo Single Frequency Users, issue 1.2), integrated along a straight ray over a sphere
/// of 6371.2 km; delay by ionosphere_group_delay(). The month is that of the tables.
/// @param ut_hours 0 … 24
Tecu nequick_slant_content(const NequickTables& tables, const EffectiveIonisation& broadcast, const Geodetic& receiver,
                           const Geodetic& satellite, double ut_hours);

}  // namespace skyloop::inline world
