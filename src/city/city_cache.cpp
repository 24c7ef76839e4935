#include "skyloop/city/city_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <system_error>

#include "skyloop/base/digest.hpp"
#include "skyloop/base/replace_file.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

constexpr int meaning_version = 4;  // of what readers make of a file; one more when any of them makes something else

Result<std::uint64_t> digest_of_file(const fs::path& path, std::uint64_t digest) {
    std::ifstream stream(path, std::ios::binary);
    std::string block(std::size_t{1} << 20, '\0');
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        digest = fnv1a_64({block.data(), static_cast<std::size_t>(stream.gcount())}, digest);
    }
    if (!stream.eof()) return fail(ErrorCode::outside, fmt::format("{}: cannot be read", path.string()));
    return digest;
}

bool is_part(const fs::path& part, bool of_folder) {
    return of_folder || part.extension() == ".ply" || part.extension() == ".bin";
}

// Files in a folder and in its folders, sorted; deeper ones are no part of a city.
std::vector<fs::path> parts_in(const fs::path& folder, bool all) {
    std::vector<fs::path> parts;
    std::error_code none;
    for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, none), end;
         !none && at != end; at.increment(none)) {
        if (at.depth() >= 1) at.disable_recursion_pending();
        std::error_code unknown;
        if (at->is_regular_file(unknown) && is_part(at->path(), all)) parts.push_back(at->path());
    }
    std::sort(parts.begin(), parts.end());
    return parts;
}

std::uint64_t cache_key(std::uint64_t source, const CityFileSettings& s) {
    std::string text = fmt::format("{} {:016x} {} {} {} {} {}", meaning_version, source, s.metres_per_unit, s.material,
                                   s.default_height, s.metres_per_level, s.most_triangles);
    if (s.origin)
        text += fmt::format(" at {} {} {}", s.origin->latitude.rad(), s.origin->longitude.rad(),
                            s.origin->height.above_ellipsoid.value());
    if (s.axes)
        for (std::size_t i = 0; i < 3; ++i)
            text += fmt::format(" axis {} {}", s.axes->axis[i], s.axes->sign[i]);
    return fnv1a_64(text);
}

std::optional<CityFile> load_cached(const fs::path& path, std::uint64_t key) {
    std::error_code unknown;
    const auto size = fs::file_size(path, unknown);
    if (unknown) return std::nullopt;
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!stream) return std::nullopt;
    return decode_city(bytes, key);
}

// Whether it can be done at all does not matter.
void keep_cached(const fs::path& path, const std::string& bytes) {
    std::error_code refused;
    fs::create_directories(path.parent_path(), refused);
    static_cast<void>(replace_file(path, bytes));
}

double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<std::uint64_t> city_source_digest(const fs::path& path) {
    std::error_code unknown;
    const bool folder = fs::is_directory(path, unknown);
    std::uint64_t digest = fnv1a_64("");
    std::vector<fs::path> parts;
    if (folder || path.extension() == ".xml" || path.extension() == ".gltf")
        parts = parts_in(folder ? path : path.parent_path().empty() ? "." : path.parent_path(), folder);
    if (!folder) parts.insert(parts.begin(), path);
    for (const fs::path& part : parts) {
        if (part != path) digest = fnv1a_64(part.lexically_proximate(path).string(), digest);
        const auto read = digest_of_file(part, digest);
        if (!read) return fail(read.error());
        digest = *read;
    }
    return digest;
}

fs::path cached_city_path(const fs::path& path, const CityCache& cache) {
    std::error_code unknown;
    const fs::path whole = fs::absolute(path, unknown).lexically_normal();
    const fs::path name = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
    return cache.folder / fmt::format("{}-{:016x}.skyloop-city", name.string(), fnv1a_64(whole.string()));
}

Result<CityReading> read_city(const fs::path& path, const CityFileSettings& settings, const CityCache& cache) {
    CityReading reading;
    const auto source = city_source_digest(path);
    const std::uint64_t key = source ? cache_key(*source, settings) : 0;
    const bool kept = source && !cache.folder.empty();
    const fs::path place = cached_city_path(path, cache);
    if (kept)
        if (auto cached = load_cached(place, key)) return CityReading{std::move(*cached), *source, true};
    const double before = steady_seconds();
    auto file = read_city(path, settings);
    if (!file) return fail(file.error());
    if (!source) return fail(source.error());
    if (kept && steady_seconds() - before >= cache.worth_seconds) keep_cached(place, encode_city(*file, key));
    return CityReading{std::move(*file), *source, false};
}

}  // namespace skyloop
