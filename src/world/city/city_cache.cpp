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
    template <class Number>
    void number(Number value) {
        static_assert(std::is_arithmetic_v<Number>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void count(std::size_t value) { number<std::uint64_t>(value); }
    void text(const std::string& value) {
        count(value.size());
        bytes_ += value;
    }
    template <class List, class Body>
    void list(const List& items, Body body) {
        count(items.size());
        for (const auto& item : items)
            body(item);
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

// Whatever the bytes are, it reads none beyond their end and believes no count that they cannot hold.
class CityReader {
public:
    explicit CityReader(std::string_view bytes) : bytes_(bytes) {}

    template <class Number>
    Number number() {
        Number value{};
        if (bytes_.size() < sizeof value) {
            good_ = false;
            return value;
        }
        std::memcpy(&value, bytes_.data(), sizeof value);
        bytes_.remove_prefix(sizeof value);
        return value;
    }
    // Of items that take at least so many bytes each.
    std::size_t count(std::size_t bytes_each) {
        const auto value = number<std::uint64_t>();
        if (value > bytes_.size() / bytes_each) good_ = false;
        return good_ ? static_cast<std::size_t>(value) : 0;
    }
    std::string text() {
        const std::size_t size = count(1);
        std::string value(bytes_.substr(0, size));
        bytes_.remove_prefix(size);
        return value;
    }
    template <class List, class Body>
    void list(List& items, std::size_t bytes_each, Body body) {
        const std::size_t size = count(bytes_each);
        items.clear();
        items.reserve(size);
        for (std::size_t i = 0; i < size && good_; ++i)
            items.push_back(body());
    }
    [[nodiscard]] bool finished() const { return good_ && bytes_.empty(); }

private:
    std::string_view bytes_;
    bool good_ = true;
};

void write_model(CityWriter& out, const CityModel& model) {
    out.number(model.origin.latitude.rad());
    out.number(model.origin.longitude.rad());
    out.number(model.origin.height.above_ellipsoid.value());
    out.list(model.vertices, [&](const Eigen::Vector3d& v) {
        for (const double part : {v.x(), v.y(), v.z()})
            out.number(part);
    });
    out.list(model.triangles, [&](const CityTriangle& t) {
        for (const std::uint32_t corner : t.corners)
            out.number(corner);
        out.number(static_cast<std::uint8_t>(t.kind));
        out.number(t.material);
    });
    out.list(model.materials, [&](const std::string& name) { out.text(name); });
    out.list(model.foliage, [&](const FoliageVolume& trees) {
        out.list(trees.ring, [&](const Eigen::Vector2d& v) {
            out.number(v.x());
            out.number(v.y());
        });
        for (const double part : {trees.base, trees.top, trees.ground.value_or(0)})
            out.number(part);
        out.number(static_cast<std::uint8_t>(trees.ground ? 1 : 0));
    });
    out.list(model.grounded, [&](const GroundedBuilding& building) {
        out.number(building.first);
        out.number(building.count);
        out.number(building.ground);
    });
}

CityTriangle read_triangle(CityReader& in) {
    CityTriangle t;
    for (std::uint32_t& corner : t.corners)
        corner = in.number<std::uint32_t>();
    t.kind = static_cast<SurfaceKind>(in.number<std::uint8_t>());
    t.material = in.number<std::uint8_t>();
    return t;
}

FoliageVolume read_foliage(CityReader& in) {
    FoliageVolume trees;
    in.list(trees.ring, 16, [&] {
        const double east = in.number<double>(), north = in.number<double>();
        return Eigen::Vector2d(east, north);
    });
    double ground = 0;
    for (double* part : {&trees.base, &trees.top, &ground})
        *part = in.number<double>();
    if (in.number<std::uint8_t>() != 0) trees.ground = ground;
    return trees;
}

GroundedBuilding read_grounded(CityReader& in) {
    GroundedBuilding building;
    building.first = in.number<std::uint32_t>();
    building.count = in.number<std::uint32_t>();
    building.ground = in.number<double>();
    return building;
}

CityModel read_model(CityReader& in) {
    CityModel model;
    model.origin.latitude = Angle::radians(in.number<double>());
    model.origin.longitude = Angle::radians(in.number<double>());
    model.origin.height = {Metres(in.number<double>())};
    in.list(model.vertices, 24, [&] {
        const double x = in.number<double>(), y = in.number<double>(), z = in.number<double>();
        return Eigen::Vector3d(x, y, z);
    });
    in.list(model.triangles, 14, [&] { return read_triangle(in); });
    in.list(model.materials, 8, [&] { return in.text(); });
    in.list(model.foliage, 33, [&] { return read_foliage(in); });
    in.list(model.grounded, 16, [&] { return read_grounded(in); });
    return model;
}

void write_anchor(CityWriter& out, const std::optional<MapAnchor>& anchor) {
    const MapAnchor known = anchor.value_or(MapAnchor{});
    for (const bool part : {anchor.has_value(), known.named, known.level.has_value()})
        out.number(static_cast<std::uint8_t>(part ? 1 : 0));
    out.text(known.system);
    for (const double part : {known.east, known.north, known.level.value_or(0)})
        out.number(part);
}

std::optional<MapAnchor> read_anchor(CityReader& in) {
    MapAnchor anchor;
    bool present = false, levelled = false;
    for (bool* part : {&present, &anchor.named, &levelled})
        *part = in.number<std::uint8_t>() != 0;
    anchor.system = in.text();
    double level = 0;
    for (double* part : {&anchor.east, &anchor.north, &level})
        *part = in.number<double>();
    if (levelled) anchor.level = level;
    return present ? std::optional<MapAnchor>(std::move(anchor)) : std::nullopt;
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
    write_model(out, file.model);
    out.text(file.format);
    out.count(file.buildings);
    out.count(file.dropped);
    out.list(file.warnings, [&](const std::string& warning) { out.text(warning); });
    out.list(file.companions, [&](const CityCompanion& companion) {
        out.text(companion.name);
        out.number(companion.digest);
    });
    write_anchor(out, file.anchor);
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
    file.model = read_model(in);
    file.format = in.text();
    file.buildings = static_cast<std::size_t>(in.number<std::uint64_t>());
    file.dropped = static_cast<std::size_t>(in.number<std::uint64_t>());
    in.list(file.warnings, 8, [&] { return in.text(); });
    in.list(file.companions, 16, [&] {
        std::string name = in.text();
        return CityCompanion{std::move(name), in.number<std::uint64_t>()};
    });
    file.anchor = read_anchor(in);
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
