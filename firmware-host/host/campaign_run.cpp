#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <map>
#include <thread>

#include "base/core/files.hpp"
#include "base/core/words.hpp"
#include "base/time/utc_time.hpp"
#include "campaign_options.hpp"
#include "campaigns/campaign/campaign_database.hpp"
#include "campaigns/campaign/campaign_worker.hpp"
#include "campaigns/campaign/shard_results.hpp"
#include "campaigns/campaign/worker_pool.hpp"
#include "data_folders.hpp"
#include "run_session.hpp"

namespace skyloop::host {
namespace {

constexpr int failed_runs_code = 3;
constexpr int most_attempts = 2;
constexpr std::string_view log_header = "time_utc,host,key,number,attempt,outcome,wall_s,detail\n";

// What an attempt was like; never part of a result.
std::string log_line(const PlannedRun& run, const JobOutcome& outcome, std::string_view what, std::string_view detail) {
    static const std::string host = first_line_of("/proc/sys/kernel/hostname");
    return fmt::format("{},{},{},{},{},{},{:.3f},{}\n", utc_text(wall_clock(), 3), table_cell(host), run.key,
                       run.number, outcome.attempt, what, outcome.seconds, table_cell(detail));
}

std::string first_failed(const RunResult& result, const ResultColumns& columns) {
    if (result.status == "error") return result.error.substr(0, result.error.find('\n'));
    for (std::size_t i = 0; i < result.verdicts.size(); ++i)
        if (result.verdicts[i].outcome == "failed" || result.verdicts[i].outcome == "undecided")
            return fmt::format("{}: {}", columns.verdicts[i], result.verdicts[i].detail);
    for (std::size_t i = 0; i < result.verdicts.size(); ++i)
        if (result.verdicts[i].outcome == "not run")
            return fmt::format("nothing was judged; {}: {}", columns.verdicts[i], result.verdicts[i].detail);
    return {};
}

std::string duration_words(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
    return fmt::format("{:.1f} h", seconds / 3600);
}

// One line of a terminal, rewritten.
class CampaignProgress {
public:
    CampaignProgress(bool wanted, std::uint64_t all, std::uint64_t there)
        : shown_(wanted && ::isatty(STDERR_FILENO) != 0), all_(all), there_(there) {}
    void count(bool passed) { ++done_, failed_ += passed ? 0 : 1; }
    void show() {
        const auto now = std::chrono::steady_clock::now();
        if (!shown_ || now - last_ < std::chrono::milliseconds(200)) return;
        last_ = now;
        const double rate = static_cast<double>(done_) / std::chrono::duration<double>(now - begun_).count();
        const std::uint64_t left = all_ - there_ - done_;
        say(fmt::format("\r\x1b[K{}/{} runs, {} failed, {:.3g} runs/s, {} left", there_ + done_, all_, failed_, rate,
                        done_ > 0 ? duration_words(static_cast<double>(left) / rate) : "?"));
    }
    void clear() const {
        if (shown_) say("\r\x1b[K");
    }
    [[nodiscard]] std::uint64_t failed() const { return failed_; }

private:
    bool shown_;
    std::uint64_t all_, there_, done_ = 0, failed_ = 0;
    std::chrono::steady_clock::time_point begun_ = std::chrono::steady_clock::now(), last_{};
};

// The part of a campaign that this process leads.
class CampaignLeader {
    using LeaderClock = std::chrono::steady_clock;

public:
    CampaignLeader(const Messages& messages, const CampaignOptions& options, const OpenedCampaign& campaign)
        : messages_(messages), options_(options), campaign_(campaign), files_(campaign.files) {}

