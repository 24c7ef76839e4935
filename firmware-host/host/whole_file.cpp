#include "whole_file.hpp"

#include "run/emulator/output_file.hpp"

namespace skyloop::host {

Result<void> write_whole_file(const std::filesystem::path& path, std::string_view text) {
    auto file = OutputFile::create(path);
    if (!file) return fail(file.error());
    file->write(text);
    file->flush();
    if (file->failure()) return fail(*file->failure());
    return {};
}

}  // namespace skyloop::host
