#include "campaigns/engines/kubernetes_manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "campaigns/engines/quoting.hpp"
#include "detail/shell_parts.hpp"

namespace skyloop {
namespace {

// An object's name: RFC 1123, as Kubernetes narrows it ("Object Names and IDs", DNS label names).
constexpr std::size_t longest_label = 63;

// Seconds between SIGTERM and SIGKILL: a run of a campaign ends well within.
constexpr int grace_s = 45;

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

// Well-formed UTF-8 (RFC 3629, section 4, but for surrogates and overlong forms, which a path has no use for).
bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto first = static_cast<unsigned char>(text[i++]);
        const int more = first < 0x80                    ? 0
                         : first >= 0xc2 && first < 0xe0 ? 1
                         : first >= 0xe0 && first < 0xf0 ? 2
                         : first >= 0xf0 && first < 0xf5 ? 3
                                                         : -1;
        if (more < 0) return false;
        for (int k = 0; k < more; ++k, ++i)
            if (i >= text.size() || (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return false;
    }
    return true;
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

std::string indented(std::string_view text, std::string_view by) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        out += fmt::format("{}{}\n", by, text.substr(at, end - at));
        at = end + 1;
    }
    return out;
}

std::string arguments(const std::vector<std::string>& command) {
    std::string lines = "            - shard\n";  // the script's name for itself, $0
    for (const std::string& word : command)
        lines += fmt::format("            - {}\n", yaml_quoted(kubernetes_literal(word)));
    return lines;
}

std::string head(const std::string& name, const KubernetesSettings& settings) {
    std::string text = fmt::format("apiVersion: batch/v1\nkind: Job\nmetadata:\n  name: {}\n", yaml_quoted(name));
    if (!settings.name_space.empty()) text += fmt::format("  namespace: {}\n", yaml_quoted(settings.name_space));
    return text + "  labels:\n    app.kubernetes.io/name: skyloop\n    app.kubernetes.io/component: campaign\nspec:\n";
}

// The results' folder belongs to who writes the manifest: the image's own user, and a superuser without capabilities,
// could not write there. Some kinds of volumes are given to fsGroup instead (Kubernetes API v1, PodSecurityContext),
// file by file unless their root has it already.
std::string identity(const KubernetesSettings& settings) {
    if (settings.user == 0) return {};
    return fmt::format(R"(      securityContext:
        runAsUser: {}
        runAsGroup: {}
        fsGroup: {}
        fsGroupChangePolicy: OnRootMismatch
)",
                       settings.user, settings.group, settings.group);
}

std::string pod(const KubernetesSettings& settings, const std::string& script,
                const std::vector<std::string>& command) {
    return fmt::format(R"(  template:
    metadata:
      labels:
        app.kubernetes.io/name: skyloop
        app.kubernetes.io/component: campaign
    spec:
      restartPolicy: Never
      automountServiceAccountToken: false
      terminationGracePeriodSeconds: {}
{}      containers:
        - name: skyloop
          image: {}
          command:
            - /bin/sh
            - -c
            - |
{}          args:
{}          resources:
            requests:
              cpu: "1"
              memory: {}
            limits:
              memory: {}
          securityContext:
            allowPrivilegeEscalation: false
            capabilities:
              drop: [ALL]
          volumeMounts:
            - name: campaign
              mountPath: {}
      volumes:
        - name: campaign
          persistentVolumeClaim:
            claimName: {}
)",
                       grace_s, identity(settings), yaml_quoted(settings.image), indented(script, "              "),
                       arguments(command), yaml_quoted(settings.memory), yaml_quoted(settings.memory),
                       yaml_quoted(settings.mount.string()), yaml_quoted(settings.claim));
}

// Exit code 3, a failed verdict, is a result.
std::string script_for(std::string_view more_words) {
    std::string script;
    if (!more_words.empty()) script += fmt::format("set -- \"$@\" {}\n", more_words);
    return script + std::string(run_child) + "[ \"$code\" -ne 3 ] || code=0\nexit \"$code\"\n";
}

std::string shards_manifest(const EngineTask& task, const KubernetesSettings& settings) {
    std::vector<std::string> command = shard_command(task);
    command.front() = "skyloop";  // the image's
    std::string text = fmt::format(R"(# The shards of a campaign, one in each index of the job.
#   kubectl apply -f {}
)",
                                   shell_quoted((task.out / "kubernetes" / "campaign.yaml").string()));
    text += head("skyloop-" + plain_name(task.name), settings);
    text += fmt::format(R"(  completionMode: Indexed
  completions: {}
  parallelism: {}
  backoffLimitPerIndex: {}
  # Never two containers at the same shard.
  podReplacementPolicy: Failed
  podFailurePolicy:
    rules:
      # Evicted or preempted, or its node was lost: that is no try.
      - action: Ignore
        onPodConditions:
          - type: DisruptionTarget
            status: "True"
      # The campaign cannot be: every shard would say the same.
      - action: FailJob
        onExitCodes:
          containerName: skyloop
          operator: In
          values: [2]
)",
                        task.shards, std::min(settings.parallelism, task.shards), settings.retries);
    return text + pod(settings, script_for(fmt::format("--jobs 1 --shard \"$JOB_COMPLETION_INDEX/{}\"", task.shards)),
                      command);
}

std::string gather_manifest(const EngineTask& task, const KubernetesSettings& settings) {
    std::vector<std::string> command = gather_command(task);
    command.front() = "skyloop";
    const std::string name = "skyloop-" + plain_name(task.name);
    std::string text = fmt::format(
        "# Merges the results of job {}, once that is complete:\n"
        "#   kubectl wait --for=condition=complete --timeout=24h job/{}\n#   kubectl apply -f {}\n",
        name, name, shell_quoted((task.out / "kubernetes" / "gather.yaml").string()));
    text += head(name + "-gather", settings) + fmt::format("  backoffLimit: {}\n", settings.retries);
    return text + pod(settings, script_for({}), command);
}

}  // namespace

Result<KubernetesManifests> kubernetes_manifests(const EngineTask& task, const KubernetesSettings& settings) {
    if (auto good = check_task(task); !good) return fail(good.error());
    if (auto good = check_names(settings); !good) return fail(good.error());
    if (auto good = check_places(task, settings); !good) return fail(good.error());
    return KubernetesManifests{shards_manifest(task, settings), gather_manifest(task, settings)};
}

}  // namespace skyloop
