/// The keys of each part of a scenario file, and those that board files share.
/// The keys of each part of a board file (boards/README.md).
#pragma once

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "base/geo/simulator_frames.hpp"
#include "firmware/core/board_profile.hpp"
#include "run/scenario/scenario.hpp"
#include "run/scenario/scenario_file.hpp"
#include "run/verdict/expectation.hpp"
#include "table_reader.hpp"

namespace skyloop::inline run {

/// Everything in a scenario. @param folder that paths are relative to
void read_top_keys(TableReader& top, Scenario& scenario, const std::filesystem::path& folder);

/// Changes what has been parsed; a key that leads nowhere is a mistake.
void apply_changes(toml::table& table, MistakeList& mistakes, std::span<const ScenarioChange> changes);

/// @param folder that paths are relative to
void read_modern_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder);
/// Those of the receiver, which board files have, too: oscillator, loops, search, solution.
void read_modern_receiver_keys(TableReader& modern, ModernSettings& settings);
/// Those of the world: air, antenna, interference.
void read_modern_propagation_keys(TableReader& modern, ModernSettings& settings, const std::filesystem::path& folder);
/// [model.modern.channel], and the same of [[surroundings]].
void read_channel_keys(TableReader& table, ChannelParameters& p);
/// Of [[surroundings]]: ModernPropagationParameters::stretches.
void read_surroundings(TableReader& top, Scenario& scenario, const std::filesystem::path& folder);
void read_model_keys(TableReader& model, ModelSettings& settings, const std::filesystem::path& folder);
/// Of [atmosphere]: Scenario::atmosphere and tec_maps.
void read_atmosphere_keys(TableReader& atmosphere, Scenario& scenario, const std::filesystem::path& folder);

/// Reads a list of systems, as `constellations` of a scenario's [sky] or a board's [navigation].
void read_constellation_list(TableReader& table, const char* key, std::vector<Constellation>& constellations,
                             KeyText text = {});

/// Of boards and receivers. @param limits the latter's may be nothing
template <class Limits>
void read_export_limits(TableReader& table, Limits& limits, KeyText text = {}) {
    using firmware::ExportLimits;
    table.word(
        "export_limits",
        {{"off", ExportLimits::off}, {"and", ExportLimits::both_exceeded}, {"or", ExportLimits::either_exceeded}},
        limits, text);
}

/// "CFG-RATE-MEAS" and all others.
std::vector<std::string_view> config_item_names();

/// Reads each key of the table as the value of the item that it names: a whole number within the item's bytes, a number
/// for R8, true and false or 0 and 1 for L. A name that no item has is a mistake.
/// @param others keys that are no items, and not read
/// @return raw values by the items' ids
std::map<std::uint32_t, std::uint64_t> read_config_items(TableReader& config,
                                                         std::initializer_list<std::string_view> others = {});

/// What trajectories of one file share.
struct TrajectoryContext {
    std::optional<LevelFrame> level;  ///< of [frame]
    std::filesystem::path folder;     ///< that paths are relative to
};

/// "receiver1": what messages call a receiver without a name. @param index its place in the list
std::string default_receiver_name(std::size_t index);
/// Whether `name`, which the key has, is one of these receivers'; if not, that is a mistake of the key.
bool names_receiver(TableReader& table, std::string_view key, const std::string& name,
                    std::span<const std::string> receivers);
/// Reads every [[receiver]] of a scenario's top table.
void read_receivers(TableReader& top, Scenario& scenario, const TrajectoryContext& context);

/// Reads every [[output]] of a scenario's top table, after its receivers.
void read_outputs(TableReader& top, Scenario& scenario);

/// Reads [caster] of a scenario's top table, after its receivers.
void read_caster(TableReader& top, Scenario& scenario);

/// Reads [scene]. @param folder that paths are relative to
void read_scene_keys(TableReader& table, SceneEntry& scene, const std::filesystem::path& folder);

/// "jamming", and where that is taken "jamming 2": what messages call a fault or command without a name.
/// @param before the names of those before it in the list
std::string default_entry_name(std::string_view kind, std::span<const std::string> before);
/// Reads every [[fault]] and [[command]] of a scenario's top table, after its receivers.
void read_timeline(TableReader& top, Scenario& scenario);
/// Reads every [[expect]] of a scenario's top table, after its receivers, faults and commands, which they name.
void read_expectations(TableReader& top, Scenario& scenario);

/// Reads [campaign] of a scenario's top table.
void read_campaign(TableReader& top, std::optional<CampaignSettings>& campaign);

/// Reads [frame] of a file's top table.
std::optional<LevelFrame> read_frame(TableReader& top);
/// Reads the table `trajectory` within another; nothing when it is not there.
/// @param warnings what a reader should be told is added
std::optional<TrajectorySettings> read_trajectory_keys(TableReader& parent, KeyText text,
                                                       const TrajectoryContext& context,
                                                       std::vector<std::string>& warnings);

/// All keys of a file's top table.
void read_board_keys(TableReader& top, firmware::BoardProfile& board);

/// [nmea]
void read_board_nmea(TableReader& nmea, firmware::BoardProfile& board);
/// [ubx]
void read_board_ubx(TableReader& ubx, firmware::BoardProfile& board);
/// Makes the items of CFG-MSGOUT absent whose message the board does not send: the rate of nothing. Those of a list
/// that the board names are as the list has them.
void leave_out_rates_of_others(firmware::BoardProfile& board);
/// [config]; reads it after everything that decides what a value may be.
void read_board_config(TableReader& config, firmware::BoardProfile& board);
/// `signal_conflicts` of [navigation].
void read_signal_conflicts(TableReader& navigation, firmware::BoardProfile& board);

/// The bytes that pairs of hexadecimal digits write, blanks among them left aside; nothing for any other text.
std::optional<Bytes> bytes_of_hex(std::string_view text);

}  // namespace skyloop::inline run
