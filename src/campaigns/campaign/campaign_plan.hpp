/// Which runs a campaign has, and what each is known by.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "campaigns/campaign/keyed_files.hpp"
#include "run/scenario/campaign_settings.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline campaigns {

/// One run of a plan.
struct PlannedRun {
    std::uint64_t number = 0;  ///< its place in the plan, from 0 on
    std::string key;           ///< 32 hexadecimal digits; the same wherever and whenever the same run is planned
    std::uint64_t seed = 1;
    std::vector<CampaignValue> values{};  ///< of the plan's parameters, in their order
    bool operator==(const PlannedRun&) const = default;
};

/// Part `index` of `count` of a campaign: the runs whose number leaves the remainder `index`.
struct Shard {
    std::uint64_t index = 0, count = 1;
    [[nodiscard]] bool has(std::uint64_t number) const { return number % count == index; }
};
/// Reads "I/N", I from 0 to N − 1. Fails with `usage`.
Result<Shard> parse_shard(std::string_view text);

/// Puts other seeds into a campaign: "100" is their number, "5-20" the first and the last, "1,7,9" a list.
/// Fails with `usage`.
Result<void> apply_seeds(std::string_view text, CampaignSettings& campaign);
/// Gives a parameter other values, or adds it: "KEY=a,b,c". Fails with `usage`.
Result<void> apply_vary(std::string_view text, CampaignSettings& campaign);

/// What values of parameters name beside themselves: of "KEY = VALUE" the digests of its files and its board.
using ValueContents = std::map<std::string, std::string>;

/// All runs of a campaign. Every set of parameters, in the order of the design, is run with every seed: the seed
/// changes fastest, of a grid the first parameter slowest. Without seeds a design that draws gives its n-th sample the
/// n-th.
class CampaignPlan {
public:
    /// @param base campaign_base_digest()
    /// @param contents are in the keys of the runs that have these values
    /// Fails with `usage` for more than most_campaign_runs.
    static Result<CampaignPlan> make(const CampaignSettings& campaign, std::string base, ValueContents contents = {});

    [[nodiscard]] std::uint64_t size() const { return points_ * seeds_a_point_; }
    /// @param number below size()
    [[nodiscard]] PlannedRun run(std::uint64_t number) const;
    /// Keys of the parameters.
    [[nodiscard]] std::vector<std::string> parameters() const;
    [[nodiscard]] const std::vector<CampaignParameter>& varied() const { return campaign_.parameters; }
    /// Number of sets of parameters: run number n is of the set n / (size() / points()).
    [[nodiscard]] std::uint64_t points() const { return points_; }
    [[nodiscard]] const std::string& base() const { return base_; }
    /// What a run changes in the scenario, its seed among it.
    [[nodiscard]] std::vector<ScenarioChange> changes_of(const PlannedRun& run) const;

private:
    [[nodiscard]] std::uint64_t seed_of(std::uint64_t number) const;
    [[nodiscard]] std::vector<CampaignValue> values_of(std::uint64_t point) const;

    CampaignSettings campaign_;
    std::string base_;
    ValueContents contents_{};
    std::uint64_t points_ = 1, seeds_a_point_ = 1;
    bool seed_a_sample_ = false;                  // each sample has its own
    std::vector<std::vector<double>> samples_{};  // a list a parameter, of designs that draw
};

/// What all runs of a campaign have in common, as 64 hexadecimal digits of SHA-256: the program's version, what the
/// scenario says apart from [campaign] and its seed, the content of the files that it names, the digests in `more`
/// (of the boards, of cities, whether there is a geoid), and of [campaign] what decides a run's result: metrics and
/// vehicle, with the content of the programs that its command names and of the files that it loads.
struct CampaignBase {
    std::string version;
    ScenarioContent content;
    std::filesystem::path folder{};             ///< that the files' names are relative to
    std::map<std::string, std::string> more{};  ///< name and digest
};
/// @param files looks after those that are named
/// Fails with `outside` when a file cannot be read.
Result<std::string> campaign_base_digest(const CampaignBase& base, const CampaignSettings& campaign, KeyedFiles& files);

}  // namespace skyloop::inline campaigns
