// The cache file of a city: a header, then counts and plain numbers as this kind of machine holds them.
#include "world/city/city_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <system_error>
#include <type_traits>

#include "base/core/bytes.hpp"
#include "base/core/files.hpp"
#include "detail/companion_files.hpp"
#include "detail/earth_map.hpp"

namespace skyloop::inline world {
namespace {

constexpr std::uint32_t layout_version = 2;  // one more when a number is added, dropped or moved

struct CacheHeader {
    char name[8] = {'s', 'k', 'y', 'c', 'i', 't', 'y', '\n'};
    std::uint32_t byte_order = 0x01020304, version = layout_version;
    std::uint64_t key = 0, size = 0, digest = 0;  // of what follows
};
static_assert(sizeof(CacheHeader) == 40);

class CityWriter {
public:
    template <class... Values>
    void operator()(const Values&... values) {
        (put(values), ...);
    }
    template <class List, class Body>
    void list(const List& items, std::size_t /*bytes_each*/, Body body) {
        put(std::uint64_t{items.size()});
        for (const auto& item : items)
            body(item);
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    template <class Number>
    void put(const Number& value) {
        static_assert(std::is_arithmetic_v<Number>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void put(bool value) { put(static_cast<std::uint8_t>(value ? 1 : 0)); }
    void put(SurfaceKind value) { put(static_cast<std::uint8_t>(value)); }
    void put(const std::string& value) {
        put(std::uint64_t{value.size()});
        bytes_ += value;
    }

    std::string bytes_;
};

// Whatever the bytes are, it reads none beyond their end and believes no count that they cannot hold.
class CityReader {
public:
    explicit CityReader(std::string_view bytes) : bytes_(bytes) {}

    template <class... Values>
    void operator()(Values&... values) {
        (take(values), ...);
    }
    // Of items that take at least so many bytes each.
    template <class List, class Body>
    void list(List& items, std::size_t bytes_each, Body body) {
        const std::size_t size = count(bytes_each);
        items.clear();
        items.reserve(size);
        for (std::size_t i = 0; i < size && good_; ++i)
            body(items.emplace_back());
    }
    [[nodiscard]] bool finished() const { return good_ && bytes_.empty(); }

private:
    std::size_t count(std::size_t bytes_each) {
        std::uint64_t value = 0;
        take(value);
        if (value > bytes_.size() / bytes_each) good_ = false;
        return good_ ? static_cast<std::size_t>(value) : 0;
    }
    template <class Number>
    void take(Number& value) {
        static_assert(std::is_arithmetic_v<Number>);
        value = {};
        if (bytes_.size() < sizeof value) {
            good_ = false;
            return;
        }
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_.remove_prefix(sizeof value);
    }
    void take(bool& value) {
        std::uint8_t byte = 0;
        take(byte);
        value = byte != 0;
    }
    void take(SurfaceKind& value) {
        std::uint8_t byte = 0;
        take(byte);
        value = static_cast<SurfaceKind>(byte);
    }
    void take(std::string& value) {
        value = bytes_.substr(0, count(1));
        bytes_.remove_prefix(value.size());
    }

    std::string_view bytes_;
    bool good_ = true;
};

// The order of the numbers, for a writer of a const city and a reader of another.

template <class Archive, class Trees>
void exchange_foliage(Archive& archive, Trees& trees) {
    double ground = trees.ground.value_or(0);
    bool grounded = trees.ground.has_value();
    archive.list(trees.ring, 16, [&](auto& v) { archive(v.x(), v.y()); });
    archive(trees.base, trees.top, ground, grounded);
    if constexpr (!std::is_const_v<Trees>)
        if (grounded) trees.ground = ground;
}

template <class Archive, class Model>
void exchange_model(Archive& archive, Model& model) {
    double latitude = model.origin.latitude.rad(), longitude = model.origin.longitude.rad();
    double height = model.origin.height.above_ellipsoid.value();
    archive(latitude, longitude, height);
    if constexpr (!std::is_const_v<Model>)
        model.origin = {Angle::radians(latitude), Angle::radians(longitude), {Metres(height)}};
    archive.list(model.vertices, 24, [&](auto& v) { archive(v.x(), v.y(), v.z()); });
    archive.list(model.triangles, 14,
                 [&](auto& t) { archive(t.corners[0], t.corners[1], t.corners[2], t.kind, t.material); });
    archive.list(model.materials, 8, [&](auto& name) { archive(name); });
    archive.list(model.foliage, 33, [&](auto& trees) { exchange_foliage(archive, trees); });
    archive.list(model.grounded, 16, [&](auto& building) { archive(building.first, building.count, building.ground); });
}

template <class Archive, class Anchor>
void exchange_anchor(Archive& archive, Anchor& anchor) {
    MapAnchor known = anchor.value_or(MapAnchor{});
    bool present = anchor.has_value(), levelled = known.level.has_value();
    double level = known.level.value_or(0);
    archive(present, known.named, levelled, known.system, known.east, known.north, level);
    if constexpr (!std::is_const_v<Anchor>) {
        if (levelled) known.level = level;
        if (present) anchor = std::move(known);
    }
}

template <class Archive, class File>
void exchange_file(Archive& archive, File& file) {
    exchange_model(archive, file.model);
    archive(file.format, file.buildings, file.dropped);
    archive.list(file.warnings, 8, [&](auto& warning) { archive(warning); });
    archive.list(file.companions, 16, [&](auto& companion) { archive(companion.name, companion.digest); });
    exchange_anchor(archive, file.anchor);
}

bool consistent(const CityModel& model) {
    for (const CityTriangle& t : model.triangles) {
        if (static_cast<std::size_t>(t.kind) >= surface_kind_names.size()) return false;
        if (t.material >= model.materials.size()) return false;
        for (const std::uint32_t corner : t.corners)
            if (corner >= model.vertices.size()) return false;
    }
    for (const GroundedBuilding& building : model.grounded)
        if (std::uint64_t{building.first} + building.count > model.vertices.size()) return false;
    return true;
}

}  // namespace

std::string encode_city(const CityFile& file, std::uint64_t key) {
    CityWriter out;
    exchange_file(out, file);
    const std::string body = out.take();
    CacheHeader header;
    header.key = key;
    header.size = body.size();
    header.digest = fnv1a_64(body);
    return std::string(reinterpret_cast<const char*>(&header), sizeof header) + body;
}

std::optional<CityFile> decode_city(std::string_view bytes, std::uint64_t key) {
    CacheHeader expected, header;
    if (bytes.size() < sizeof header) return std::nullopt;
    std::memcpy(&header, bytes.data(), sizeof header);
    const std::string_view body = bytes.substr(sizeof header);
    expected.key = key;
    expected.size = body.size();
    expected.digest = header.digest;
    if (std::memcmp(&header, &expected, sizeof header) != 0 || fnv1a_64(body) != header.digest) return std::nullopt;
    CityReader in(body);
    CityFile file;
    exchange_file(in, file);
    if (!in.finished() || !consistent(file.model)) return std::nullopt;
    return file;
}

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

}  // namespace skyloop::inline world
