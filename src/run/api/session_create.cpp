// How a led run begins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/time/utc_time.hpp"
#include "detail/data_place.hpp"
#include "detail/session.hpp"
#include "run/client/open_client.hpp"
#include "run/emulator/assembly.hpp"
#include "run/emulator/wires.hpp"
#include "run/scenario/scenario_file.hpp"

namespace skyloop::inline run {
namespace {

constexpr std::uint32_t known_overrides = SKY_CREATE_SEED | SKY_CREATE_ORIGIN;

Answer<void> check_info(const sky_create_info& info) {
    if (info.abi_major != SKY_ABI_MAJOR)
        return refuse(SKY_E_UNSUPPORTED,
                      fmt::format("abi_major is {}; this library is {}", info.abi_major, SKY_ABI_MAJOR));
    if ((info.set & ~known_overrides) != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("set is {:#x}, of which {:#x} is not known to this version",
                                                     info.set, info.set & ~known_overrides));
    if (info.reserved != 0)
        return refuse(SKY_E_UNSUPPORTED, fmt::format("reserved is {:#x}; expected 0", info.reserved));
    return {};
}

Result<Scenario> scenario_of(const sky_create_info& info) {
    if (info.scenario_text != nullptr)
        return read_scenario(info.scenario_text, info.scenario_file != nullptr ? info.scenario_file : "scenario_text");
    if (info.scenario_file != nullptr) return read_scenario_file(info.scenario_file);
    return Scenario{};
}

Answer<void> apply_start(const char* start, RunSettings& run) {
    if (start == nullptr) return {};
    run.start_now = std::string_view(start) == "now";
    run.start.reset();
    if (run.start_now) return {};
    const auto utc = parse_instant(start);
    if (!utc) return refuse(SKY_E_PARSE, "start_utc: " + utc.error().message + ", or now");
    run.start = to_gps_time(*utc, LeapSeconds::announced());
    return {};
}

GpsTime wall_clock_gps() {
    using namespace std::chrono;
    return from_posix(duration_cast<Nanoseconds>(system_clock::now().time_since_epoch()), LeapSeconds::announced());
}

// Nothing: what the scenario says.
Answer<std::optional<Geodetic>> origin_of(const sky_create_info& info) {
    if ((info.set & SKY_CREATE_ORIGIN) == 0) return std::nullopt;
    const auto place = place_from_degrees(info.origin_lla[0], info.origin_lla[1], info.origin_lla[2]);
    if (!place) return refuse(SKY_E_RANGE, "origin_lla: " + place.error());
    return std::optional(*place);
}

// The one that the sources of the first receiver's vehicle would have, else where that vehicle begins.
Geodetic origin_of_scenario(const Scenario& scenario, const Geodetic& begins) {
    const auto* live = std::get_if<LiveSettings>(&trajectory_of(scenario, 0));
    return live != nullptr ? live->origin.value_or(begins) : begins;
}

// What a scenario asks for beside its receivers, and a program that leads the run does itself.
std::vector<std::string> left_out(const Scenario& scenario) {
    std::vector<std::string> sentences;
    if (!scenario.expectations.empty())
        sentences.emplace_back("[[expect]]: a led run is not judged; skyloop simulate does that");
    if (!scenario.outputs.empty())
        sentences.emplace_back("[[output]]: a led run tells other programs nothing; skyloop run does that");
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i)
        if (const auto* live = std::get_if<LiveSettings>(&trajectory_of(scenario, i)))
            sentences.push_back(
                fmt::format("{}nobody listens to {} in a led run; sky_set_truth() says where the "
                            "vehicle is",
                            live->source_told_at, live->source));
    // Receivers on one vehicle have one source.
    sentences.erase(std::unique(sentences.begin(), sentences.end()), sentences.end());
    return sentences;
}

}  // namespace

Answer<std::unique_ptr<Session>> Session::create(const sky_create_info& info) {
    if (const auto checked = check_info(info); !checked) return refuse(checked.error());
    std::unique_ptr<Session> session(new Session(info));
    if (const auto read = session->read_scenario_of(info); !read) return refuse(read.error());
    if (const auto ready = session->assemble_run(info); !ready) return refuse(ready.error());
    return session;
}