    int run(const Shard& shard) {
        // First of all: what is there may be of another campaign.
        if (const auto ours = check_folder(options_.out, campaign_); !ours) return messages_.error(ours.error());
        if (const auto wanted = find_missing(shard); !wanted) return messages_.error(wanted.error());
        const auto warnings = check_runs(campaign_, missing_, stop_was_asked);
        if (!warnings) return messages_.error(warnings.error());
        if (stop_was_asked()) return told_stopped(messages_);
        messages_.warnings(*warnings);
        auto held = keep_campaign(options_.out, campaign_);
        if (!held) return messages_.error(held.error());
        held_ = std::move(*held);
        auto results = TableFile::open(shard_results(options_.out, shard), result_header(campaign_.setup.columns));
        if (!results) return messages_.error(results.error());
        auto log = TableFile::open(shard_log(options_.out, shard), log_header);
        if (!log) return messages_.error(log.error());
        messages_.info(fmt::format("{}: {} runs, {} of them there, {} to do", campaign_.name, there_ + missing_.size(),
                                   there_, missing_.size()));
        return lead(*results, *log);
    }

private:
    Result<void> find_missing(const Shard& shard) {
        std::map<std::string, bool, std::less<>> passed;
        const auto read = for_each_result(options_.out, [&](const StoredResult& stored) -> Result<void> {
            passed[stored.result.key] = stored.result.status == "passed";
            return {};
        });
        if (!read) return fail(read.error());
        for (std::uint64_t number = shard.index; number < campaign_.plan.size(); number += shard.count)
            if (const auto found = passed.find(campaign_.plan.run(number).key); found == passed.end())
                missing_.push_back(number);
            else if (++there_; !found->second)
                ++failed_before_;
        return {};
    }
    [[nodiscard]] PoolWork work() const {
        PoolWork work;
        work.command = {"/proc/self/exe", "campaign", "worker"};
        work.greeting = worker_greeting(campaign_.setup);
        work.processes = options_.jobs.value_or(std::max(1U, std::thread::hardware_concurrency()));
        work.job_limit = std::chrono::duration<double>(options_.run_limit_s.value_or(0));
        work.jobs = missing_;
        work.ask = [this](std::uint64_t number) {
            const PlannedRun run = campaign_.plan.run(number);
            return worker_question(run, campaign_.plan.changes_of(run));
        };
        return work;
    }
    int lead(TableFile& results, TableFile& log) {
        CampaignProgress progress(!messages_.verbosity().quiet && !messages_.verbosity().json, there_ + missing_.size(),
                                  there_);
        const auto done = run_jobs(
            work(), [&](const JobOutcome& outcome) { return take(outcome, results, log, progress); },
            [&] {
                stop_ = stop_was_asked();
                progress.show();
            },
            stop_);
        progress.clear();
        if (!done) return messages_.error(done.error());
        if (stop_) return told_stopped(messages_);
        if (given_up_ > 0)
            return messages_.error(
                {ErrorCode::outside,
                 fmt::format("{} runs have no result; the same command tries them again", given_up_)});
        return failed_before_ + progress.failed() > 0 ? failed_runs_code : 0;
    }
    Result<JobFate> take(const JobOutcome& outcome, TableFile& results, TableFile& log, CampaignProgress& progress) {
        const auto began = LeaderClock::now() - std::chrono::duration_cast<LeaderClock::duration>(
                                                    std::chrono::duration<double>(outcome.seconds));
        if (const auto same = look_at_files(); !same) return fail(same.error());
        const PlannedRun run = campaign_.plan.run(outcome.job);
        const ResultColumns& columns = campaign_.setup.columns;
        if (began < written_at_)
            return take_loss(run, outcome, {ErrorCode::outside, written_ + " was written while it ran"}, log);
        const auto result = outcome.answer.empty() ? Result<RunResult>(fail(ErrorCode::outside, outcome.death))
                                                   : worker_answer(outcome.answer, columns);
        if (!result) return take_loss(run, outcome, result.error(), log);
        if (const auto added = results.append(result_row(*result)); !added) return fail(added.error());
        if (const auto added = log.append(log_line(run, outcome, result->status, {})); !added)
            return fail(added.error());
        const bool passed = result->status == "passed";
        progress.count(passed);
        if (!passed) {
            progress.clear();
            messages_.warning(fmt::format("run {} (seed {}, key {}) {}: {}", run.number, run.seed, run.key,
                                          result->status, first_failed(*result, columns)));
            tell_replay(run.number);
        }
        return JobFate::done;
    }
    // What was written with the same content may have held another one in between.
    Result<void> look_at_files() {
        const auto written = files_.find_written();
        if (!written) return fail(written.error());
        if (!*written) return {};
        written_ = (*written)->string();
        written_at_ = LeaderClock::now();
        return {};
    }
    // Once: how any of them is seen again.
    void tell_replay(std::uint64_t number) {
        if (replay_told_) return;
        replay_told_ = true;
        if (!campaign_.vehicle.empty())
            return messages_.info(
                "runs with a vehicle are not replayed; the same campaign in another --out does them anew");
        messages_.info(fmt::format("to see it: skyloop campaign replay {}{}{} --number {} --out FOLDER",
                                   shell_quoted_path(options_.scenario), campaign_.options.empty() ? "" : " ",
                                   shell_quoted(campaign_.options), number));
    }
    // A run that was lost is no result, and tried once more.
    Result<JobFate> take_loss(const PlannedRun& run, const JobOutcome& outcome, const Error& why, TableFile& log) {
        if (stop_was_asked()) return JobFate::given_up;
        const bool again = outcome.attempt < most_attempts;
        if (const auto added = log.append(log_line(run, outcome, "lost", why.message)); !added)
            return fail(added.error());
        given_up_ += again ? 0 : 1;
        messages_.warning(fmt::format("run {} (seed {}, key {}) was lost, {}: {}", run.number, run.seed, run.key,
                                      again ? "and is tried again" : "twice", why.message));
        return again ? JobFate::again : JobFate::given_up;
    }

