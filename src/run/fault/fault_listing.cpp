#include "run/fault/fault_kind.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "run/fault/command.hpp"
#include "run/fault/timeline_keys.hpp"

namespace skyloop::inline run {
namespace {

bool has_limit(double limit) { return std::abs(limit) < ParameterSpec::unlimited; }

std::string limits_text(const ParameterSpec& spec) {
    if (has_limit(spec.least) && has_limit(spec.most)) return fmt::format(", {:g} to {:g}", spec.least, spec.most);
    if (has_limit(spec.least)) return fmt::format(", at least {:g}", spec.least);
    return has_limit(spec.most) ? fmt::format(", at most {:g}", spec.most) : std::string();
}

std::string type_text(const ParameterSpec& spec) {
    switch (spec.type) {
        case ParameterType::number:
            return "number" + limits_text(spec);
        case ParameterType::whole_number:
            return "whole number" + limits_text(spec);
        case ParameterType::flag:
            return "true or false";
        case ParameterType::word:
            return fmt::format("{}", fmt::join(spec.choices, ", "));
        case ParameterType::words:
            return fmt::format("list of {}", fmt::join(spec.choices, ", "));
        case ParameterType::text:
            return "text";
        case ParameterType::texts:
            return "list of texts";
        case ParameterType::numbers:
            return "list of numbers" + limits_text(spec);
    }
    return "";
}

std::string standard_text(const ParameterSpec& spec) {
    if (spec.needed) return "needed";
    if (const double* number = std::get_if<double>(&spec.standard)) return fmt::format("{:g}", *number);
    if (const bool* flag = std::get_if<bool>(&spec.standard)) return *flag ? "true" : "false";
    const auto* text = std::get_if<std::string_view>(&spec.standard);
    return text == nullptr || text->empty() ? "none" : fmt::format("\"{}\"", *text);
}

std::string parameter_table(std::span<const ParameterSpec> specs) {
    if (specs.empty()) return "";
    std::string table = "| parameter | takes | default | meaning |\n|---|---|---|---|\n";
    for (const ParameterSpec& spec : specs)
        table +=
            fmt::format("| `{}` | {} | {} | {} |\n", spec.name, type_text(spec), standard_text(spec), spec.meaning);
    return table + "\n";
}

// In the order of FaultLayer.
constexpr std::array<std::string_view, 5> layer_headings{
    "Signals: what reaches the antenna", "Solution: what the receiver believes or reports", "Receiver: how it behaves",
    "Wire: what becomes of the bytes", "Corrections: what a rover receives from its base"};

std::string idle_at(const ReceiverNeed* need) {
    return need == nullptr ? std::string() : fmt::format(" (Idle where the receiver {}.)", need->lack);
}

// What the kind cannot do.
std::string bounds_of(const FaultKind& kind, std::string_view modern) {
    return fmt::format("{}{}{}", kind.measuring_receivers_only ? fmt::format(" ({} only.)", modern) : "",
                       kind.has_strength ? "" : " (No ramps.)", idle_at(kind.need));
}

std::string kinds_markdown() {
    std::string page;
    const FaultKind* before = nullptr;
    for (const FaultKind& kind : fault_kinds()) {
        if (before == nullptr || before->layer != kind.layer)
            page += fmt::format("## {}\n\n", layer_headings[static_cast<std::size_t>(kind.layer)]);
        before = &kind;
        page += fmt::format("### {}\n\n{}{} In the world: {}\n\n{}", kind.name, kind.effect,
                            bounds_of(kind, "`modern`"), kind.cause, parameter_table(kind.parameters));
    }
    return page;
}

std::string commands_markdown() {
    std::string page = "## Commands\n\n";
    for (const CommandKind& kind : command_kinds())
        page += fmt::format("### {}\n\n{}{}{}{}\n\n{}", kind.name, kind.meaning, kind.live_only ? " Of live runs." : "",
                            kind.of_receiver ? " Takes `receiver`." : "", idle_at(kind.need),
                            parameter_table(kind.parameters));
    return page;
}

}  // namespace

std::string fault_list_text() {
    std::string text;
    const FaultKind* before = nullptr;
    for (const FaultKind& kind : fault_kinds()) {
        if (before == nullptr || before->layer != kind.layer)
            text += fmt::format("{}{}\n", before == nullptr ? "" : "\n",
                                fault_layer_names[static_cast<std::size_t>(kind.layer)]);
        before = &kind;
        text += fmt::format("  {:<24} {}\n", kind.name, kind.effect);
    }
    return text;
}

std::string fault_text(const FaultKind& kind) {
    std::string text = fmt::format("{} ({})\n  {}{}\n  In the world: {}\n", kind.name,
                                   fault_layer_names[static_cast<std::size_t>(kind.layer)], kind.effect,
                                   bounds_of(kind, "modern"), kind.cause);
    for (const ParameterSpec& spec : kind.parameters)
        text += fmt::format("  {:<24} {} ({}; default {})\n", spec.name, spec.meaning, type_text(spec),
                            standard_text(spec));
    return text;
}

std::string fault_catalogue_markdown() {
    return "# Faults and commands\n\nWritten by `skyloop faults --format markdown`; how they are used stands in "
           "[failsafe.md](failsafe.md).\n\n" +
           kinds_markdown() + commands_markdown() +
           "## Keys that every fault has besides\n\nCommands have those of them that say when they are carried "
           "out.\n\n" +
           parameter_table(timeline_keys());
}

}  // namespace skyloop::inline run
