#include "detail/idle_entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "run/fault/fault_kind.hpp"
#include "run/verdict/expectation_reach.hpp"

namespace skyloop::inline run {

namespace {

bool tracks_second_signals(const UsedReceiver& receiver) {
    const auto& signals = receiver.settings.signals;
    return std::any_of(signals.begin(), signals.end(), [](const SystemSignal& tracked) {
        return tracked.signal != first_signal(tracked.constellation);
    });
}

// Two signals of a satellite are combined where a receiver tracks two.
bool combines_nothing(const PlannedRun& run) {
    const ModernSettings& modern = run.scenario.model.modern;
    return !run.scenario.model.sensor_model && modern.navigation.corrections.ionosphere_free &&
           !modern.ionosphere_free_told_at.empty() &&
           std::none_of(run.receivers.begin(), run.receivers.end(), tracks_second_signals);
}

}  // namespace

std::vector<std::string> idle_key_warnings(const PlannedRun& run) {
    std::vector<std::string> warnings;
    if (combines_nothing(run))
        warnings.push_back(
            run.scenario.model.modern.ionosphere_free_told_at +
            "no receiver tracks a second signal; expected receiver.dual_frequency, or a board of two bands");
    for (std::size_t i = 0; i < run.receivers.size(); ++i) {
        const ReceiverEntry& entry = run.scenario.receivers[i];
        for (const KeyJudge& judge : entry.judges)
            for (const std::string& phrase : judge.idle(run.receivers[i], entry, run.scenario))
                warnings.push_back(fmt::format("{}{} {}", judge.told_at, run.receivers[i].board.name, phrase));
    }
    return warnings;
}

namespace {

// The regime of the errors gives all receivers that type of fix, or a fault makes this one claim it.
bool is_claimed(FixType type, std::size_t receiver, const Scenario& scenario) {
    constexpr std::array regimes{FixType::fix_3d, FixType::dgnss, FixType::rtk_float, FixType::rtk_fixed};
    const DifferentialKind regime = scenario.model.modern.navigation.differential.kind;
    if (!scenario.model.sensor_model && regimes[static_cast<std::size_t>(regime)] == type) return true;
    return std::any_of(scenario.faults.begin(), scenario.faults.end(), [&](const FaultEntry& fault) {
        const bool for_it =
            std::find(fault.receivers.begin(), fault.receivers.end(), receiver) != fault.receivers.end();
        const auto names = [&](const char* key) { return fault.parameters.text(key) == fix_type_name(type); };
        return for_it && (names("type") || names("to"));
    });
}

bool is_about(const Expectation& expectation, std::size_t receiver, const Scenario& scenario) {
    return expectation.receiver.empty() || expectation.receiver == receiver_name(scenario, receiver);
}

}  // namespace

std::vector<std::string> idle_expectation_warnings(const PlannedRun& run) {
    std::vector<std::string> warnings;
    for (const Expectation& expectation : run.scenario.expectations) {
        if (!expectation.sentence) continue;
        const SubjectClause& subject = expectation.sentence->subject;
        for (std::size_t i = 0; i < run.receivers.size(); ++i) {
            const bool claimed =
                subject.subject == ExpectedSubject::fix_type && is_claimed(subject.fix_type, i, run.scenario);
            if (claimed || !is_about(expectation, i, run.scenario)) continue;
            if (const std::string why = why_never_true(subject, run.receivers[i]); !why.empty())
                warnings.push_back(fmt::format("{}[[expect]] '{}' {}: {} {}", expectation.told_at, expectation.title(),
                                               expectation.sentence->time.never ? "shows nothing" : "cannot be met",
                                               run.receivers[i].board.name, why));
        }
    }
    return warnings;
}

namespace {

bool model_has_ionosphere(const ModelSettings& model) {
    return !model.sensor_model || model.sensor_model == ErrorModelKind::baseline ||
           model.sensor_model == ErrorModelKind::whole_path;
}

// Sensor models know the first signal of each system, whatever the receiver tracks.
bool meets(const FaultEntry& fault, const SatelliteId satellite, const UsedReceiver& receiver) {
    const Constellation system = satellite.constellation;
    if (!receiver.measures) return is_for(fault.parameters, satellite, first_signal(system));
    const auto signals = emulated_signals(system);
    return std::any_of(signals.begin(), signals.end(), [&](Signal signal) {
        return receiver.settings.tracks(system, signal) && is_for(fault.parameters, satellite, signal);
    });
}

bool meets_any(const FaultEntry& fault, const PlannedRun& run) {
    const std::vector<SatelliteId> satellites = run.navigation.satellites();
    return std::any_of(fault.receivers.begin(), fault.receivers.end(), [&](std::size_t receiver) {
        return std::any_of(satellites.begin(), satellites.end(),
                           [&](SatelliteId satellite) { return meets(fault, satellite, run.receivers[receiver]); });
    });
}

bool has_pair(const FaultEntry& fault, const Scenario& scenario) {
    return std::any_of(fault.receivers.begin(), fault.receivers.end(),
                       [&](std::size_t receiver) { return scenario.receivers.at(receiver).base.has_value(); });
}

bool lacks_clock(const FaultEntry& fault, const PlannedRun& run) {
    return fault.kind == "clock_drift" && run.mode.virtual_time;
}

// Why nothing will be seen of a fault, whatever the boards; empty: something may.
std::string why_idle_in_run(const FaultEntry& fault, const PlannedRun& run) {
    const ModelSettings& model = run.scenario.model;
    if (lacks_clock(fault, run)) return "skyloop run shows it, against the clock; in virtual time nothing does";
    if ((fault.kind == "heading_lost" || fault.kind == "heading_flipped") && !has_pair(fault, run.scenario))
        return "its receiver has no base antenna; expected 'base' of a [[receiver]]";
    if (fault.kind == "multipath_burst" && !model.sensor_model && !model.modern.errors)
        return "errors = \"none\" leaves echoes out";
    if (fault.kind == "ionospheric_storm" && !model_has_ionosphere(model))
        return fmt::format("model.name = \"{}\" has no ionosphere", model_name(model));
    if (!meets_any(fault, run)) return "no receiver tracks what it is for, as the run starts";
    return {};
}

// What comes to nothing at all receivers of a fault, for the reason of the first.
IdleParts idle_at_all(const FaultEntry& fault, const PlannedRun& run) {
    IdleParts idle;
    const FaultKind* kind = find_fault_kind(fault.kind);
    if (kind == nullptr) return idle;
    bool first = true;
    for (const std::size_t receiver : fault.receivers) {
        IdleParts here = idle_parts(*kind, fault.parameters, run.receivers[receiver]);
        if (std::exchange(first, false)) {
            idle = std::move(here);
            continue;
        }
        if (here.whole.empty()) idle.whole.clear();
        std::erase_if(idle.parts, [&](const IdlePart& part) {
            return here.whole.empty() && std::none_of(here.parts.begin(), here.parts.end(), [&](const IdlePart& other) {
                       return other.parameter == part.parameter && other.value == part.value;
                   });
        });
    }
    return idle;
}

void add_fault(const FaultEntry& fault, const PlannedRun& run, IdleEntries& found) {
    const std::string who = fmt::format("{}[[fault]] '{}'", fault.told_at, fault.when.name);
    std::string why = why_idle_in_run(fault, run);
    const IdleParts idle = idle_at_all(fault, run);
    if (why.empty()) why = idle.whole;
    if (why.empty()) {
        for (const IdlePart& part : idle.parts)
            found.warnings.push_back(fmt::format("{}: {}{} shows nothing: {}", who, part.parameter,
                                                 part.value.empty() ? "" : " '" + part.value + "'", part.why));
        return;
    }
    const std::string sentence = fmt::format("{} will show nothing: {}", who, why);
    const bool judged = !run.scenario.expectations.empty() && !fault.allow_idle;
    if (judged && !(run.mode.only_checked && lacks_clock(fault, run)))
        found.refused.push_back(sentence + ", and the run is judged; expected another fault, or allow_idle = true");
    else
        found.warnings.push_back(sentence);
}

// Empty: something comes of it.
std::string why_idle(const Command& command, const PlannedRun& run) {
    if (run.mode.virtual_time && command.source == "scenario" && is_live_only(command.verb))
        return "skyloop run does it, against the clock; in virtual time nothing does";
    const CommandKind* kind = find_command_kind(command_name(command.verb));
    if (kind == nullptr || kind->need == nullptr) return {};
    std::string why;
    for (std::size_t i = 0; i < run.receivers.size(); ++i) {
        if (!command.is_for(receiver_name(run.scenario, i))) continue;
        if (kind->need->met(run.receivers[i])) return {};
        why = fmt::format("{} {}", run.receivers[i].board.name, kind->need->lack);
    }
    return why;
}

}  // namespace

IdleEntries idle_entries(const PlannedRun& run) {
    IdleEntries found;
    for (const FaultEntry& fault : run.scenario.faults)
        add_fault(fault, run, found);
    for (const CommandEntry& command : run.scenario.commands)
        if (const std::string why = why_idle(command.command, run); !why.empty())
            found.warnings.push_back(
                fmt::format("{}[[command]] '{}' will do nothing: {}", command.told_at, command.when.name, why));
    return found;
}

}  // namespace skyloop::inline run
