/// Scenario files: TOML in, Scenario out.
/// A scenario with some of its keys changed, and what a scenario says apart from its campaign.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "run/scenario/scenario.hpp"

namespace skyloop::inline run {

/// A key with another value. Of a list of tables an entry is meant by its place, from 0 on, by its `name`, by its
/// `kind` where no other has it, or by what messages call it: "receiver.0.rate_hz", "fault.outage.for_s",
/// "receiver.receiver1.board", "fault.jamming 2.for_s". Of a list of values by its place:
/// "trajectory.at.2". A key that the file does not have is added, "receiver.0" too.
struct ScenarioChange {
    std::string key;
    CampaignValue value;
    std::string option{};   ///< that mistakes in it name: "--rate"; empty: the place of its [[campaign.parameter]]
    bool in_source = true;  ///< it is added to Scenario::source
};

/// "KEY=VALUE" of the command line: a value as TOML writes it, or a word. Fails with `usage`.
Result<ScenarioChange> parse_change(std::string_view text);

/// What was read of a scenario, up to its mistakes and beyond.
struct ScenarioReading {
    Scenario scenario;  ///< keys with a mistake keep their defaults; without a source where the file cannot be read
    std::optional<Error> mistakes;  ///< as of read_scenario()
};
/// Reads a scenario as read_scenario() does, after the changes. A mistake in a value that was changed is told at the
/// place of its [[campaign.parameter]], where there is one, and each mistake says the changes.
ScenarioReading read_with_mistakes(std::string_view text, const std::filesystem::path& file,
                                   std::span<const ScenarioChange> changes);
/// The same of a file.
ScenarioReading read_file_with_mistakes(const std::filesystem::path& file, std::span<const ScenarioChange> changes);

/// Whether a sentence about a scenario is one about a key, or about a table that holds it: of "foo.bar" it is
/// "foo.bar: is …", "'foo.bar' leads …", "foo: unknown key" and "[foo] has …".
bool speaks_of(std::string_view sentence, std::string_view key);

/// What is in a scenario, whatever its comments, order and layout.
struct ScenarioContent {
    std::string keys;  ///< a line a key, sorted: `run.duration_s = 60`; without [campaign] and run.seed
    /// Files and folders that its values name, and those of [campaign] apart from the values of its parameters; as they
    /// are written, sorted, each once.
    std::vector<std::string> files;
};
/// @param file as for read_scenario(): what it names is looked for beside it
/// Fails with `input` when the text is no TOML.
Result<ScenarioContent> scenario_content(std::string_view text, const std::filesystem::path& file);
/// The files and folders that a change names, as those of a scenario.
std::vector<std::string> files_of_change(const ScenarioChange& change, const std::filesystem::path& file);

/// The key that another name of it means in a scenario: with the places of lists, "fault.0.for_s".
/// @param text a scenario's, which has been read
std::string place_of_key(std::string_view text, std::string_view key);
/// Where a scenario says that a campaign varies a key: FILE:LINE:COLUMN; its top where it does not.
/// @param text a scenario's, which has been read
std::string place_of_parameter(std::string_view text, const std::filesystem::path& file, std::string_view key);

/// The values of a list as the command line gives it: TOML values, or words, with commas between.
/// Fails with `usage` for an empty list or entry.
Result<std::vector<CampaignValue>> parse_campaign_values(std::string_view text);

/// Reads a scenario (INTERFACE.md section 2; every key in docs/scenario.md).
/// @param text TOML
/// @param file its name, for messages; paths in the text are relative to its folder
/// Fails with `input`, or with `outside` where the only mistakes are tables of antennas that cannot be read: one line
/// per mistake, `FILE:LINE:COLUMN: what was found; what was expected`.
/// @param changes as of read_with_mistakes()
Result<Scenario> read_scenario(std::string_view text, const std::filesystem::path& file,
                               std::span<const ScenarioChange> changes = {});
Result<Scenario> read_scenario_file(const std::filesystem::path& file);

/// Reads the [trajectory] (and [frame]) of a file that holds nothing else, as `--trajectory FILE.toml` names it.
/// @param warnings what a reader should be told of it is added here
/// @param changes of its keys
Result<TrajectorySettings> read_trajectory_file(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                                std::span<const ScenarioChange> changes = {});

}  // namespace skyloop::inline run
