#include "campaigns/engines/slurm_scripts.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "campaigns/engines/quoting.hpp"

namespace skyloop {
namespace {

// Seconds before the end of a shard's time at which it is told: a run of a campaign ends well within.
constexpr int warning_time_s = 45;

// What the script says itself; another value would break what follows from it.
constexpr std::array<std::string_view, 10> own_options{"--array",      "-a",          "--dependency", "-d", "--wrap",
                                                       "--no-requeue", "--open-mode", "--output",     "-o", "--signal"};

Result<void> check_option(const std::string& option) {
    if (option.size() < 2 || option.front() != '-')
        return fail(ErrorCode::usage,
                    fmt::format("--sbatch-option '{}': expected an option of sbatch, such as --account=lab", option));
    for (const char c : option)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
            return fail(ErrorCode::usage,
                        fmt::format("--sbatch-option '{}' holds a control character; expected one line", option));
    const std::string_view name = std::string_view(option).substr(0, option.find_first_of("= "));
    for (const std::string_view own : own_options) {
        // A short option's value may follow without a space.
        const bool is_own = own.starts_with("--") ? name == own : !name.starts_with("--") && name.starts_with(own);
        if (is_own)
            return fail(ErrorCode::usage,
                        fmt::format("--sbatch-option '{}': the campaign's script says {} itself", option, own));
    }
    return {};
}

std::string directive(std::string_view option, std::string_view value = {}) {
    const std::string word = value.empty() ? std::string(option) : fmt::format("{}={}", option, value);
    return fmt::format("#SBATCH {}\n", sbatch_quoted(word));
}

std::string users_directives(const SlurmSettings& settings) {
    std::string lines;
    if (!settings.partition.empty()) lines += directive("--partition", settings.partition);
    for (const std::string& option : settings.options)
        lines += directive(option);
    return lines;
}

std::string directives_of_shards(const EngineTask& task, const SlurmSettings& settings) {
    const std::string log = sbatch_pattern((slurm_folder(task) / "log").string()) + "/%a.txt";
    std::string lines = directive("--job-name", "skyloop-" + plain_name(task.name));
    lines += directive("--array", fmt::format("0-{}", task.shards - 1));
    lines += directive("--ntasks", "1") + directive("--cpus-per-task", std::to_string(settings.processors));
    lines += directive("--requeue") + directive("--open-mode", "append") + directive("--output", log);
    lines += directive("--signal", fmt::format("B:USR1@{}", warning_time_s));
    if (!settings.time_limit.empty()) lines += directive("--time", settings.time_limit);
    return lines + users_directives(settings);
}

// The file appears whole or not at all: whoever follows may look at any time.
constexpr std::string_view leave_code = R"(leave_code() { # CODE
    printf '%s\n' "$1" >"$exits/.$name.$$" && mv -f -- "$exits/.$name.$$" "$exits/$name"
}
)";

constexpr std::string_view run_shard = R"sh(
rm -f -- "$exits/$name"
results="$shards_folder/$name-of-$shards.csv"
size_of_results() { stat --format=%s -- "$results" 2>/dev/null || echo 0; }
before=$(size_of_results)

# The time is nearly over: the shard ends the run it is at, keeps all results, and goes on in another job. srun does not
# pass SIGTERM on, but gives its step up.
step=
late=
end_early() {
    late=yes
    [ -z "$step" ] || scancel --signal=TERM "$SLURM_JOB_ID"
}
trap end_early USR1

printf 'shard %s/%s on %s, start %s\n' "$name" "$shards" "${SLURMD_NODENAME:-?}" "$((${SLURM_RESTART_COUNT:-0} + 1))"
srun --ntasks=1 --cpus-per-task="${SLURM_CPUS_PER_TASK:-1}" -- \
    "${shard_command[@]}" --jobs "${SLURM_CPUS_PER_TASK:-1}" --shard "$name/$shards" &
step=$!
[ -z "$late" ] || end_early
# A signal ends a wait before the step has ended; then there is still somebody to wait for.
while :; do
    wait "$step"
    code=$?
    kill -0 "$step" 2>/dev/null || break
