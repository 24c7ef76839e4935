// The cache file of a city: a header, then counts and plain numbers as this kind of machine holds them.
#include <cstring>
#include <type_traits>

#include "base/core/digest.hpp"
#include "world/city/city_cache.hpp"

namespace skyloop {
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

}  // namespace skyloop
