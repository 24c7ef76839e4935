/// Any bytes as a compressed file or an archive: one clear line, or no more than was allowed; never a crash or a hang.
#include "base/core/archive.hpp"

#include <cstdint>
#include <string>

#include "require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace skyloop;
    constexpr std::size_t largest = std::size_t{1} << 20;
    const std::string bytes(reinterpret_cast<const char*>(data), size);
    const auto text = unpacked(bytes, "fuzz", largest + size);
    if (!text) {
        require(text.error().code == ErrorCode::input && is_one_line(text.error().message));
        require(text.error().message.starts_with("fuzz"));
        return 0;
    }
    require(text->size() <= largest + size);
    if (!is_archive(bytes)) return 0;
    const auto files = archive_files(bytes, "fuzz", largest);
    if (!files) return 0;
    for (const auto& [name, content] : *files)
        require(name_inside(name) == name);
    return 0;
}