Answer<void> Session::read_scenario_of(const sky_create_info& info) {
    auto scenario = scenario_of(info);
    if (!scenario) return refuse(scenario.error());
    scenario_ = std::move(*scenario);
    // Judged and ended is a run by its program; a led one by its caller.
    for (std::string& sentence : left_out(scenario_))
        scenario_.warnings.push_back(std::move(sentence));
    scenario_.run.duration.reset();
    // No threads but those that are asked for: the caller's process may fork, and has its own idea of the processors.
    scenario_.scene.threads = scenario_.scene.threads.value_or(0);
    if ((info.set & SKY_CREATE_SEED) != 0) scenario_.run.seed = info.seed;
    if (const auto applied = apply_start(info.start_utc, scenario_.run); !applied) return applied;
    start_sim_ns_ = info.start_sim_ns;
    return {};
}

Embedding Session::embedding() {
    Embedding embedding;
    embedding.open_wire = [this](std::size_t receiver, const WireRequest& wire) -> std::unique_ptr<Transport> {
        if (client_of_uri(wire.uri)) return nullptr;  // lives in simulated time, inside the run
        auto led = std::make_unique<LedPort>(std::string(firmware::port_names[static_cast<std::size_t>(wire.port)]));
        ports_.push_back({receiver, wire.port, led.get()});
        return led;
    };
    embedding.obstacles = [this](std::size_t receiver) {
        return std::make_unique<ToldObstacles>(obstacles_.at(receiver));
    };
    return embedding;
}

Answer<void> Session::assemble_run(const sky_create_info& info) {
    const auto origin = origin_of(info);
    if (!origin) return refuse(origin.error());
    for (std::size_t i = 0; i < scenario_.receivers.size(); ++i)
        obstacles_.push_back(std::make_shared<ToldPaths>());
    const Embedding parts = embedding();
    RunMode mode;
    mode.virtual_time = true;
    mode.now = wall_clock_gps();
    if (info.record_dir != nullptr) mode.record = info.record_dir;
    mode.live_commands = &commands_;
    mode.embedding = &parts;
    auto assembly = assemble(scenario_, library_data_folders(info.data_dir), mode);
    if (!assembly) return refuse(assembly.error());
    assembly_ = std::move(*assembly);
    Emulator& emulator = *assembly_.emulator;
    for (const Port& port : ports_)
        port.led->tell_time(assembly_.start);
    local_ = std::make_unique<LocalFrame>(origin->value_or(origin_of_scenario(scenario_, assembly_.place)));
    StatusSources sources;
    sources.pace = [] { return PaceStatus{false, 1, true}; };
    sources.strength = [&emulator](std::string_view fault, int occurrence, GpsTime time) {
        return emulator.director().strength(fault, occurrence, time, emulator.stations());
    };
    watcher_ = std::make_unique<RunWatcher>(StatusSetup{scenario_.name, assembly_.start, std::nullopt, {}},
                                            emulator.stations(), std::move(sources));
    emulator.add_observer(watcher_.get());
    // From here on nothing is refused.
    if (const auto begun = emulator.begin(); !begun) return refuse(begun.error());
    begun_ = true;
    for (const std::string& detail : assembly_.details)
        log(SKY_LOG_DETAIL, detail);
    for (const std::string& warning : assembly_.warnings)
        log(SKY_LOG_WARNING, warning);
    summarise(SummaryOf::beginning);
    return {};
}

void Session::summarise(SummaryOf what) {
    if (Recorder* recorder = assembly_.emulator->recorder())
        recorder->record_summary(run_summary(scenario_, assembly_, SKYLOOP_VERSION, what));
}

Session::~Session() {
    if (!begun_) return;  // nobody has had it, and there is nothing to sum up
    assembly_.emulator->finish();
    summarise(SummaryOf::end);
    // Most of a recording is written here, and nobody is left who could ask how it went.
    for (const Station& station : assembly_.emulator->stations())
        if (station.recorder() != nullptr && station.recorder()->failure())
            log(SKY_LOG_ERROR, station.recorder()->failure()->message);
}

}  // namespace skyloop::inline run
