/// The settings of a Septentrio receiver: sets of values that its commands change and tell (mosaic-X5 reference guide,
/// firmware 4.14, sections 3.1.3 and 3.2).
#pragma once

#include <initializer_list>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware/septentrio/settings_table.hpp"

namespace skyloop::firmware {

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
