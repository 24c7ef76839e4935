#include "base/core/text_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/core/archive.hpp"

namespace skyloop {
namespace {

constexpr std::size_t most_packing_adds = std::size_t{1} << 20;

tl::unexpected<Error> refuse_size(const std::string& name, std::size_t max_size) {
    return fail(ErrorCode::input,
                fmt::format("{}: has more than {} bytes of text, the most that is read", name, max_size));
}

Result<std::string> bytes_as_they_stand(const std::filesystem::path& path, std::size_t max_size) {
    const auto outside = [&](std::string_view what) {
        return fail(ErrorCode::outside, fmt::format("{}: {}", path.string(), what));
    };
    // A fifo or a device without a peer would hang a run before it starts.
    std::error_code reason;
    const auto status = std::filesystem::status(path, reason);
    if (reason) return outside(reason.message());
    if (!std::filesystem::is_regular_file(status)) return outside("is not a regular file");
    std::ifstream file(path, std::ios::binary);
    constexpr std::size_t block = std::size_t{1} << 16;
    std::string bytes;
    while (file) {
        const std::size_t had = bytes.size();
        bytes.resize(had + block);
        file.read(bytes.data() + had, block);
        bytes.resize(had + static_cast<std::size_t>(file.gcount()));
        // A small file may be larger when it is packed.
        if (bytes.size() > max_size && bytes.size() - max_size > most_packing_adds)
            return refuse_size(path.string(), max_size);
    }
    return file.eof() ? Result<std::string>(std::move(bytes)) : outside(std::strerror(errno));
}

using Unpacking = Result<std::string> (*)(std::string, const std::string&, std::size_t);

Result<std::string> read_through(Unpacking unpack, const std::filesystem::path& path, std::size_t max_size) {
    auto bytes = bytes_as_they_stand(path, max_size);
    auto text = bytes ? unpack(std::move(*bytes), path.string(), max_size) : std::move(bytes);
    return text && text->size() > max_size ? refuse_size(path.string(), max_size) : text;
}

}  // namespace

Result<std::string> read_uncompressed(const std::filesystem::path& path, std::size_t max_size) {
    return read_through(uncompressed, path, max_size);
}

Result<std::string> read_text_file(const std::filesystem::path& path, std::size_t max_size) {
    return read_through(unpacked, path, max_size);
}

std::string first_line_of(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::string line;
    std::getline(in, line);
    return line;
}

}  // namespace skyloop
