/// Reading text files, and what is in a folder.
/// Writing small files whole or not at all.
/// Making folders, or saying why not.
/// Files that are read and must not be written over.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"

namespace skyloop::inline base {

/// Bytes after decompression beyond which a text file is refused.
inline constexpr std::size_t max_text_file_size = std::size_t{256} << 20;

/// The content of a file, unpacked when it is compressed (gzip, .Z, bzip2, xz, zstd) or an archive of one file (zip,
/// tar; but a KMZ stays one), as told by its content, not its name. Fails with `outside` when it cannot be opened or
/// read, with `input` when it is larger than `max_size`, or as unpacked() does.
Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_size = max_text_file_size);

/// What `read` makes of that content and of the file's path as a name for messages. Fails as read_text_file and it do.
template <class Read>
auto read_text_with(const std::filesystem::path& path, Read read)
    -> decltype(read(std::string_view(), std::string_view())) {
    const Result<std::string> text = read_text_file(path);
    if (!text) return fail(text.error());
    return read(*text, path.string());
}

/// The same as read_text_file, but archives stay what they are.
Result<std::string> read_uncompressed(const std::filesystem::path& path, std::size_t max_size = max_text_file_size);

/// The first line of a small file, as those of sysfs and procfs are; empty when there is none.
std::string first_line_of(const std::filesystem::path& file);

/// The names in a folder, sorted; none when it is not there, or goes while it is read.
std::vector<std::string> names_in(const std::filesystem::path& folder);

/// Puts `content` into a file in one step: whoever reads meets the old file or the whole new one, also where several
/// write it at once or the program is killed. Of a link it is the file that the link leads to; a device or a pipe is
/// written to. Fails with `outside`; then the old file stands as it was, and nothing is left beside it.
Result<void> replace_file(const std::filesystem::path& path, std::string_view content);

/// Whether replace_file() can be done, as far as its folder tells, for who writes much later. Fails as that does;
/// changes nothing.
Result<void> check_replaceable(const std::filesystem::path& path);

/// Makes a folder and those above it, where they are not there yet. Tells whether it was made now. Fails with
/// `outside`.
Result<bool> make_folder(const std::filesystem::path& folder);

/// Fails with `usage` where a file to write is one of those that are read, also by a link: what was recorded there
/// would be lost. @param writer what messages call it: "--out"
Result<void> check_spares(std::string_view writer, const std::filesystem::path& out,
                          const std::vector<std::filesystem::path>& inputs);

}  // namespace skyloop::inline base
