#include "base/core/json.hpp"
#include "run/emulator/assembly.hpp"

#include <fmt/format.h>

#include "base/time/utc_time.hpp"

namespace skyloop::inline run {
namespace {

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

Json corrections_json(const CorrectionsWire& wire) {
    const NtripClientCounts counts = wire.counts();
    return {{"connected", counts.connected}, {"ntrip_version", counts.version}, {"connections", counts.connections},
            {"messages", wire.messages()},   {"bytes", counts.bytes},           {"bytes_lost", counts.bytes_lost},
            {"age_s", counts.age_s}};
}

Json caster_json(const CasterSummary& caster) {
    return {{"address", caster.description},    {"clients", caster.counts.clients}, {"served", caster.counts.served},
            {"refused", caster.counts.refused}, {"slow", caster.counts.slow},       {"bytes", caster.counts.bytes}};
}

Json ports_json(const std::vector<Wire>& wires) {
    Json ports = Json::array();
    for (const Wire& wire : wires) {
        const LinkCounters& c = wire.link.counters();
        ports.push_back({{"wire", wire.link.transport().description()},
                         {"port", firmware::port_names[static_cast<std::size_t>(wire.port)]},
                         {"bytes_out", c.bytes_out},
                         {"bytes_in", c.bytes_in},
                         {"bytes_unheard", c.bytes_unheard},
                         {"bytes_lost", c.bytes_lost},
                         {"bytes_garbled", c.bytes_garbled}});
        if (wire.corrections != nullptr) ports.back()["corrections"] = corrections_json(*wire.corrections);
    }
    return ports;
}

Json scene_json(const LoadedScene& loaded) {
    const SceneStatistics& s = loaded.scene->statistics();
    return {{"description", loaded.description},
            {"digest", fmt::format("{:016x}", loaded.digest)},
            {"triangles", s.triangles},
            {"planes", s.planes},
            {"memory_bytes", s.memory}};
}

// What the search for paths counted.
Json rays_json(const RayTracedScene& city) {
    const PathSearchCounters& c = city.counters();
    Json rays{{"epochs", c.epochs},
              {"rays", c.rays},
              {"rays_per_epoch", c.epochs > 0 ? static_cast<double>(c.rays) / static_cast<double>(c.epochs) : 0},
              {"segments", c.segments},
              {"candidates", c.candidates},
              {"accepted", c.accepted}};
    if (city.notice()) rays["notice"] = *city.notice();
    return rays;
}

// What the system gave a loop in real time.
Json grants_json(const DeadlineGrants& grants) {
    return {{"priority", to_string(grants.priority)},
            {"memory_locked", grants.memory_locked},
            {"timer_slack_ns", grants.timer_slack_ns},
            {"missing", grants.missing}};
}

Json power_json(const PowerSwitch& power) {
    const PowerCounts counts = power.counts();
    return {{"actuator", power.name()},    {"description", power.description()}, {"cuts", counts.cuts},
            {"restores", counts.restores}, {"failures", counts.failures},        {"slowest_ms", counts.slowest_ms}};
}

// What flew the vehicles.
Json feeds_json(const LiveFeeds& feeds) {
    Json all = Json::array();
    for (const FeedReport& r : feeds.reports())
        all.push_back({{"source", r.description},
                       {"clock", r.clock},
                       {"messages", r.counts.messages},
                       {"bytes", r.counts.bytes},
                       {"samples", r.counts.samples},
                       {"refused", r.counts.refused + r.paths.refused},
                       {"strangers", r.counts.strangers},
                       {"overflowed", r.counts.overflowed},
                       {"dropped_by_kernel", r.counts.dropped_by_kernel},
                       {"lost", r.counts.lost},
                       {"restarts", r.counts.restarts},
                       {"late", r.paths.late},
                       {"jumps", r.paths.jumps},
                       {"coasts", r.paths.coasts},
                       {"holds", r.paths.holds},
                       {"rate", r.rate ? Json(*r.rate) : Json(nullptr)},
                       {"age_mean_ms", r.age.epochs > 0 ? r.age.sum_ms / static_cast<double>(r.age.epochs) : 0},
                       {"age_largest_ms", r.age.largest_ms}});
    return all;
}

Json outputs_json(const std::vector<OutputSummary>& outputs) {
    Json list = Json::array();
    for (const auto& [description, counts] : outputs)
        list.push_back({{"output", description},
                        {"messages", counts.sent.messages},
                        {"bytes", counts.sent.bytes},
                        {"unheard", counts.sent.unheard},
                        {"lost", counts.sent.lost},
                        {"left_out", counts.left_out}});
    return list;
}

// What one receiver counted; the first one's stands at the top of the file.
void add_counts(Json& summary, const Station& station) {
    summary["epochs"] = station.counts().epochs;
    summary["epochs_with_fix"] = station.counts().epochs_with_fix;
    summary["messages_sent"] = station.messages_sent();
    summary["messages_dropped"] = station.messages_dropped();
    summary["ports"] = ports_json(station.wires());
    if (station.power() != nullptr) summary["power"] = power_json(*station.power());
    if (const RayTracedScene* city = station.simulation().city()) summary["path_search"] = rays_json(*city);
    summary["lateness"] = lateness_json(station.counts().lateness);
}

Json receivers_json(const Emulator& emulator) {
    Json receivers = Json::array();
    for (const Station& station : emulator.stations()) {
        Json one{{"name", station.name()}, {"board", station.receiver().board().name}};
        if (station.recorder()) one["folder"] = station.recorder()->folder().string();
        add_counts(one, station);
        receivers.push_back(std::move(one));
    }
    return receivers;
}

}  // namespace

std::string run_summary(const Scenario& scenario, const Assembly& assembly, std::string_view version, SummaryOf what) {
    const Emulator& emulator = *assembly.emulator;
    Json summary{
        {"program", "skyloop"},
        {"version", version},
        {"scenario", scenario.name},
        {"scenario_digest", assembly.digest},
        {"seed", scenario.run.seed},
        {"model", model_name(scenario.model)},
        {"board", emulator.receiver().board().name},
        {"navigation", emulator.simulation().navigation().description()},
        {"start_utc", utc_text(assembly.start, 3)},
        {"start_gps_ns", assembly.start.time_since_epoch().count()},
        {"ended", what != SummaryOf::beginning},
        {"cut", what == SummaryOf::cut_end},
        {"simulated_s", difference(emulator.now(), assembly.start).value()},
    };
    if (assembly.scene.scene) summary["scene"] = scene_json(assembly.scene);
    add_counts(summary, emulator.first());
    if (emulator.feeds() != nullptr) summary["feeds"] = feeds_json(*emulator.feeds());
    if (!assembly.outputs.empty()) summary["outputs"] = outputs_json(assembly.outputs);
    if (assembly.caster) summary["caster"] = caster_json(*assembly.caster);
    if (assembly.deadlines) summary["real_time"] = grants_json(*assembly.deadlines);
    summary["warnings"] = assembly.warnings;
    if (emulator.stations().size() > 1) summary["receivers"] = receivers_json(emulator);
    return json_text(summary, 2) + "\n";
}

}  // namespace skyloop::inline run
