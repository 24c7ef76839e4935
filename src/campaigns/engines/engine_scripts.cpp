#include "campaigns/engines/engine_scripts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/core/bytes.hpp"
#include "base/core/words.hpp"
#include "campaigns/engines/engine_files.hpp"
#include "campaigns/engines/engine_task.hpp"

namespace skyloop::inline campaigns {
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

namespace {

// An object's name: RFC 1123, as Kubernetes narrows it ("Object Names and IDs", DNS label names).
constexpr std::size_t longest_label = 63;

bool is_label(std::string_view name, std::string_view also = {}) {
    const auto inner = [&](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || also.find(c) != std::string_view::npos;
    };
    const auto outer = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); };
    return !name.empty() && outer(name.front()) && outer(name.back()) && std::all_of(name.begin(), name.end(), inner);
}

bool is_bare(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c > 0x20 && c < 0x7f; });
}

// A number and what it counts (Kubernetes API, resource quantities); a sign and an exponent are left out.
bool is_quantity(std::string_view text) {
    static constexpr std::string_view units[] = {"", "k", "M", "G", "T", "P", "E", "Ki", "Mi", "Gi", "Ti", "Pi", "Ei"};
    const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
    const std::string_view number = text.substr(0, digits);
    const bool is_number = !number.empty() && number.front() != '.' && number.back() != '.' &&
                           std::count(number.begin(), number.end(), '.') <= 1;
    return is_number && std::find(std::begin(units), std::end(units), text.substr(digits)) != std::end(units);
}

bool lies_in(const std::filesystem::path& file, const std::filesystem::path& folder) {
    const auto inside = file.lexically_normal().lexically_relative(folder.lexically_normal());
    return !inside.empty() && *inside.begin() != "..";
}

bool is_utf8(std::string_view text) {
    while (const std::size_t length = utf8_length(text))
        text.remove_prefix(length);
    return text.empty();
}

Result<void> check_names(const KubernetesSettings& settings) {
    if (!is_bare(settings.image))
        return fail(
            ErrorCode::usage,
            fmt::format("--image '{}': expected an image that has skyloop, such as registry.example/skyloop:1.0",
                        settings.image));
    if (!is_label(settings.claim, "."))
        return fail(ErrorCode::usage,
                    fmt::format("--claim '{}': expected the name of a PersistentVolumeClaim", settings.claim));
    if (!settings.name_space.empty() && (!is_label(settings.name_space) || settings.name_space.size() > longest_label))
        return fail(ErrorCode::usage,
                    fmt::format("--namespace '{}': expected small letters, digits and hyphens, at most {}",
                                settings.name_space, longest_label));
    if (!is_quantity(settings.memory))
        return fail(ErrorCode::usage,
                    fmt::format("--memory '{}': expected a quantity, such as 512Mi", settings.memory));
    if (settings.parallelism < 1) return fail(ErrorCode::usage, "--parallelism: 0; expected at least 1");
    return {};
}

Result<void> check_places(const EngineTask& task, const KubernetesSettings& settings) {
    if (!settings.mount.is_absolute())
        return fail(ErrorCode::usage, fmt::format("--mount '{}': expected an absolute path", settings.mount.string()));
    if (!settings.mount.has_relative_path())
        return fail(ErrorCode::usage, "--mount '/': the claim would hide all of the image; expected a folder");
    for (const auto& [what, path] : {std::pair("scenario", &task.scenario), std::pair("--out", &task.out)})
        if (!lies_in(*path, settings.mount))
            return fail(ErrorCode::usage,
                        fmt::format("{} '{}': expected a path under --mount {}, where the containers have the "
                                    "claim '{}'",
                                    what, path->string(), settings.mount.string(), settings.claim));
    std::vector<std::string> texts = shard_command(task);
    texts.push_back(settings.mount.string());
    for (const std::string& text : texts)
        if (!is_utf8(text))
            return fail(ErrorCode::usage, fmt::format("'{}' is not UTF-8, which a manifest has to be", text));
    return {};
}

// The image's own program.
std::string arguments(std::vector<std::string> command) {
    command.front() = "skyloop";
    std::string lines;
    for (const std::string& word : command)
        lines += fmt::format("- {}\n", yaml_quoted(kubernetes_literal(word)));
    return lines;
}

// The results' folder belongs to who writes the manifest: the image's own user, and a superuser without capabilities,
// could not write there. Some kinds of volumes are given to fsGroup instead (Kubernetes API v1, PodSecurityContext),
// file by file unless their root has it already.
std::string identity(const KubernetesSettings& settings) {
    if (settings.user == 0) return {};
    return fmt::format(
        "securityContext:\n  runAsUser: {}\n  runAsGroup: {}\n  fsGroup: {}\n  fsGroupChangePolicy: OnRootMismatch\n",
        settings.user, settings.group, settings.group);
}

// What both manifests have.
std::vector<TemplateValue> kubernetes_values(const EngineTask& task, const KubernetesSettings& settings,
                                             const std::vector<std::string>& command, const char* file) {
    const std::string& space = settings.name_space;
    return {{"command", arguments(command)},
            {"file", shell_quoted((task.out / "kubernetes" / file).string())},
            {"job", "skyloop-" + plain_name(task.name)},
            {"namespace", space.empty() ? std::string() : "namespace: " + yaml_quoted(space)},
            {"identity", identity(settings)},
            {"image", yaml_quoted(settings.image)},
            {"memory", yaml_quoted(settings.memory)},
            {"mount", yaml_quoted(settings.mount.string())},
            {"claim", yaml_quoted(settings.claim)},
            {"retries", std::to_string(settings.retries)}};
}

}  // namespace

Result<KubernetesManifests> kubernetes_manifests(const EngineTask& task, const KubernetesSettings& settings) {
    if (auto good = check_task(task); !good) return fail(good.error());
    if (auto good = check_names(settings); !good) return fail(good.error());
    if (auto good = check_places(task, settings); !good) return fail(good.error());
    auto values = kubernetes_values(task, settings, shard_command(task), "campaign.yaml");
    values.push_back({"shards", std::to_string(task.shards)});
    values.push_back({"parallelism", std::to_string(std::min(settings.parallelism, task.shards))});
    auto shards = fill_engine_template(task.templates, "kubernetes.yaml", values);
    if (!shards) return fail(shards.error());
    auto gather = fill_engine_template(task.templates, "kubernetes_gather.yaml",
                                       kubernetes_values(task, settings, gather_command(task), "gather.yaml"));
    if (!gather) return fail(gather.error());
    return KubernetesManifests{std::move(*shards), std::move(*gather)};
}

}  // namespace skyloop::inline campaigns