done
leave_code "$code"

again=
case $code in
    0 | 3) exit 0 ;; # 3: a verdict failed, which is a result
    2) exit 2 ;;     # the campaign cannot be; another try would say the same
esac
# Nobody is asked to go on for ever: a shard that ran out of time must have got on.
if [ -n "$late" ]; then
    [ "$(size_of_results)" -gt "$before" ] && again=yes
elif [ "${SLURM_RESTART_COUNT:-0}" -lt "$retries" ]; then
    again=yes
fi
if [ -n "$again" ]; then
    printf 'shard %s/%s ended with code %s: back into the queue\n' "$name" "$shards" "$code"
    # It ends this script too; Slurm may take a moment.
    scontrol requeue "$SLURM_JOB_ID" && sleep 60
fi
exit "$code"
)sh";

std::string shards_script(const EngineTask& task, const SlurmSettings& settings) {
    std::string script = "#!/bin/bash\n# The shards of a campaign, one in each task of a job array. Submitted by\n";
    script += fmt::format("#   sbatch {}\n", shell_quoted((slurm_folder(task) / "campaign.sbatch").string()));
    script += directives_of_shards(task, settings);
    script += "set -u\nname=${SLURM_ARRAY_TASK_ID:?expected a task of a job array, as sbatch makes of this script}\n";
    script += fmt::format("shards={}\nretries={}\n", task.shards, settings.retries);
    script += fmt::format("exits={}\n", shell_quoted((slurm_folder(task) / "exit").string()));
    script += fmt::format("shards_folder={}\n", shell_quoted((task.out / "shards").string()));
    script += fmt::format("shard_command=({})\n", shell_quoted(shard_command(task)));
    script += "mkdir -p -- \"$exits\" || exit 1\n";
    return script + std::string(leave_code) + std::string(run_shard);
}

std::string gather_script(const EngineTask& task, const SlurmSettings& settings) {
    std::string script =
        "#!/bin/bash\n# Merges the results of a campaign's shards, whatever became of them. Submitted by\n";
    script += fmt::format("#   sbatch --dependency=afterany:JOB {}\n",
                          shell_quoted((slurm_folder(task) / "gather.sbatch").string()));
    script += directive("--job-name", "skyloop-" + plain_name(task.name) + "-gather");
    script += directive("--ntasks", "1") + directive("--requeue") + directive("--open-mode", "truncate");
    script += directive("--output", sbatch_pattern((slurm_folder(task) / "log").string()) + "/gather.txt");
    script += users_directives(settings);
    script += fmt::format("set -u\nname=gather\nexits={}\n", shell_quoted((slurm_folder(task) / "exit").string()));
    script += "mkdir -p -- \"$exits\" || exit 1\n" + std::string(leave_code);
    script += "rm -f -- \"$exits/$name\"\n";
    return script +
           fmt::format(
               "{}\ncode=$?\nleave_code \"$code\"\n# A failed verdict is a result.\n[ \"$code\" -ne 3 ] || code=0\n"
               "exit \"$code\"\n",
               shell_quoted(gather_command(task)));
}

}  // namespace

std::filesystem::path slurm_folder(const EngineTask& task) { return task.out / "slurm"; }

Result<SlurmScripts> slurm_scripts(const EngineTask& task, const SlurmSettings& settings) {
    if (auto good = check_task(task); !good) return fail(good.error());
    std::vector<std::string> options = settings.options;
    if (!settings.partition.empty()) options.push_back("--partition=" + settings.partition);
    if (!settings.time_limit.empty()) options.push_back("--time=" + settings.time_limit);
    for (const std::string& option : options)
        if (auto good = check_option(option); !good) return fail(good.error());
    if (settings.processors < 1) return fail(ErrorCode::usage, "--jobs: 0; expected at least 1 processor for a shard");
    return SlurmScripts{shards_script(task, settings), gather_script(task, settings)};
}

}  // namespace skyloop
