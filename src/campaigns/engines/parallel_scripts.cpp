#include "campaigns/engines/parallel_scripts.hpp"

#include <fmt/format.h>

#include <string_view>

#include "base/core/digest.hpp"
#include "campaigns/engines/engine_files.hpp"
#include "campaigns/engines/quoting.hpp"
#include "detail/shell_parts.hpp"

namespace skyloop {
namespace {

// Empty lines and comments name nobody (parallel(1), --sshloginfile).
Result<void> check_hosts(std::string_view hosts) {
    bool any = false;
    for (std::size_t at = 0; at < hosts.size();) {
        const std::size_t end = std::min(hosts.find('\n', at), hosts.size());
        const std::string_view line = hosts.substr(at, end - at);
        for (const char c : line)
            if (static_cast<unsigned char>(c) < 0x20 && c != '\t' && c != '\r')
                return fail(ErrorCode::usage, "--hosts: the file holds control characters; expected a host a line");
        const std::size_t first = line.find_first_not_of(" \t\r");
        any = any || (first != std::string_view::npos && line[first] != '#');
        at = end + 1;
    }
    if (!any)
        return fail(ErrorCode::usage,
                    "--hosts: the file names no host; expected a line such as 8/node1, or : for here");
    return {};
}

std::string shard_script(const EngineTask& task) {
    std::string script =
        "#!/bin/sh\n# shard.sh I: one shard of a campaign. Called by campaign.sh, here or on another host.\nset -u\n";
    script += fmt::format("bad={}\n", shell_quoted((parallel_folder(task) / "bad").string()));
    script += "# One has said that the campaign cannot be: the others need not.\n[ ! -e \"$bad\" ] || exit 2\n";
    script += fmt::format("set -- {} --jobs 1 --shard \"$1/{}\"\n", shell_quoted(shard_command(task)), task.shards);
    script += run_child;
    return script +
           "case $code in\n    0 | 3) exit 0 ;; # 3: a verdict failed, which is a result\n"
           "    2) : >\"$bad\" ;;\nesac\nexit \"$code\"\n";
}

// GNU parallel reads whole commands from its input, in which it replaces nothing.
constexpr std::string_view run_all = R"(log="$folder/joblog-$joblog"
eta=
[ ! -t 2 ] || eta=--eta
interrupted=
trap 'interrupted=yes' INT TERM
rm -f -- "$folder/bad"
shard=0
while [ "$shard" -lt "$shards" ]; do
    printf '%s %s\n' "$shard_call" "$shard"
    shard=$((shard + 1))
done | PARALLEL_SHELL=/bin/sh parallel --will-cite --sshloginfile "$folder/hosts" --joblog "$log" --resume-failed \
    --retries "$retries" --termseq TERM,20000,TERM,10000,KILL,100 $eta
failed=$?
[ -z "$interrupted" ] || exit 75
[ ! -e "$folder/bad" ] || exit 2
)";

std::string campaign_script(const EngineTask& task, const ParallelSettings& settings, const std::string& shard) {
    const std::string call = shell_quoted((parallel_folder(task) / "campaign.sh").string());
    std::string script =
        "#!/bin/sh\n# All shards of a campaign by GNU parallel on the hosts in the file beside this, then their "
        "gathering. Called by\n";
    script += fmt::format("#   sh {}\n# Called again, it goes on.\nset -u\n", call);
    script += fmt::format("folder={}\nshards={}\n", shell_quoted(parallel_folder(task).string()), task.shards);
    // parallel's own count: 1 is no second try.
    script += fmt::format("retries={}\n", settings.retries + 1);
    script += fmt::format("joblog={:016x}\n", fnv1a_64(settings.scenario_text, fnv1a_64(shard)));
    script += fmt::format("shard_call={}\n",
                          shell_quoted("sh " + shell_quoted((parallel_folder(task) / "shard.sh").string())));
    script += run_all;
    script += shell_quoted(gather_command(task));
    return script +
           "\ngathered=$?\n[ \"$failed\" -eq 0 ] || {\n    printf 'shards failed; see %s\\n' \"$log\" >&2\n    exit "
           "1\n}\n"
           "exit \"$gathered\"\n";
}

}  // namespace

std::filesystem::path parallel_folder(const EngineTask& task) { return task.out / "parallel"; }

Result<ParallelScripts> parallel_scripts(const EngineTask& task, const ParallelSettings& settings) {
    if (auto good = check_task(task); !good) return fail(good.error());
    if (auto good = check_hosts(settings.hosts); !good) return fail(good.error());
    const std::string shard = shard_script(task);
    return ParallelScripts{campaign_script(task, settings, shard), shard, settings.hosts};
}

Result<void> write_parallel_files(const EngineTask& task, const ParallelScripts& scripts) {
    const auto folder = parallel_folder(task);
    if (auto written = write_engine_file(folder / "hosts", scripts.hosts); !written) return written;
    if (auto written = write_engine_file(folder / "shard.sh", scripts.shard); !written) return written;
    return write_engine_file(folder / "campaign.sh", scripts.campaign);
}

}  // namespace skyloop
