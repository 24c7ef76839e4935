/// The modern profile as a scenario sets it: the world's numbers, the receiver's, and the presets of both.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "receiver/measurement/measurement_parameters.hpp"
#include "receiver/pvt/navigation_parameters.hpp"
#include "world/propagation/modern_parameters.hpp"
#include "world/propagation/surroundings.hpp"

namespace skyloop::inline run {

/// Receivers that the profile was calibrated to (README, validation).
enum class ModernPreset {
    survey,    ///< a geodetic receiver under an open sky
    consumer,  ///< a u-blox 6 to M8 with a patch antenna
    phone,     ///< a telephone's receiver and antenna
};
inline constexpr std::string_view modern_preset_names[] = {"survey", "consumer", "phone"};

/// Every number of the modern profile. One that is made by itself has no preset's numbers: take it from of().
struct ModernSettings {
    ModernPreset preset = ModernPreset::consumer;
    Surroundings surroundings = Surroundings::open_sky;
    bool car = false;    ///< the antenna is in a car, below its roof
    bool errors = true;  ///< false: geometry and clocks of satellites only, every error and delay off, no filter
    ModernPropagationParameters propagation;
    MeasurementParameters measurement;
    NavigationParameters navigation;
    std::optional<IonosphereCorrection> ionosphere_correction;    ///< nothing: Klobuchar's when there is an ionosphere
    std::optional<TroposphereCorrection> troposphere_correction;  ///< nothing: Niell's when there is a troposphere
    std::optional<Seconds> ephemeris_collection;  ///< nothing: what the search leaves of the board's warm start
    std::filesystem::path ionosphere_maps;        ///< IONEX file; empty: none
    std::vector<std::filesystem::path> tables{};  ///< files that `propagation` was read from
    std::string given{};                          ///< what the scenario says of all of it, as TOML; empty: nothing
    std::vector<std::string> idle_keys;     ///< what a reader should be told of keys that were given and cannot act
    std::string ionosphere_free_told_at{};  ///< "FILE:LINE:COLUMN: KEY: "; empty: the key is not there

    /// The numbers of a preset in surroundings.
    static ModernSettings of(ModernPreset preset, Surroundings surroundings = Surroundings::open_sky);
};

/// The settings with the receiver of a board: the preset's numbers of the receiver, over them the board's, and over
/// those what the scenario says itself.
/// @param board_keys BoardProfile::modern; empty: the settings as they are
ModernSettings with_board(const ModernSettings& settings, const std::string& board_keys);

/// A cause of error by its name in scenario files.
struct NamedTerm {
    std::string_view name;
    ErrorTerm* term = nullptr;
    std::string_view meaning{};  ///< for people
};
/// Every cause that can be switched, scaled and seeded by itself.
std::vector<NamedTerm> error_terms(ModernSettings& settings);

/// The settings as they act: `errors = false` switches every term off, and the receiver corrects only for what there
/// is.
ModernSettings effective(ModernSettings settings);

}  // namespace skyloop::inline run
