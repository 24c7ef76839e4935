// One run of a campaign, and its figures.
#include "campaigns/campaign/campaign_run.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/words.hpp"
#include "base/geo/local_frame.hpp"
#include "detail/vehicle_run.hpp"
#include "run/emulator/load_track.hpp"
#include "run/emulator/wires.hpp"
#include "run/fault/run_observer.hpp"
#include "run/verdict/judge.hpp"
#include "study/analysis/statistics.hpp"

namespace skyloop::inline campaigns {

namespace {

// Names of all figures, units in them, in the order of tables.
constexpr std::array<std::string_view, 15> metric_names{
    "epochs",
    "fix_share",
    "time_to_first_fix_s",
    "outages",
    "longest_outage_s",
    "horizontal_error_p50_m",
    "horizontal_error_p95_m",
    "horizontal_error_max_m",
    "vertical_error_p50_m",
    "vertical_error_p95_m",
    "vertical_error_max_m",
    "satellites_used_mean",
    "satellites_visible_mean",
    "hdop_mean",
    "cn0_mean_dbhz",
};

// Watches the solutions of the first receiver, as fixes.csv holds them. State: two numbers an epoch with a fix.
class RunMetrics : public RunObserver {
public:
    explicit RunMetrics(GpsTime start) : start_(start) {}
    void on_epoch(const EpochSeen& seen) override;
    /// In the order of metric_names. Nothing where there is none, such as errors of a run without a fix.
    [[nodiscard]] std::vector<std::optional<double>> values() const;

private:
    struct Sum {
        double sum = 0;
        std::uint64_t count = 0;
        void add(double value) { sum += value, ++count; }
        [[nodiscard]] std::optional<double> mean() const {
            return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
        }
    };
    void follow_fix(GpsTime now, bool has_fix);

