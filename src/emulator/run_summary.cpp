#include "skyloop/emulator/run_summary.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "skyloop/time/utc_time.hpp"

namespace skyloop {
namespace {

using Json = nlohmann::ordered_json;

Json lateness_json(const LatenessHistogram& lateness) {
    Json bins = Json::array();
    for (std::size_t i = 0; i < lateness.counts().size(); ++i) {
        const bool last = i == LatenessHistogram::bounds_ms.size();
        bins.push_back({{"below_ms", last ? Json(nullptr) : Json(LatenessHistogram::bounds_ms[i])},
                        {"epochs", lateness.counts()[i]}});
    }
    return {{"mean_ms", lateness.mean_ms()},
            {"largest_ms", static_cast<double>(lateness.largest().count()) * 1e-6},
            {"histogram", bins}};
}

Json ports_json(const std::vector<Link>& links) {
    Json ports = Json::array();
    for (const Link& link : links) {
        const LinkCounters& c = link.counters();
        ports.push_back({{"wire", link.transport().description()},
                         {"bytes_out", c.bytes_out},
                         {"bytes_in", c.bytes_in},
                         {"bytes_unheard", c.bytes_unheard},
                         {"bytes_lost", c.bytes_lost},
                         {"bytes_garbled", c.bytes_garbled}});
    }
    return ports;
}

}  // namespace

std::string run_summary(const Scenario& scenario, const Assembly& assembly, std::string_view version) {
    const Emulator& emulator = *assembly.emulator;
    const firmware::ReceiverCounters& receiver = emulator.receiver().counters();
    const Json summary{
        {"program", "skyloop"},
        {"version", version},
        {"scenario", scenario.name},
        {"scenario_digest", assembly.digest},
        {"seed", scenario.run.seed},
        {"model", model_name(scenario.model)},
        {"board", emulator.receiver().board().name},
        {"navigation", emulator.simulation().navigation().description()},
        {"start_utc", format_utc(to_utc(assembly.start, LeapSeconds::announced()))},
        {"simulated_s", difference(emulator.now(), assembly.start).value()},
        {"epochs", emulator.counts().epochs},
        {"epochs_with_fix", emulator.counts().epochs_with_fix},
        {"messages_sent", receiver.messages_sent},
        {"messages_dropped", receiver.messages_dropped},
        {"ports", ports_json(emulator.links())},
        {"lateness", lateness_json(emulator.counts().lateness)},
        {"warnings", assembly.warnings},
    };
    return summary.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace skyloop
