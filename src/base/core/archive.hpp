/// Compressed data and archives, in memory: nothing is ever written to a disk.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "base/core/result.hpp"

namespace skyloop::inline base {

/// How often one thing may be packed into another.
inline constexpr int deepest_packing = 4;
/// More files than any archive has that is read here.
inline constexpr std::size_t most_archive_files = 100'000;
/// Times its packed size that data may have beyond 16 MiB; deflate reaches 1032 (zlib's technical details).
inline constexpr std::size_t most_unpacked_ratio = 2000;

/// The regular files of an archive by name, with '/' between folders.
using ArchiveFiles = std::map<std::string, std::string>;

/// Whether bytes begin as those of gzip, Unix compress (.Z), bzip2, xz or zstd do.
bool is_compressed(std::string_view bytes);

/// Whether bytes begin as a zip archive or a tar archive (ustar, pax, GNU) does.
bool is_archive(std::string_view bytes);

/// Whether a file of an archive is hidden, as those are that macOS puts beside others ("._town.xml").
bool is_hidden_file(std::string_view name);

/// The name inside a folder or an archive that a file gives for another, with plain slashes; nothing when it would lie
/// outside: an absolute path, a drive, a "..". Nothing for control characters either: messages quote names.
std::optional<std::string> name_inside(std::string_view name);

/// The bytes without their compression, as often as they were compressed. Fails with `input` and `name` when they are
/// damaged or cut, or pass `max_size`, most_unpacked_ratio or deepest_packing. Unix compress has no checksum and no
/// mark of its end: what is cut there is read as far as it goes.
Result<std::string> uncompressed(std::string bytes, const std::string& name, std::size_t max_size);

/// The files of a zip or tar archive that are `wanted` by name; links, folders and devices are left out. Fails with
/// `input` and NAME:FILE when a file is damaged, cut, encrypted, or named so that it leads out of the archive, when all
/// together pass `max_size` or most_unpacked_ratio, or there are more than most_archive_files.
Result<ArchiveFiles> archive_files(
    std::string_view bytes, const std::string& name, std::size_t max_size,
    const std::function<bool(std::string_view)>& wanted = [](std::string_view) { return true; });

/// What was packed: the bytes without compression and, of an archive, its only file, hidden ones aside. A KMZ stays the
/// archive that it is. Fails as the above do, and with `input` when an archive holds no file, or several.
Result<std::string> unpacked(std::string bytes, const std::string& name, std::size_t max_size);

}  // namespace skyloop::inline base
