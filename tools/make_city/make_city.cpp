/// make_city: writes a made-up city as Wavefront OBJ, metres east, north and up, with a material and a group for each
/// kind of surface. The same options give the same bytes.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>

#include "world/scene/generated_city.hpp"

namespace {

namespace fs = std::filesystem;
using namespace skyloop;

constexpr std::size_t largest_city = 50'000'000;  // what a reader takes

struct Options {
    GeneratedCitySettings city;
    bool no_ground = false;
    std::string output;
};

void set_up(CLI::App& app, Options& options) {
    app.add_option("--triangles", options.city.triangles, "About so many triangles")
        ->check(CLI::Range(std::size_t{10}, largest_city))
        ->capture_default_str();
    app.add_flag("--windows", options.city.windows, "Recessed windows in every wall");
    app.add_option("--seed", options.city.seed, "Another seed, another city")->capture_default_str();
    app.add_option("--turned-blocks", options.city.turned_blocks, "Share of blocks that stand askew")
        ->check(CLI::Range(0.0, 1.0))
        ->capture_default_str();
    app.add_flag("--no-ground", options.no_ground, "Leave the ground out");
    app.add_option("--output", options.output, "The file to write, .obj")->required();
}

/// Text on its way into a file, in large pieces.
class ObjWriter {
public:
    explicit ObjWriter(const fs::path& path) : path_(path), file_(path, std::ios::binary) {
        if (!file_) throw std::runtime_error(path.string() + ": cannot be opened for writing");
    }

    template <class... Parts>
    void line(fmt::format_string<Parts...> format, Parts&&... parts) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Parts>(parts)...);
        text_.push_back('\n');
        if (text_.size() > piece) flush();
    }

    void finish() {
        flush();
        file_.close();
        if (!file_) throw std::runtime_error(path_.string() + ": cannot be written");
    }

private:
    static constexpr std::size_t piece = std::size_t{1} << 20;

    void flush() {
        file_.write(text_.data(), static_cast<std::streamsize>(text_.size()));
        text_.clear();
    }

    fs::path path_;
    std::ofstream file_;
    fmt::memory_buffer text_;
};

// Micrometres: what was plane stays plane within the millimetre that scenes merge by.
void write_obj(const CityModel& city, ObjWriter& obj) {
    for (const Eigen::Vector3d& v : city.vertices)
        obj.line("v {:.6f} {:.6f} {:.6f}", v.x(), v.y(), v.z());
    std::optional<SurfaceKind> kind;
    std::optional<std::uint8_t> material;
    for (const CityTriangle& t : city.triangles) {
        if (kind != t.kind) obj.line("g {}", surface_kind_names[static_cast<std::size_t>(t.kind)]);
        if (material != t.material) obj.line("usemtl {}", city.materials[t.material]);
        kind = t.kind;
        material = t.material;
        obj.line("f {} {} {}", t.corners[0] + 1, t.corners[1] + 1, t.corners[2] + 1);
    }
}

void make(const Options& options) {
    GeneratedCitySettings settings = options.city;
    settings.ground = !options.no_ground;
    const CityModel city = generated_city(settings, Geodetic{}).city;
    // Beside and then renamed: who is interrupted leaves no half city.
    const fs::path beside = options.output + ".part";
    ObjWriter obj(beside);
    obj.line("# A made-up city of {} triangles, seed {}{}; metres east, north, up", city.triangles.size(),
             settings.seed, settings.windows ? ", with windows" : "");
    write_obj(city, obj);
    obj.finish();
    fs::rename(beside, options.output);
    fmt::print("{}: {} triangles\n", options.output, city.triangles.size());
}

}  // namespace

int main(int count, char** arguments) {
    CLI::App app("Writes a made-up city as Wavefront OBJ.", "make_city");
    Options options;
    set_up(app, options);
    try {
        app.parse(count, arguments);
        make(options);
    } catch (const CLI::ParseError& reason) {
        return app.exit(reason) == 0 ? 0 : 2;
    } catch (const std::exception& reason) {
        std::cerr << "make_city: " << reason.what() << '\n';
        return 1;
    }
    return 0;
}
