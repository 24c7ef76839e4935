/// The files that an engine gets, as texts with places to fill in.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop {

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

}  // namespace skyloop
