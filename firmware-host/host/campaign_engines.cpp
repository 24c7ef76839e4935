#include "campaign_options.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <numeric>
#include <system_error>

#include "base/core/files.hpp"
#include "campaigns/engines/engine_files.hpp"
#include "campaigns/engines/engine_scripts.hpp"
#include "campaigns/engines/engine_task.hpp"
#include "campaigns/engines/slurm_job.hpp"
#include "run_session.hpp"

namespace skyloop::host {
namespace {

Result<std::filesystem::path> whole_path(const std::filesystem::path& path) {
    std::error_code reason;
    const auto whole = std::filesystem::absolute(path, reason);
    if (reason) return fail(ErrorCode::outside, fmt::format("{}: {}", path.string(), reason.message()));
    return whole.lexically_normal();
}

// The program that runs now: where a cluster's nodes share the file systems, it is there under the same path.
Result<std::filesystem::path> this_program() {
    std::error_code reason;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", reason);
    if (reason) return fail(ErrorCode::outside, fmt::format("/proc/self/exe: {}", reason.message()));
    return program;
}

std::vector<std::string> options_of_shards(const CampaignOptions& options) {
    std::vector<std::string> words;
    if (options.seeds) words.insert(words.end(), {"--seeds", *options.seeds});
    for (const std::string& vary : options.vary)
        words.insert(words.end(), {"--vary", vary});
    if (options.run_limit_s) words.insert(words.end(), {"--run-limit", fmt::format("{}", *options.run_limit_s)});
    return words;
}

Result<EngineTask> task_of(const CampaignOptions& options, const OpenedCampaign& campaign) {
    const auto program = this_program();
    if (!program) return fail(program.error());
    const auto scenario = whole_path(options.scenario), out = whole_path(options.out);
    if (!scenario) return fail(scenario.error());
    if (!out) return fail(out.error());
    const std::size_t shards = options.engine.shards > 0 ? options.engine.shards : default_shards(campaign.plan.size());
    EngineTask task{campaign.name, *program, *scenario, *out, options_of_shards(options), shards};
    for (const std::string& file : options.engine.templates)
        if (auto added = add_engine_template(task.templates, options.engine.name, file); !added)
            return fail(added.error());
    return task;
}

int follow_until_end(const EngineTask& task, std::size_t runs, const Messages& messages) {
    const auto job = submitted_slurm(task);
    if (!job)
        return messages.error(
            {ErrorCode::usage, fmt::format("--follow: {} has no jobs; expected some that --submit left there",
                                           slurm_folder(task).string())});
    FollowOptions follow;
    follow.runs = runs;
    follow.between_looks = Seconds(1);
    follow.stopped = stop_was_asked;
    follow.say = [&](const std::string& line) { messages.info(line); };
    catch_stop_signals();
    const auto code = follow_slurm(task, *job, follow);
    return code ? *code : messages.error(code.error());
}

int to_slurm(const EngineTask& task, const CampaignOptions& asked, std::size_t runs, const Messages& messages) {
    const EngineOptions& options = asked.engine;
    SlurmSettings settings;
    settings.partition = options.partition;
    settings.time_limit = options.time_limit;
    settings.options = options.sbatch_options;
    settings.processors = asked.jobs.value_or(1);
    // Scripts of jobs that are in the queue stay as they are.
    if (options.submit || !options.follow) {
        const auto scripts = slurm_scripts(task, settings);
        if (!scripts) return messages.error(scripts.error());
        if (const auto written = write_slurm_files(task, *scripts); !written) return messages.error(written.error());
        const std::string script = shell_quoted((slurm_folder(task) / "campaign.sbatch").string());
        if (!options.submit) {
            messages.info(fmt::format("{} shards; submit them with --submit, or by sbatch {}", task.shards, script));
            return 0;
        }
        const auto job = submit_slurm(task);
        if (!job) return messages.error(job.error());
        messages.info(
            fmt::format("{} shards are job {}, their gathering is job {}", task.shards, job->shards, job->gather));
    }
    return options.follow ? follow_until_end(task, runs, messages) : 0;
}

int to_kubernetes(const EngineTask& task, const EngineOptions& options, const Messages& messages) {
    if (options.submit || options.follow)
        return messages.error({ErrorCode::usage,
                               "--engine kubernetes writes manifests; expected no --submit or --follow, but "
                               "kubectl apply afterwards"});
    KubernetesSettings settings;
    settings.image = options.image;
    settings.claim = options.claim;
    settings.name_space = options.name_space;
    settings.memory = options.memory;
    settings.parallelism = options.parallelism;
    settings.user = ::geteuid();
    settings.group = ::getegid();
    settings.mount = options.mount.empty() ? task.out.parent_path() : options.mount;
    const auto manifests = kubernetes_manifests(task, settings);
    if (!manifests) return messages.error(manifests.error());
    const auto folder = task.out / "kubernetes";
    if (auto done = write_engine_file(folder / "campaign.yaml", manifests->shards); !done)
        return messages.error(done.error());
    if (auto done = write_engine_file(folder / "gather.yaml", manifests->gather); !done)
        return messages.error(done.error());
    messages.info(
        fmt::format("{} shards; kubectl apply -f {}", task.shards, shell_quoted((folder / "campaign.yaml").string())));
    return 0;
}

// Becomes the script, so that signals are the script's and its children's alone.
int become_script(const std::filesystem::path& script, const Messages& messages) {
    std::string shell = "sh", file = script.string();
    const std::array<char*, 3> words{shell.data(), file.data(), nullptr};
    ::signal(SIGPIPE, SIG_DFL);  // what is ignored here would be ignored there
    ::execvp(shell.c_str(), words.data());
    return messages.error({ErrorCode::outside, fmt::format("sh: {}", std::strerror(errno))});
}

int to_parallel(const EngineTask& task, const EngineOptions& options, const Messages& messages) {
    if (options.follow)
        return messages.error(
            {ErrorCode::usage, "--follow: GNU parallel is followed while it runs; expected --submit alone"});
    ParallelSettings settings;
    settings.hosts = ":\n";
    if (!options.hosts.empty()) {
        auto hosts = read_text_file(options.hosts);
        if (!hosts) return messages.error(hosts.error());
        settings.hosts = std::move(*hosts);
    }
    auto text = read_text_file(task.scenario);
    if (!text) return messages.error(text.error());
    settings.scenario_text = std::move(*text);
    const auto scripts = parallel_scripts(task, settings);
    if (!scripts) return messages.error(scripts.error());
    if (const auto written = write_parallel_files(task, *scripts); !written) return messages.error(written.error());
    const auto script = parallel_folder(task) / "campaign.sh";
    if (options.submit) return become_script(script, messages);
    messages.info(
        fmt::format("{} shards; run them with --submit, or by sh {}", task.shards, shell_quoted(script.string())));
    return 0;
}

}  // namespace

void add_engine_options(CLI::App& command, EngineOptions& options) {
    CLI::Option* engine = command
                              .add_option("--engine", options.name,
                                          "Hand the shards to slurm, kubernetes or parallel instead of running here")
                              ->check(CLI::IsMember({"slurm", "kubernetes", "parallel"}))
                              ->excludes("--shard");
    const auto add = [&](const char* name, auto& value, const char* meaning) {
        return command.add_option(name, value, meaning)->needs(engine);
    };
    add("--shards", options.shards, "How many parts an engine gets (default: ten runs each, at most 1000)")
        ->check(CLI::Range(std::size_t{1}, max_shards));
    add("--engine-template", options.templates, "A file in place of the engine's of that name; repeatable")
        ->allow_extra_args(false);
    CLI::Option* submit =
        command.add_flag("--submit", options.submit, "Also call the engine, not only write its files")->needs(engine);
    command.add_flag("--dry-run", options.dry_run, "Only write the engine's files, as without --submit")
        ->needs(engine)
        ->excludes(submit);
    command.add_flag("--follow", options.follow, "slurm: stay until all is gathered; alone: of earlier jobs")
        ->needs(engine);
    // Of one engine, which is told first; --engine was read before them, for it was added before.
    const auto add_for = [&](std::string_view one, const char* name, auto& value, std::string_view meaning) {
        CLI::Option* option = add(name, value, fmt::format("{}: {}", one, meaning).c_str());
        return option->check([&options, one](const std::string&) {
            if (options.name == one) return std::string();
            const std::string found = options.name.empty() ? "expected that, too" : "this is --engine " + options.name;
            return fmt::format("an option of --engine {}; {}", one, found);
        });
    };
    add_for("slurm", "--partition", options.partition, "the partition");
    add_for("slurm", "--time", options.time_limit, "time limit of a shard, as sbatch takes it");
    add_for("slurm", "--sbatch-option", options.sbatch_options, "another option of sbatch, =--account=lab; repeatable")
        ->allow_extra_args(false);
    add_for("parallel", "--hosts", options.hosts, "a file with a host a line, [JOBS/]HOST (default: here alone)");
    add_for("kubernetes", "--image", options.image, "a container image with skyloop");
    add_for("kubernetes", "--claim", options.claim, "the volume claim with the scenario and the results");
    add_for("kubernetes", "--mount", options.mount,
            "where the claim is mounted, there and here (default: above --out)");
    add_for("kubernetes", "--namespace", options.name_space, "the namespace");
    add_for("kubernetes", "--memory", options.memory, "memory of a container")->capture_default_str();
    add_for("kubernetes", "--parallelism", options.parallelism, "containers at a time")->capture_default_str();
}

int hand_over(const CampaignOptions& options, const OpenedCampaign& campaign, const Messages& messages) {
    const bool kubernetes = options.engine.name == "kubernetes";
    if (options.jobs && options.engine.name != "slurm")
        return messages.error({ErrorCode::usage, fmt::format("--jobs: with --engine {} a shard does one run at a time; "
                                                             "expected {} instead",
                                                             options.engine.name,
                                                             kubernetes ? "--parallelism" : "JOBS/HOST in --hosts")});
    const auto task = task_of(options, campaign);
    if (!task) return messages.error(task.error());
    // Mistakes are told here rather than by each shard, and all shards find the campaign's file as they would write it.
    if (!options.engine.follow || options.engine.submit) {
        if (options.engine.name == "slurm")
            if (const auto over = check_slurm_queue(*task); !over) return messages.error(over.error());
        std::vector<std::uint64_t> all(campaign.plan.size());
        std::iota(all.begin(), all.end(), std::uint64_t{0});
        const auto warnings = check_runs(campaign, all, stop_was_asked);
        if (!warnings) return messages.error(warnings.error());
        if (stop_was_asked()) return told_stopped(messages);
        messages.warnings(*warnings);
        OpenedCampaign whole = campaign;
        whole.setup.file = task->scenario;
        if (const auto kept = keep_campaign(task->out, whole); !kept) return messages.error(kept.error());
    }
    if (options.engine.name == "slurm") return to_slurm(*task, options, campaign.plan.size(), messages);
    if (kubernetes) return to_kubernetes(*task, options.engine, messages);
    return to_parallel(*task, options.engine, messages);
}

}  // namespace skyloop::host
