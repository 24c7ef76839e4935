/// The settings of a Septentrio receiver: sets of values that its commands change and tell (mosaic-X5 reference guide,
/// firmware 4.14, sections 3.1.3 and 3.2).
///
/// What can be set on a Septentrio receiver's command line, and the words that its values are made of (Septentrio
/// mosaic-X5 reference guide, firmware 4.14, chapter 3).
///
/// Lines in what a client writes.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/bytes.hpp"
#include "firmware/core/port_id.hpp"

namespace skyloop::firmware {

/// What is set by `setNAME` and told by `getNAME`.
struct SettingGroup {
    std::string_view set, get;  ///< mnemonics of the two commands
    std::string_view name;
    std::string_view indices;    ///< each has values of its own: "COM1 COM2"; empty: there is one set of values
    std::string_view arguments;  ///< names of the values behind the index; + behind those that are lists
    std::string_view defaults;   ///< values, by commas
};
/// All that is known here.
std::span<const SettingGroup> setting_groups();
/// One of them, which must be there.
const SettingGroup& setting_group(std::string_view name);

/// Words of one kind, in the maker's spelling.
enum class WordKind {
    block,
    block_group,
    sentence,
    interval,
    port,
    line_speed,
    pvt_mode,
    rover_mode,
    level,
    motion,
    signal,
    place,  ///< of PVTMode's reference position
    datum,
    correction,  ///< message of RTCM 3, and groups of them
    on_off,
    system,  ///< and single satellites: G05, S120
    input,
    output,
    shown,
    data_bits,
    parity,
    stop_bits,
    flow_control,
    pulse_interval,
    polarity,
    time_scale,
    reset_level,
    erased_memory,
    configuration,  ///< that is copied from
    kept_configuration,
    disk,
    disk_action,
    talker
};
/// The maker's spelling of a word, whatever case the user wrote it in; nothing when there is no such word.
std::optional<std::string_view> known_word(WordKind kind, std::string_view word);
/// The blocks of a group such as Attitude, by +; empty for one of which this receiver has none.
std::string_view blocks_of_group(std::string_view group);

/// Milliseconds of an interval: 0 for OnChange, nothing for off.
std::optional<std::uint64_t> interval_ms(std::string_view interval);

/// "COM1", "USB1": how the receiver calls a port; empty for one that has no command line.
std::string_view descriptor_of(PortId port);

/// Equal but for the case of letters.
bool same_word(std::string_view a, std::string_view b);

/// What a command has led to: lines that tell the settings now, or what was wrong with it.
struct SettingAnswer {
    std::vector<std::string> states{};
    std::string error{};  ///< "SBFOutput: Argument 'Interval' is invalid!"; empty: none
};

/// State: every value. Values are in the maker's spelling where this receiver knows the words.
class SeptentrioSettings {
public:
    /// As the factory leaves it.
    SeptentrioSettings();

    /// Values of a group, in the order of its arguments. @param index of the group; empty where it has none
    [[nodiscard]] const std::vector<std::string>& values(std::string_view name, std::string_view index = {}) const;
    /// Changes what the arguments say: an empty one leaves its value, + and - before a list add to it and take away.
    /// Nothing changes where one of them is wrong.
    SettingAnswer set(const SettingGroup& group, const std::vector<std::string>& arguments);
    [[nodiscard]] SettingAnswer get(const SettingGroup& group, const std::vector<std::string>& arguments) const;

private:
    using Values = std::map<std::string, std::vector<std::string>, std::less<>>;
    [[nodiscard]] std::vector<std::string> indices_of(const SettingGroup& group, std::string_view wanted) const;

    Values values_;  ///< by "SBFOutput, Stream1"
};

/// What is wrong with the arguments of `exeCOMMAND`: "exeManageDisk: Argument 'Disk' is invalid!"; empty: nothing.
/// EraseMemory alone may be left out. @param names of the arguments, in their order
std::string wrong_argument(std::string_view command, std::initializer_list<std::string_view> names,
                           const std::vector<std::string>& arguments);

/// Parts between separators, without spaces around them.
std::vector<std::string> split_words(std::string_view text, char separator);

}  // namespace skyloop::firmware
