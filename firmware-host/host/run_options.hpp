/// The options that several subcommands share, and what they change in a scenario.
/// Options that are keys of a scenario: `--rate 5` is `--set receiver.0.rate_hz=5` under a name of its own.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "messages.hpp"
#include "run/scenario/scenario.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::host {

class KeyOptions {
public:
    /// Help, type and words are those that the key's reader declares; its range is checked with the key.
    /// @param kind of the table, where its kinds have keys of this name with other meanings
    /// @param more what the option takes besides: ", or max"
    void add(CLI::App& command, const std::string& option, const std::string& key, std::string_view kind = {},
             std::string_view more = {});
    /// A flag that gives the key a value.
    void add_flag(CLI::App& command, const std::string& option, const std::string& key, const std::string& toml,
                  const std::string& help);

    [[nodiscard]] bool given(std::string_view option) const { return !typed(option).empty(); }
    /// Empty: not given.
    [[nodiscard]] std::string_view typed(std::string_view option) const;
    /// What was given of what decides the bytes of a run, one per line.
    [[nodiscard]] std::string computing() const;
    /// What was given, in the order in which the options were added.
    [[nodiscard]] std::vector<ScenarioChange> changes() const;

private:
    struct Row {
        std::string option, key;
        bool number = false, text = false;
        std::string toml{};  // of a flag
        std::string typed{};
    };
    std::deque<Row> rows_;  // CLI11 keeps their addresses
};

/// Help, range and words of an option that sets by itself what a key sets.
void declare_as_key(CLI::Option& option, const std::string& key, std::string_view kind = {});
/// The change that an option of another syntax makes. @param toml the key's new value
ScenarioChange change_of(std::string_view option, std::string_view key, std::string toml);
/// Texts as a list of TOML.
std::string toml_list(const std::vector<std::string>& texts);

/// What was typed; empty or absent: the scenario's own.
struct RunOptions {
    std::string scenario;
    std::vector<std::string> settings;  ///< --set
    KeyOptions keys;                    ///< that are keys of the scenario as they stand
    std::string at, trajectory, board, state, scene, control;
    std::vector<std::string> nav, ports, outputs;
    std::optional<std::uint64_t> seed;
    std::string priority = "auto";  ///< run only: "auto" or "normal"
    std::string repeat;             ///< a recording to be repeated
    std::string token;              ///< run only: of --control
    std::string mavlink;            ///< run only: where MAVLink is spoken; empty: nowhere
    bool wait_for_client = false;   ///< run only: time begins when each port has a client
    std::string record;             ///< run: --record, simulate: --out
    Verbosity verbosity;
};

void add_verbosity_options(CLI::App& command, Verbosity& verbosity);
/// --set: keys of the scenario.
void add_setting_option(CLI::App& command, std::vector<std::string>& settings);
/// The scenario of a file, or of defaults where it is empty, with the settings of --set. Fails with a line for each
/// mistake in it and in what it names.
Result<Scenario> scenario_with(const std::string& file, const std::vector<std::string>& settings);
/// --at, --nav, --rebase-nav, --start: where and when.
void add_place_options(CLI::App& command, RunOptions& options);
/// --scene: what stands around.
void add_scene_option(CLI::App& command, RunOptions& options);
/// Everything that run and simulate share.
void add_run_options(CLI::App& command, RunOptions& options);

/// The scenario file, or embedded defaults, with the options laid over it.
Result<Scenario> scenario_from(const RunOptions& options);

/// What to tell of entries that wait for the vehicle's state in a run where neither MAVLink nor a command tells it;
/// nothing where there are none.
std::optional<std::string> vehicle_warning(const Scenario& scenario);

/// What to tell of commands that stop time in a run against the clock without a client who lets it go on; nothing where
/// there are none.
std::optional<std::string> pause_warning(const Scenario& scenario);

/// Reads "LAT,LON" or "LAT,LON,HEIGHT": degrees and metres above the ellipsoid. @param option for messages
Result<Geodetic> parse_place(const std::string& text, std::string_view option = "--at");
/// The place of --reference, whose height has to be told: errors up and in space would be about the ellipsoid without.
Result<Geodetic> parse_reference(const std::string& text);

}  // namespace skyloop::host
