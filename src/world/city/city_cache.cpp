#include "world/city/city_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <system_error>

#include "base/core/digest.hpp"
#include "base/core/replace_file.hpp"
#include "detail/companion_files.hpp"
#include "detail/earth_map.hpp"

namespace skyloop {
namespace {

namespace fs = std::filesystem;

constexpr int meaning_version = 15;  // of what readers make of a file; one more when any of them makes something else

std::uint64_t cache_key(std::uint64_t source, const CityFileSettings& s) {
    std::string text = fmt::format("{} {:016x} {} {} {} {} {}", meaning_version, source, s.metres_per_unit, s.material,
                                   s.default_height, s.metres_per_level, s.most_triangles);
    if (s.origin)
        text += fmt::format(" at {} {} {}", s.origin->latitude.rad(), s.origin->longitude.rad(),
                            s.origin->height.above_ellipsoid.value());
    text += fmt::format(" less {} {} {}", s.file_origin.x(), s.file_origin.y(), s.file_origin.z());
    text += fmt::format(" heights {} {}", static_cast<int>(s.heights), s.geoid != nullptr);
    text += fmt::format(" crs {} {:016x}", s.file_crs, proj_data_digest());
    if (s.origin_is_guess) text += " guessed";
    if (s.anchor)
        text += fmt::format(" beside {} {} {} {}", s.anchor->system, s.anchor->east, s.anchor->north,
                            s.anchor->level.value_or(std::nan("")));
    if (s.axes)
        for (std::size_t i = 0; i < 3; ++i)
            text += fmt::format(" axis {} {}", s.axes->axis[i], s.axes->sign[i]);
    return fnv1a_64(text);
}

// What the files that a city names were when it was read, they are.
bool companions_stand(const CityFile& city, const fs::path& folder) {
    return std::all_of(city.companions.begin(), city.companions.end(), [&](const CityCompanion& companion) {
        const auto digest = digest_of_file(folder / companion.name);
        return digest && *digest == companion.digest;
    });
}

std::optional<CityFile> load_cached(const fs::path& path, std::uint64_t key, const fs::path& folder) {
    std::error_code unknown;
    const auto size = fs::file_size(path, unknown);
    if (unknown) return std::nullopt;
    std::ifstream stream(path, std::ios::binary);
    std::string bytes(size, '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(size));
    if (!stream) return std::nullopt;
    auto city = decode_city(bytes, key);
    return city && companions_stand(*city, folder) ? std::move(city) : std::nullopt;
}

// Whether it can be done at all does not matter.
void keep_cached(const fs::path& path, const std::string& bytes) {
    std::error_code refused;
    fs::create_directories(path.parent_path(), refused);
    static_cast<void>(replace_file(path, bytes));
}

CityReading reading_of(CityFile city, std::uint64_t digest, bool from_cache) {
    for (const CityCompanion& companion : city.companions)
        digest = fnv1a_64(fmt::format("{} {:016x}", companion.name, companion.digest), digest);
    return {std::move(city), digest, from_cache};
}

double steady_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<std::uint64_t> digest_of_file(const fs::path& path) {
    std::error_code unknown;  // nothing is opened that may have no end, or wait for a peer
    if (!fs::is_regular_file(path, unknown))
        return fail(ErrorCode::outside, fmt::format("{}: is not a regular file", path.string()));
    std::ifstream stream(path, std::ios::binary);
    std::string block(std::size_t{1} << 20, '\0');
    std::uint64_t digest = fnv1a_64("");
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        digest = fnv1a_64({block.data(), static_cast<std::size_t>(stream.gcount())}, digest);
    }
    if (!stream.eof()) return fail(ErrorCode::outside, fmt::format("{}: cannot be read", path.string()));
    return digest;
}

fs::path cached_city_path(const fs::path& path, const CityCache& cache) {
    std::error_code unknown;
    const fs::path whole = fs::absolute(path, unknown).lexically_normal();
    const fs::path name = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
    return cache.folder / fmt::format("{}-{:016x}.skyloop-city", name.string(), fnv1a_64(whole.string()));
}

Result<CityReading> read_city(const fs::path& path, const CityFileSettings& settings, const CityCache& cache) {
    const auto source = file_of_city(path);
    if (!source) return fail(source.error());
    const auto digest = digest_of_file(*source);
    const std::uint64_t key = digest ? cache_key(*digest, settings) : 0;
    const bool kept = digest && !cache.folder.empty();
    const fs::path place = cached_city_path(path, cache);
    if (kept)
        if (auto cached = load_cached(place, key, source->parent_path()))
            return reading_of(std::move(*cached), *digest, true);
    const double before = steady_seconds();
    auto file = read_city(path, settings);
    if (!file) return fail(file.error());
    if (!digest) return fail(digest.error());
    if (kept && steady_seconds() - before >= cache.worth_seconds) keep_cached(place, encode_city(*file, key));
    return reading_of(std::move(*file), *digest, false);
}

}  // namespace skyloop
