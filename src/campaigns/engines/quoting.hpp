/// Texts that reach another language whole: a shell, a batch script's options, YAML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/core/shell_word.hpp"

namespace skyloop {

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

}  // namespace skyloop
