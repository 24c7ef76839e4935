#include "run/fault/command_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "base/core/letter_case.hpp"
#include "firmware/septentrio/settings_table.hpp"

namespace skyloop {
namespace {

struct CommandName {
    std::string_view mnemonic;
    std::string whole;
    bool sets = false;
};

constexpr std::string_view attention_command = "SSSSSSSSSS";

// Chapter 3 of the mosaic-X5 reference guide, as far as boards know it.
std::vector<CommandName> make_command_names() {
    std::vector<CommandName> names{{"gecm", "getEchoMessage"},
                                   {"eecm", "exeEchoMessage"},
                                   {"grc", "getReceiverCapabilities"},
                                   {"gri", "getReceiverInterface"},
                                   {"lif", "lstInternalFile"},
                                   {"login", "LogIn"},
                                   {"logout", "LogOut"},
                                   {"eccf", "exeCopyConfigFile", true},
                                   {"emd", "exeManageDisk"},
                                   {"erst", "exeResetReceiver"}};
    names.push_back({attention_command, std::string(attention_command)});
    for (const firmware::SettingGroup& group : firmware::setting_groups()) {
        names.push_back({group.set, fmt::format("set{}", group.name), true});
        names.push_back({group.get, fmt::format("get{}", group.name)});
    }
    return names;
}

const std::vector<CommandName>& command_names() {
    static const std::vector<CommandName> names = make_command_names();
    return names;
}

const CommandName* find_command_name(std::string_view word) {
    const auto& names = command_names();
    const auto found = std::find_if(names.begin(), names.end(), [word](const CommandName& name) {
        return firmware::same_word(name.mnemonic, word) || firmware::same_word(name.whole, word);
    });
    return found == names.end() ? nullptr : &*found;
}

}  // namespace

std::optional<std::string_view> command_mnemonic(std::string_view word) {
    const CommandName* name = find_command_name(word);
    return name == nullptr ? std::nullopt : std::optional(name->mnemonic);
}

std::optional<std::string> command_line_name(std::string_view line) {
    constexpr std::string_view blank = " \t";
    const std::size_t begin = line.find_first_not_of(blank);
    if (begin == std::string_view::npos || line[begin] == '#') return std::nullopt;
    const std::string_view text = line.substr(begin);
    const std::string_view word = text.substr(0, text.find_first_of(", \t"));
    if (word.size() >= attention_command.size() && word.find_first_not_of('S') == std::string_view::npos)
        return std::string(attention_command);
    return std::string(command_mnemonic(word).value_or(word));
}

bool begins_some_command(std::string_view prefix) {
    const auto& names = command_names();
    return std::any_of(names.begin(), names.end(),
                       [prefix](const CommandName& name) { return upper_case(name.mnemonic).starts_with(prefix); });
}

bool is_setting_command(std::string_view mnemonic) {
    const CommandName* name = find_command_name(mnemonic);
    return name != nullptr && name->sets;
}

}  // namespace skyloop
