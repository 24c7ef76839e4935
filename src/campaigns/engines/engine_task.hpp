/// What an engine (Slurm, Kubernetes, GNU parallel) is given to do: the shards of one campaign.
/// Texts that reach another language whole: a shell, a batch script's options, YAML.
/// The files that an engine gets, as texts with places to fill in.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/words.hpp"

namespace skyloop::inline campaigns {

/// One word after `#SBATCH`: between double quotes, with `\` before what ends them (sbatch(1) of Slurm 22.05 reads
/// quotes and backslashes there as a shell does, and nothing else).
std::string sbatch_quoted(std::string_view word);

/// A path inside a file name pattern of Slurm, where `%` begins a replacement (sbatch(1), "filename pattern").
std::string sbatch_pattern(std::string_view path);

/// A scalar of YAML between double quotes (YAML 1.2, 7.3.1), whatever it may look like bare.
std::string yaml_quoted(std::string_view text);

/// A text that Kubernetes leaves as it is in a container's command, where `$(NAME)` would be replaced (Container v1
/// core, `args`: `$$` stands for `$`).
std::string kubernetes_literal(std::string_view text);

/// A site's own template, in place of the one of that name that comes with skyloop.
struct EngineTemplate {
    std::string file;  ///< for messages
    std::string text;
};
using EngineTemplates = std::map<std::string, EngineTemplate, std::less<>>;

/// What stands for a placeholder.
struct TemplateValue {
    std::string_view name;
    std::string text;
};

/// The names of an engine's templates: `slurm.sbatch` and `slurm_gather.sbatch` for `slurm`.
std::vector<std::string_view> template_names(std::string_view engine);

/// Reads a site's template; its file's name tells which one it stands for. Fails with `usage` where that is none of the
/// engine's, and as read_text_file() does.
Result<void> add_engine_template(EngineTemplates& templates, std::string_view engine,
                                 const std::filesystem::path& file);

/// The text with each @name@ replaced by its value. Where a placeholder stands alone in its line, each line of the
/// value is indented as it is, and an empty one takes the line away. `@run_child@` is there always: POSIX sh that runs
/// the command in "$@" as a child, passes SIGTERM and SIGINT on to it, and leaves its exit code in `code`. Fails with
/// `input` and FILE:LINE at a name without a value, or FILE where the first of the values is not asked for, without
/// which the file would do nothing.
Result<std::string> fill_template(const EngineTemplate& text, const std::vector<TemplateValue>& values);

/// The same for the template of that name: the site's where there is one.
Result<std::string> fill_engine_template(const EngineTemplates& templates, std::string_view name,
                                         const std::vector<TemplateValue>& values);

/// A campaign that is cut into shards. Each shard is one call of
/// `PROGRAM campaign SCENARIO OPTIONS --out OUT --shard I/SHARDS`, and its exit code is the whole answer: 0 done, 3
/// done with a failed verdict (a result), 2 a scenario or campaign that cannot be (no second try), 75 stopped half-way
/// (goes on when called again); any other is a fault of the machine (another try).
struct EngineTask {
    std::string name;                    ///< of the campaign, as the engine's lists of jobs show it
    std::filesystem::path program;       ///< skyloop, absolute
    std::filesystem::path scenario;      ///< absolute
    std::filesystem::path out;           ///< the campaign's folder, absolute; the same for whoever runs a shard
    std::vector<std::string> options{};  ///< the campaign's own, as they were given: `--seeds`, `1..100`
    std::size_t shards = 1;              ///< 1 to `max_shards`
    EngineTemplates templates{};         ///< the site's own
};

/// More than any engine takes in one array as it is configured by default (Slurm: MaxArraySize, 1001).
inline constexpr std::size_t max_shards = 100'000;

/// How many shards a campaign is cut into when nobody says: at least ten runs in each, since starting a shard costs
/// tens of milliseconds, and at most 1000, which Slurm's MaxArraySize allows where nobody raised it (slurm.conf(5)).
std::size_t default_shards(std::size_t runs);

/// Refuses what no engine could be given: no shard or too many, and paths or options with control characters, which
/// neither a line of a batch script nor a list of tasks can bear. The error has the code `usage`.
Result<void> check_task(const EngineTask& task);

/// The command of a shard but for its number: `… --shard` and `I/N` are to be added.
std::vector<std::string> shard_command(const EngineTask& task);

/// The command that merges what the shards left.
std::vector<std::string> gather_command(const EngineTask& task);

/// The name as engines take it: small letters, digits and single hyphens, at most 40 of them, "campaign" when none is
/// left.
std::string plain_name(const std::string& name);

}  // namespace skyloop::inline campaigns
