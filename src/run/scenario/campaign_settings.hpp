/// What [campaign] of a scenario says: many runs of it, over seeds and parameters.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/core/units.hpp"

namespace skyloop::inline run {

/// More runs than this are refused: their plan is held in memory.
inline constexpr std::uint64_t most_campaign_runs = 1'000'000;

/// A value that a key takes in a run.
struct CampaignValue {
    std::string toml;   ///< as TOML writes it: `"town"`, `1.5`, `[1, 2]`
    std::string shown;  ///< for people and tables: a text without its quotation marks
    bool operator==(const CampaignValue&) const = default;
};
CampaignValue campaign_value(double number);
CampaignValue campaign_value(std::int64_t number);
CampaignValue quoted_value(std::string_view text);
/// The same for values that are one to a scenario: 2 and 2.0.
std::string sense_of(const CampaignValue& value);

struct UniformSpread {
    double least = 0, most = 1;
};
/// The logarithm is uniform.
struct LogUniformSpread {
    double least = 1, most = 10;  ///< above 0
};
struct NormalSpread {
    double mean = 0, deviation = 1;  ///< the latter above 0
};
/// Whole numbers, each alike; both ends belong to it.
struct WholeSpread {
    std::int64_t least = 0, most = 1;
};
using CampaignSpread =
    std::variant<std::vector<CampaignValue>, UniformSpread, LogUniformSpread, NormalSpread, WholeSpread>;

/// A key that differs from run to run.
struct CampaignParameter {
    std::string key;  ///< with dots, as apply_changes() finds it: "model.baseline.scale", "fault.outage.for_s"
    CampaignSpread spread{};
};

/// How the parameters' values meet.
enum class CampaignDesign {
    grid,            ///< each with each
    random,          ///< each drawn by itself
    latin_hypercube  ///< of each one the range in as many strata as there are samples, one sample in each
};

/// A program that is the device under test of a run in real time.
struct CampaignVehicle {
    std::string command;               ///< for /bin/sh; {pty}, {seed} and {number} are replaced
    std::vector<std::string> files{};  ///< what it loads; relative to the scenario
    Seconds timeout{0};                ///< since its start; 0: the length of the run and ten seconds more
};

struct CampaignSettings {
    std::string name{};            ///< empty: the scenario file's
    std::uint64_t seed_count = 0;  ///< from first_seed on; 0: not given
    std::uint64_t first_seed = 1;
    std::vector<std::uint64_t> seed_list{};  ///< instead of a count; each once
    CampaignDesign design = CampaignDesign::grid;
    std::uint64_t samples = 0;  ///< of designs that draw
    std::uint64_t design_seed = 1;
    std::vector<CampaignParameter> parameters{};
    std::vector<std::string> metrics{};  ///< names; empty: all
    std::string metrics_told_at{};       ///< "FILE:LINE:COLUMN: KEY: ", for messages
    std::optional<CampaignVehicle> vehicle{};
};

}  // namespace skyloop::inline run
