/// Scenarios from a fuzzer's bytes: any keys that the readers know, with values of their types and within their limits,
/// as often as not at them. What reaches beyond the machine is left out: files, wires, live sources, outputs,
/// campaigns.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "fuzz_input.hpp"
#include "run/scenario/key_catalogue.hpp"

namespace skyloop {

/// A table of a scenario under construction.
struct ScenarioNode {
    const KeyTable* table = nullptr;
    std::map<std::string, std::string> values{};                  ///< by key, as TOML
    std::map<std::string, std::vector<ScenarioNode>> children{};  ///< by the last word of their path

    [[nodiscard]] std::string kind() const;
};

/// A scenario that the bytes ask for, not necessarily one that holds together.
class AnyScenario {
public:
    /// Takes what is left of the input: for each key two bytes that name it, one for the place in the lists, and those
    /// of its value.
    explicit AnyScenario(FuzzInput& input);

    [[nodiscard]] std::string toml() const;
    /// The kinds of all [[fault]].
    [[nodiscard]] std::set<std::string> faults() const;
    [[nodiscard]] bool has_commands() const { return root_.children.contains("command"); }
    /// The boards of its receivers; empty: the default one.
    [[nodiscard]] std::set<std::string> boards() const;

private:
    ScenarioNode root_;
};

}  // namespace skyloop
