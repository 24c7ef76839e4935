#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "detail/scenario_keys.hpp"

namespace skyloop {
namespace {

// @return where the output goes; an unchanged one, and a mistake, for a text that is no output
OutputSettings read_target(TableReader& table) {
    table.needs_one_of({"to"}, "says nowhere; expected to = \"gps-input:127.0.0.1:14550\"");
    std::string uri;
    table.text("to", uri);
    if (table.recording() || !table.has("to")) return {};
    auto settings = parse_output_uri(uri);
    if (settings) return std::move(*settings);
    table.mistake("to", settings.error().message);
    return {};
}

void read_receiver_of(TableReader& table, const Scenario& scenario, OutputSettings& output) {
    table.text("receiver", output.receiver);
    if (output.receiver.empty()) return;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        names.push_back(receiver_name(scenario, i));
    if (std::find(names.begin(), names.end(), output.receiver) == names.end())
        table.mistake("receiver", fmt::format("'{}' is no receiver of this scenario; expected one of {}",
                                              output.receiver, fmt::join(names, ", ")));
}

void refuse_foreign_keys(TableReader& table, const OutputSettings& output) {
    if (table.recording() || output.uri.empty()) return;
    for (const std::string_view key : {"system", "component", "id", "eph"})
        if (const std::string foreign = foreign_option(output.format, key); table.has(key) && !foreign.empty())
            table.mistake(key, foreign);
}

}  // namespace

void read_outputs(TableReader& top, Scenario& scenario) {
    static constexpr std::array<Word<OutputMoment>, 2> moments{
        {{output_moment_names[0], OutputMoment::report}, {output_moment_names[1], OutputMoment::epoch}}};
    static constexpr std::array<Word<HilGpsAccuracy>, 2> accuracies{
        {{hil_gps_accuracy_names[0], HilGpsAccuracy::px4_cm}, {hil_gps_accuracy_names[1], HilGpsAccuracy::dop100}}};
    constexpr NumberRange named{1, 255}, counted{0, 255};
    top.tables("output", [&](TableReader& table) {
        OutputSettings output = read_target(table);
        read_receiver_of(table, scenario, output);
        table.word("when", moments, output.when);
        table.integer("system", output.system, named);
        table.integer("component", output.component, named);
        table.integer("id", output.id, counted);
        table.word("eph", accuracies, output.eph);
        refuse_foreign_keys(table, output);
        scenario.outputs.push_back(std::move(output));
    });
}

}  // namespace skyloop