    const Messages& messages_;
    const CampaignOptions& options_;
    const OpenedCampaign& campaign_;
    FileDescriptor held_{};  // the plan, until what came of it is gathered
    KeyedFiles files_;
    std::string written_{};                 // of them the last that was
    LeaderClock::time_point written_at_{};  // when that was seen
    std::vector<std::uint64_t> missing_;
    std::uint64_t there_ = 0, failed_before_ = 0, given_up_ = 0;
    bool replay_told_ = false;
    std::atomic<bool> stop_ = false;
};

void print_missing(const std::vector<std::uint64_t>& missing) {
    constexpr std::size_t most_listed = 10;
    fmt::print("missing      {}", missing.size());
    for (std::size_t i = 0; i < std::min(missing.size(), most_listed); ++i)
        fmt::print("{}{}", i == 0 ? ": runs " : " ", missing[i]);
    fmt::print("{}\n", missing.size() > most_listed ? " …" : "");
}

}  // namespace

int told_stopped(const Messages& messages) {
    constexpr int stopped_code = 75;  // EX_TEMPFAIL of sysexits.h: do it again, and it goes on
    messages.warning("stopped; the same command goes on where it ended");
    return stopped_code;
}

CampaignRequest campaign_request(const CampaignOptions& options) {
    return {options.scenario, options.seeds, options.vary, SKYLOOP_VERSION, data_folders()};
}

int tell_gathered(const Messages& messages, const std::filesystem::path& folder) {
    const auto counts = gather_campaign(folder);
    if (!counts) return messages.error(counts.error());
    fmt::print("planned      {}\ndone         {}: {} passed, {} failed, {} errors\n", counts->planned, counts->done(),
               counts->passed, counts->failed, counts->errors);
    print_missing(counts->missing);
    fmt::print("duplicates   {}\nof other plans {}\n", counts->duplicates, counts->foreign);
    for (const auto& [name, count] : counts->failed_verdicts)
        fmt::print("not met      {} of {} runs: {}\n", count, counts->done(), on_a_terminal(name));
    fmt::print("database     {}\n", (folder / "campaign.sqlite").string());
    if (!counts->missing.empty()) return 1;
    return counts->failed + counts->errors > 0 ? failed_runs_code : 0;
}

int run_campaign(const CampaignOptions& options) {
    const Messages messages(options.verbosity);
    if (options.scenario.empty() || options.out.empty())
        return messages.error({ErrorCode::usage,
                               "expected skyloop campaign SCENARIO --out DIR; see skyloop campaign "
                               "--help"});
    const auto shard = parse_shard(options.shard.value_or("0/1"));
    if (!shard) return messages.error(shard.error());
    catch_stop_signals();
    const auto campaign = open_campaign(campaign_request(options));
    if (!campaign) return messages.error(campaign.error());
    messages.warnings(campaign->warnings);
    if (!options.engine.name.empty()) return hand_over(options, *campaign, messages);
    CampaignLeader leader(messages, options, *campaign);
    const int code = leader.run(*shard);
    // A part, be it the only one, leaves gathering to whoever has all of them.
    if (options.shard || (code != 0 && code != failed_runs_code)) return code;
    const int gathered = tell_gathered(messages, options.out);
    // Where nothing holds the plan, another may stand there by now; that its runs passed says nothing of these.
    return gathered != 0 ? gathered : code;
}

}  // namespace skyloop::host
