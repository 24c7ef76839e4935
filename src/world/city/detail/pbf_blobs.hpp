/// The frame of an OpenStreetMap PBF file, looked at before libosmium reads what is in it.
#pragma once

#include <string_view>

#include "base/core/result.hpp"

namespace skyloop {

/// Whether a file is a row of whole blobs, each with its type and size (OpenStreetMap wiki, "PBF Format": a length of
/// four bytes, a BlobHeader of at most 64 kB, a Blob of at most 32 MB). Fails with `input`, naming file and byte: a
/// file that was cut in the middle is told as that. libosmium 2.18 compares the type of a header that has none.
Result<void> check_pbf_blobs(std::string_view bytes, std::string_view name);

}  // namespace skyloop
