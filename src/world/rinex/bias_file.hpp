/// SINEX files of biases.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/core/result.hpp"
#include "world/gnss/code_biases.hpp"

namespace skyloop::inline world {

/// Reads the code biases of satellites, OSB and DSB, of a SINEX BIAS file (S. Schaer, "SINEX_BIAS - Solution
/// (Software/technique) INdependent EXchange Format for GNSS Biases Version 1.00", 2016), which the files *.BIA, *.BSX
/// and *_DCB.BSX of the IGS's centres are; those of stations and of phases are passed over. Fails with `input` when the
/// text is of another kind, a line cannot be read, or there is no code bias of a satellite.
/// @param name of the file, for messages
Result<CodeBiases> read_biases(std::string_view text, std::string_view name);

/// The same for a file, packed or not. Fails as read_text_file and read_biases do.
Result<CodeBiases> read_bias_file(const std::filesystem::path& path);

}  // namespace skyloop::inline world