    GpsTime start_;
    std::uint64_t epochs_ = 0, outages_ = 0;
    std::vector<double> horizontal_, vertical_;  // m
    std::optional<GpsTime> first_fix_, lost_at_, last_epoch_;
    Seconds longest_outage_{0};
    Sum used_, visible_, hdop_, cn0_;
};

void append_errors(std::vector<std::optional<double>>& values, std::span<const double> errors) {
    const auto statistics = sample_statistics(errors);
    if (!statistics) return values.resize(values.size() + 3);
    values.insert(values.end(), {statistics->median, statistics->p95, statistics->max});
}

void RunMetrics::follow_fix(GpsTime now, bool has_fix) {
    if (has_fix && !first_fix_) first_fix_ = now;
    if (!has_fix && first_fix_ && !lost_at_) lost_at_ = now, ++outages_;
    if (lost_at_) longest_outage_ = std::max(longest_outage_, difference(now, *lost_at_));
    if (has_fix) lost_at_.reset();
    last_epoch_ = now;
}

void RunMetrics::on_epoch(const EpochSeen& seen) {
    if (seen.station != 0) return;
    const Fix& fix = seen.trace.epoch.fix;
    ++epochs_;
    follow_fix(seen.now, fix.has_position());
    visible_.add(static_cast<double>(seen.trace.sky.satellites.size()));
    for (const SatelliteStatus& satellite : fix.satellites)
        if (satellite.cn0) cn0_.add(satellite.cn0->value());
    if (!fix.has_position()) return;
    const auto error = LocalFrame(seen.trace.truth.geodetic).to_enu(to_ecef(fix.position)).vector();
    horizontal_.push_back(std::hypot(error.x(), error.y()));
    vertical_.push_back(std::abs(error.z()));
    used_.add(fix.satellites_used());
    hdop_.add(fix.dop.hdop);
}

std::vector<std::optional<double>> RunMetrics::values() const {
    std::vector<std::optional<double>> values{static_cast<double>(epochs_)};
    const auto fixes = static_cast<double>(horizontal_.size());
    values.push_back(epochs_ > 0 ? std::optional(fixes / static_cast<double>(epochs_)) : std::nullopt);
    values.push_back(first_fix_ ? std::optional(difference(*first_fix_, start_).value()) : std::nullopt);
    values.emplace_back(static_cast<double>(outages_));
    values.emplace_back(longest_outage_.value());
    append_errors(values, horizontal_);
    append_errors(values, vertical_);
    for (const Sum* sum : {&used_, &visible_, &hdop_, &cn0_})
        values.push_back(sum->mean());
    return values;
}

bool starts_now(const Scenario& scenario) {
    if (scenario.run.start) return false;
    return scenario.run.start_now || scenario.sky.rebase_navigation || scenario.sky.navigation.empty();
}

// As it stands at the head of a column: on one line, and unlike those before it.
void add_title(std::vector<std::string>& titles, std::string first) {
    std::replace_if(
        first.begin(), first.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    std::string title = first;
    for (int n = 2; std::find(titles.begin(), titles.end(), title) != titles.end(); ++n)
        title = fmt::format("{} ({})", first, n);
    titles.push_back(std::move(title));
}

std::vector<std::string> unique_titles(const Scenario& scenario) {
    std::vector<std::string> titles;
    for (const Expectation& expectation : scenario.expectations)
        add_title(titles, expectation.title());
    if (scenario.campaign && scenario.campaign->vehicle) add_title(titles, "vehicle");
    return titles;
}

// All values of a run, and those of them that the campaign keeps.
std::vector<std::optional<double>> kept_metrics(const RunMetrics& metrics, const std::vector<std::string>& names) {
    const auto values = metrics.values();
    std::vector<std::optional<double>> kept;
    for (const std::string& name : names)
        kept.push_back(
            values.at(static_cast<std::size_t>(std::ranges::find(metric_names, name) - metric_names.begin())));
    return kept;
}

RunResult begun_result(const CampaignRunSetup& setup, const PlannedRun& run) {
    RunResult result{run.key, run.number, run.seed, "error", {}, {}, {}, {}};
    for (const CampaignValue& value : run.values)
        result.parameters.push_back(value.shown);
    result.metrics.resize(setup.columns.metrics.size());
    result.verdicts.resize(setup.columns.verdicts.size());
    return result;
}

// A mistake of the scenario is the same every time.
Result<RunResult> failed_result(RunResult result, const Error& error) {
    if (error.code == ErrorCode::outside) return fail(error);
    result.error = error.message;
    return result;
}

void take_verdicts(RunResult& result, const std::vector<Verdict>& verdicts) {
    if (verdicts.size() != result.verdicts.size()) {
        result.error = fmt::format("the run has {} verdicts; expected {}, as the scenario without changes",
                                   verdicts.size(), result.verdicts.size());
        std::fill(result.metrics.begin(), result.metrics.end(), std::nullopt);
        return;
    }
    for (std::size_t i = 0; i < verdicts.size(); ++i)
        result.verdicts[i] = {std::string(outcome_name(verdicts[i].outcome)), verdicts[i].evidence};
    result.status = is_success(verdicts) ? "passed" : "failed";
}

}  // namespace

Result<Scenario> campaign_scenario(const Scenario& asked) {
    Scenario scenario = asked;
    if (starts_now(scenario))
        return fail(ErrorCode::usage, fmt::format("{}: the run would begin now, each at another time; expected "
                                                  "run.start, or navigation data that is not moved",
                                                  scenario.name));
    if (scenario.sky.automatic_navigation)
        return fail(ErrorCode::usage,
                    told_place(scenario, "sky.navigation", scenario.name) +
                        "\"auto\" is what the cache of a machine holds; expected the path of the file, "
                        "which skyloop fetch-nav prints");
    if (!scenario.run.duration && !ends_with_its_path(scenario))
        return fail(ErrorCode::usage, fmt::format("{}: the run has no end; expected run.duration_s, or a trajectory "
                                                  "with end = \"stop\"",
                                                  scenario.name));
    const bool vehicle = scenario.campaign && scenario.campaign->vehicle;
    for (std::size_t i = 0; i < scenario.receivers.size(); ++i) {
        if (!scenario.receivers[i].state_file.empty())
            return fail(ErrorCode::usage, fmt::format("{}: {} keeps its memory in {}, which runs of a campaign would "
                                                      "share; expected no state file",
                                                      scenario.name, receiver_name(scenario, i),
                                                      scenario.receivers[i].state_file.string()));
        scenario.receivers[i].power.clear();
    }
    keep_scripted_clients(scenario);
    if (vehicle) scenario.receivers.front().ports = {"pty"};
    if (vehicle && scenario.run.speed != 1)
        return fail(ErrorCode::usage, fmt::format("{}: run.speed is {}; a vehicle lives in real time, expected 1",
                                                  scenario.name, scenario.run.speed));
    scenario.outputs.clear();
    return scenario;
}

RunMode campaign_mode(const Scenario& scenario) {
    RunMode mode;
    mode.virtual_time = !(scenario.campaign && scenario.campaign->vehicle);
    return mode;
}

Result<ResultColumns> result_columns(const Scenario& scenario, const std::vector<std::string>& parameters) {
    ResultColumns columns{parameters, {}, unique_titles(scenario)};
    const CampaignSettings campaign = scenario.campaign.value_or(CampaignSettings{});
    for (const std::string& name : campaign.metrics) {
        if (std::ranges::find(metric_names, name) == metric_names.end())
            return fail(ErrorCode::usage,
                        fmt::format("{}'{}' is no metric; expected some of {}{}", campaign.metrics_told_at, name,
                                    fmt::join(metric_names, " "), did_you_mean(name, metric_names)));
        if (std::find(columns.metrics.begin(), columns.metrics.end(), name) != columns.metrics.end())
            return fail(ErrorCode::usage,
                        fmt::format("{}'{}' is there twice; expected it once", campaign.metrics_told_at, name));
        columns.metrics.push_back(name);
    }
    if (campaign.metrics.empty()) columns.metrics.assign(metric_names.begin(), metric_names.end());
    return columns;
}

Result<RunResult> run_of_campaign(const CampaignRunSetup& setup, const PlannedRun& run,
                                  const std::vector<ScenarioChange>& changes, const std::atomic<bool>& stop) {
    RunResult result = begun_result(setup, run);
    const auto asked = read_scenario(setup.text, setup.file, changes);
    if (!asked) return failed_result(std::move(result), asked.error());
    const auto scenario = campaign_scenario(*asked);
    if (!scenario) return failed_result(std::move(result), scenario.error());
    auto assembly = assemble(*scenario, setup.data, campaign_mode(*scenario));
    if (!assembly) return failed_result(std::move(result), assembly.error());
    Emulator& emulator = *assembly->emulator;
    const bool live = !campaign_mode(*scenario).virtual_time;
    Judge judge(scenario->expectations,
                {assembly->start, receiver_names(emulator), live, probe_environment(emulator), setup.orphans});
    RunMetrics metrics(assembly->start);
    emulator.add_observer(&judge);
    emulator.add_observer(&metrics);
    std::vector<Verdict> verdicts;
    if (scenario->campaign && scenario->campaign->vehicle) {
        auto vehicle = run_with_vehicle(*assembly, *scenario->campaign->vehicle, run,
                                        {stop, setup.orphans != nullptr ? setup.orphans->listener() : nullptr});
        if (!vehicle) return fail(vehicle.error());
        verdicts.push_back(std::move(*vehicle));
    } else {
        emulator.run_until(assembly->end.value_or(GpsTime::max()), stop);
    }
    if (stop) return fail(ErrorCode::outside, "stopped before its end");
    const std::vector<Verdict> judged = judge.finish(emulator.now());
    verdicts.insert(verdicts.begin(), judged.begin(), judged.end());
    result.metrics = kept_metrics(metrics, setup.columns.metrics);
    take_verdicts(result, verdicts);
    return result;
}

}  // namespace skyloop::inline campaigns
