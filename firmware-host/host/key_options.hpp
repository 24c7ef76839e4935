/// Options that are keys of a scenario: `--rate 5` is `--set receiver.0.rate_hz=5` under a name of its own.
#pragma once

#include <CLI/CLI.hpp>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

#include "run/scenario/scenario_changes.hpp"

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
        bool number = false;
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

}  // namespace skyloop::host
