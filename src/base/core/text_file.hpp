/// Reading text files.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "base/core/result.hpp"

namespace skyloop {

/// Bytes after decompression beyond which a text file is refused.
inline constexpr std::size_t max_text_file_size = std::size_t{256} << 20;

/// The content of a file, unpacked when it is compressed (gzip, .Z, bzip2, xz, zstd) or an archive of one file (zip,
/// tar; but a KMZ stays one), as told by its content, not its name. Fails with `outside` when it cannot be opened or
/// read, with `input` when it is larger than `max_size`, or as unpacked() does.
Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_size = max_text_file_size);

/// The same, but archives stay what they are.
Result<std::string> read_uncompressed(const std::filesystem::path& path, std::size_t max_size = max_text_file_size);

/// The first line of a small file, as those of sysfs and procfs are; empty when there is none.
std::string first_line_of(const std::filesystem::path& file);

}  // namespace skyloop
