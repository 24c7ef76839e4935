#include "campaigns/engines/parallel_scripts.hpp"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "base/core/digest.hpp"
#include "campaigns/engines/engine_files.hpp"
#include "campaigns/engines/quoting.hpp"

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

}  // namespace

std::filesystem::path parallel_folder(const EngineTask& task) { return task.out / "parallel"; }

Result<ParallelScripts> parallel_scripts(const EngineTask& task, const ParallelSettings& settings) {
    if (auto good = check_task(task); !good) return fail(good.error());
    if (auto good = check_hosts(settings.hosts); !good) return fail(good.error());
    const auto folder = parallel_folder(task);
    const auto inside = [&](const char* name) { return shell_quoted((folder / name).string()); };
    auto shard = fill_engine_template(task.templates, "parallel_shard.sh",
                                      {{"command", shell_quoted(shard_command(task))},
                                       {"shards", std::to_string(task.shards)},
                                       {"bad", inside("bad")}});
    if (!shard) return fail(shard.error());
    auto campaign = fill_engine_template(
        task.templates, "parallel.sh",
        {{"shard_call", shell_quoted("sh " + inside("shard.sh"))},
         {"script", inside("campaign.sh")},
         {"folder", shell_quoted(folder.string())},
         {"shards", std::to_string(task.shards)},
         {"tries", std::to_string(settings.retries + 1)},  // parallel's own count: 1 is no second try
         {"joblog", fmt::format("{:016x}", fnv1a_64(settings.scenario_text, fnv1a_64(*shard)))},
         {"gather", shell_quoted(gather_command(task))}});
    if (!campaign) return fail(campaign.error());
    return ParallelScripts{std::move(*campaign), std::move(*shard), settings.hosts};
}

Result<void> write_parallel_files(const EngineTask& task, const ParallelScripts& scripts) {
    const auto folder = parallel_folder(task);
    if (auto written = write_engine_file(folder / "hosts", scripts.hosts); !written) return written;
    if (auto written = write_engine_file(folder / "shard.sh", scripts.shard); !written) return written;
    return write_engine_file(folder / "campaign.sh", scripts.campaign);
}

}  // namespace skyloop
