#include "campaigns/engines/slurm_scripts.hpp"

#include <fmt/format.h>

#include <array>
#include <string_view>
#include <utility>

#include "campaigns/engines/quoting.hpp"

namespace skyloop {
namespace {

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

std::string directive(std::string_view option) { return fmt::format("#SBATCH {}\n", sbatch_quoted(option)); }

// What both scripts have.
std::vector<TemplateValue> slurm_values(const EngineTask& task, const std::vector<std::string>& command,
                                        const std::string& script, const std::string& log) {
    const auto folder = slurm_folder(task);
    return {{"command", shell_quoted(command)},
            {"script", shell_quoted((folder / script).string())},
            {"job", "skyloop-" + plain_name(task.name)},
            {"output", sbatch_quoted("--output=" + sbatch_pattern((folder / "log").string()) + "/" + log)},
            {"exits", shell_quoted((folder / "exit").string())}};
}

Result<SlurmScripts> filled_scripts(const EngineTask& task, const SlurmSettings& settings) {
    std::string options;
    if (!settings.partition.empty()) options += directive("--partition=" + settings.partition);
    for (const std::string& option : settings.options)
        options += directive(option);
    const std::string time = settings.time_limit.empty() ? std::string() : directive("--time=" + settings.time_limit);
    auto values = slurm_values(task, shard_command(task), "campaign.sbatch", "%a.txt");
    values.insert(values.end(), {{"options", time + options},
                                 {"last_shard", std::to_string(task.shards - 1)},
                                 {"shards", std::to_string(task.shards)},
                                 {"processors", std::to_string(settings.processors)},
                                 {"retries", std::to_string(settings.retries)},
                                 {"shards_folder", shell_quoted((task.out / "shards").string())}});
    auto shards = fill_engine_template(task.templates, "slurm.sbatch", values);
    if (!shards) return fail(shards.error());
    values = slurm_values(task, gather_command(task), "gather.sbatch", "gather.txt");
    values.push_back({"options", options});
    auto gather = fill_engine_template(task.templates, "slurm_gather.sbatch", values);
    if (!gather) return fail(gather.error());
    return SlurmScripts{std::move(*shards), std::move(*gather)};
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
    return filled_scripts(task, settings);
}

}  // namespace skyloop
