#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <numeric>

#include "base/core/watchdog_process.hpp"
#include "campaign_options.hpp"
#include "campaigns/campaign/campaign_worker.hpp"
#include "campaigns/campaign_report/campaign_report.hpp"
#include "commands.hpp"
#include "data_folders.hpp"
#include "run_options.hpp"
#include "run_session.hpp"
#include "run_watch.hpp"

namespace skyloop::host {

void add_campaign_report_command(CLI::App& campaign, CampaignOptions& options) {
    CLI::App* report =
        campaign.add_subcommand("report", "Tell what came of a gathered campaign: a page, JSON and text");
    report->add_option("DIR", options.out, "The campaign's folder")->required();
    report->add_option("--out", options.page, "The page; default: report.html in that folder");
    report->add_option("--junit", options.junit, "Also a JUnit document for a build server: a case a run");
    report->add_option("--worst", options.worst, "Runs that each metric names")->check(CLI::Range(0, 10000));
    add_verbosity_options(*report, options.verbosity);
}

int report_campaign(const CampaignOptions& options) {
    const Messages messages(options.verbosity);
    const auto written = write_campaign_report(options.out, {options.page, options.worst, options.junit});
    if (!written) return messages.error(written.error());
    if (written->outdated)
        messages.warning(
            fmt::format("{}: results have come since they were gathered; skyloop campaign gather takes "
                        "them in",
                        options.out));
    fmt::print("{}", written->text);
    messages.info(fmt::format("page: {}{}{}", written->html.string(),
                              written->json.empty() ? "" : "; numbers: " + written->json.string(),
                              options.junit.empty() ? "" : "; JUnit: " + options.junit));
    return 0;
}

namespace {

// The runs, a row each.
int print_plan_of(const CampaignOptions& options) {
    const Messages messages(options.verbosity);
    const auto campaign = open_campaign(campaign_request(options));
    if (!campaign) return messages.error(campaign.error());
    // As before a first run: a plan of runs that would be refused is none.
    std::vector<std::uint64_t> all(campaign->plan.size());
    std::iota(all.begin(), all.end(), 0);
    catch_stop_signals();
    const auto warnings = check_runs(*campaign, all, stop_was_asked);
    if (!warnings) return messages.error(warnings.error());
    if (stop_was_asked()) return told_stopped(messages);
    messages.warnings(*warnings);
    fmt::print("number,key,seed");
    for (const std::string& name : campaign->plan.parameters())
        fmt::print(",{}", table_cell(name));
    fmt::print("\n");
    for (std::uint64_t i = 0; i < campaign->plan.size(); ++i) {
        const PlannedRun run = campaign->plan.run(i);
        fmt::print("{},{},{}", run.number, run.key, run.seed);
        for (const CampaignValue& value : run.values)
            fmt::print(",{}", table_cell(value.shown));
        fmt::print("\n");
    }
    return 0;
}

Result<PlannedRun> wanted_run(const CampaignOptions& options, const CampaignPlan& plan) {
    if (options.number.has_value() == !options.key.empty())
        return fail(ErrorCode::usage, "campaign replay: expected one of --number and --key");
    if (options.number && *options.number < plan.size()) return plan.run(*options.number);
    for (std::uint64_t i = 0; i < plan.size() && !options.number; ++i)
        if (PlannedRun run = plan.run(i); run.key == options.key) return run;
    return fail(ErrorCode::usage,
                options.number
                    ? fmt::format("--number {}: expected 0 to {}", *options.number, plan.size() - 1)
                    : fmt::format("--key {}: no run of this plan; keys change with the program's version, the scenario "
                                  "and the files that it names",
                                  options.key));
}

// One run again, recorded.
int replay_run(const CampaignOptions& options) {
    const Messages messages(options.verbosity);
    const auto campaign = open_campaign(campaign_request(options));
    if (!campaign) return messages.error(campaign.error());
    const auto run = wanted_run(options, campaign->plan);
    if (!run) return messages.error(run.error());
    const auto asked = read_scenario(campaign->setup.text, campaign->setup.file, campaign->plan.changes_of(*run));
    if (!asked) return messages.error(asked.error());
    const auto scenario = campaign_scenario(*asked);
    if (!scenario) return messages.error(scenario.error());
    if (scenario->campaign && scenario->campaign->vehicle)
        return messages.error({ErrorCode::usage,
                               "a run with a vehicle is not replayed: it is in real time, and its "
                               "vehicle decides; expected skyloop run"});
    catch_stop_signals();
    RunMode mode = campaign_mode(*scenario);
    mode.record = options.out;
    auto assembly = assemble(*scenario, data_folders(), mode);
    if (!assembly) return messages.error(assembly.error());
    CommandQueue nobody;
    const auto watch = RunWatch::start(*scenario, *assembly, {}, nobody);
    if (!watch) return messages.error(watch.error());
    messages.info(fmt::format("run {}, seed {}, key {}", run->number, run->seed, run->key));
    return RunSession(messages, *assembly).run(*scenario, **watch);
}

std::atomic<bool> worker_stopped{false};

// It lives no longer than whoever leads it.
int serve_as_worker() {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    struct sigaction action {};
    action.sa_handler = [](int) { worker_stopped = true; };
    sigaction(SIGTERM, &action, nullptr);
    signal(SIGPIPE, SIG_IGN);
    const Messages messages({true, false, false});
    // Before any thread is. Without it a vehicle would go on behind a worker that is killed, as its leader's end does.
    const auto watchdog = OrphanWatchdog::start();
    const auto served =
        serve_runs(std::cin, std::cout, data_folders(), worker_stopped, watchdog ? watchdog->get() : nullptr);
    return served ? 0 : messages.error(served.error());
}

void add_plan_options(CLI::App& command, CampaignOptions& options) {
    command.add_option("--seeds", options.seeds, "100: so many; 5-20: the first and the last; 1,7,9: these");
    command
        .add_option("--vary", options.vary,
                    "KEY=a,b,c: values of a key of the scenario, such as model.name=modern,ideal; repeatable")
        ->allow_extra_args(false);
    add_verbosity_options(command, options.verbosity);
}

using SharedCampaignOptions = std::shared_ptr<CampaignOptions>;

// Those that need the plan alone.
void add_plan_commands(CLI::App& command, const SharedCampaignOptions& options) {
    CLI::App* plan = command.add_subcommand("plan", "Print the runs: number, key, seed and parameters, as CSV");
    plan->add_option("SCENARIO", options->scenario, "Scenario file (TOML)")->required();
    add_plan_options(*plan, *options);
    CLI::App* replay = command.add_subcommand("replay", "Do one of the runs again, and record it");
    replay->add_option("SCENARIO", options->scenario, "Scenario file (TOML)")->required();
    replay->add_option("--number", options->number, "Of the run, from 0 on");
    replay->add_option("--key", options->key, "Of the run, instead of its number");
    replay->add_option("--out", options->out, "Folder for the recording")->required();
    add_plan_options(*replay, *options);
}

}  // namespace

Action add_campaign_command(CLI::App& app) {
    CLI::App* command = app.add_subcommand("campaign", "Many runs of a scenario over seeds and parameters");
    auto options = std::make_shared<CampaignOptions>();
    command->require_subcommand(0, 1);
    command->add_option("SCENARIO", options->scenario, "Scenario file (TOML) with a [campaign]");
    command->add_option("--out", options->out, "Folder of the results; what is there already is not run again");
    command->add_option("--shard", options->shard, "I/N: only this part of the runs, I from 0 to N - 1");
    add_engine_options(*command, options->engine);
    command->add_option("--jobs", options->jobs, "Runs at a time; default: one a core")->check(CLI::Range(1, 1024));
    command
        ->add_option("--run-limit", options->run_limit_s,
                     "Seconds that a run may take; then it is ended, tried once more, and left without a result")
        ->check(CLI::Range(0.1, 1e9));
    add_plan_options(*command, *options);
    add_plan_commands(*command, options);
    CLI::App* gather = command->add_subcommand("gather", "Merge the parts' results into DIR/campaign.sqlite");
    gather->add_option("DIR", options->out, "The campaign's folder")->required();
    add_verbosity_options(*gather, options->verbosity);
    add_campaign_report_command(*command, *options);
    command->add_subcommand("worker", "")->group("");
    return [command, options] {
        if (command->got_subcommand("plan")) return print_plan_of(*options);
        if (command->got_subcommand("replay")) return replay_run(*options);
        if (command->got_subcommand("gather")) return tell_gathered(Messages(options->verbosity), options->out);
        if (command->got_subcommand("report")) return report_campaign(*options);
        if (command->got_subcommand("worker")) return serve_as_worker();
        return run_campaign(*options);
    };
}

}  // namespace skyloop::host
