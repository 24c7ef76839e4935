/// What paths in a city cost, and against what. All times are of the calling thread's processor.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <thread>

#include "bench/prefix_finder.hpp"
#include "bench/thread_time.hpp"
#include "support/random_sky.hpp"
#include "world/city/city_file.hpp"
#include "world/gnss/constants.hpp"
#include "world/propagation/wall_scattering.hpp"
#include "world/scene/generated_city.hpp"

namespace {

using namespace skyloop;
using bench::thread_seconds;
using Scene = std::shared_ptr<const UrbanScene>;
using Answers = std::vector<std::vector<SatellitePaths>>;

double quantile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}
double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum / static_cast<double>(std::max<std::size_t>(1, values.size()));
}

/// A place with its sky.
struct Viewpoint {
    Eigen::Vector3d place;
    std::vector<SceneSatellite> sky;
};

struct BenchCity {
    Scene scene;
    std::vector<Viewpoint> viewpoints;
};

constexpr int viewpoints_of_city = 12, satellites_of_viewpoint = 40;

BenchCity made_city(std::size_t triangles, bool windows = false) {
    GeneratedCitySettings settings;
    settings.triangles = triangles;
    settings.windows = windows;
    const GeneratedCity made = generated_city(settings, Geodetic{});
    BenchCity city{*UrbanScene::build(made.city), {}};
    for (std::size_t i = 0; i < viewpoints_of_city; ++i) {
        const Eigen::Vector3d& place = made.street_places[i];
        city.viewpoints.push_back({place, test::random_sky(satellites_of_viewpoint, place, 5000 + i)});
    }
    return city;
}

// Places over open ground with walls around.
BenchCity munich() {
    const auto file = read_city(std::filesystem::path(SKYLOOP_SHARED_DATA) / "city/munich.tar.gz", {});
    if (!file) return {};
    BenchCity city{*UrbanScene::build(file->model), {}};
    RandomStream random(5, "open places");
    while (city.viewpoints.size() < viewpoints_of_city) {
        const double east = 800 * random.uniform() - 400, north = 800 * random.uniform() - 400;
        const auto ground = city.scene->ground_at(east, north), top = city.scene->top_at(east, north);
        if (!ground || !top || *top > *ground + 0.01) continue;
        const Eigen::Vector3d place(east, north, *ground + 1.6);
        int walls = 0;
        for (int k = 0; k < 16; ++k)
            walls += city.scene->blocked({place, {std::sin(k * 0.3927), std::cos(k * 0.3927), 0}}, 60) ? 1 : 0;
        if (walls >= 8)
            city.viewpoints.push_back(
                {place, test::random_sky(satellites_of_viewpoint, place, city.viewpoints.size())});
    }
    return city;
}

PathSearchSettings at_once(int rays) {
    PathSearchSettings settings;
    settings.rays = rays;
    settings.search_ahead = false;
    return settings;
}

/// Every viewpoint by itself, none knowing of another: paths, seconds of each, stretches of rays.
struct Measured {
    Answers paths;
    std::vector<double> seconds;
    std::uint64_t segments = 0;
};

Measured measured(const BenchCity& city, const PathSearchSettings& settings, int passes = 3) {
    PathFinder finder(city.scene, settings);
    Measured result;
    GpsTime now = to_gps_time(2300, 0.0);
    for (int pass = 0; pass < passes; ++pass)
        for (const Viewpoint& viewpoint : city.viewpoints) {
            SceneObserver observer;
            observer.now = now = now + std::chrono::seconds(100);
            observer.position = viewpoint.place;
            const double begin = thread_seconds();
            result.paths.push_back(finder.epoch(observer, viewpoint.sky));
            result.seconds.push_back(thread_seconds() - begin);
        }
    result.segments = finder.counters().segments;
    return result;
}

bool same_path(const ScenePath& a, const ScenePath& b) {
    return a.planes.size() == b.planes.size() && std::abs(a.excess - b.excess) < 1e-4 &&
           (a.arrival - b.arrival).norm() < 1e-6;
}

/// The paths of far more rays, turned a few times.
Answers reference_paths(const BenchCity& city) {
    PathSearchSettings thorough = at_once(1 << 18);
    thorough.tolerance_deg = 15;
    thorough.most_hops = 12;
    const Answers passes = measured(city, thorough, 4).paths;
    Answers all(passes.begin(), passes.begin() + static_cast<std::ptrdiff_t>(city.viewpoints.size()));
    for (std::size_t i = city.viewpoints.size(); i < passes.size(); ++i)
        for (std::size_t s = 0; s < passes[i].size(); ++s) {
            std::vector<ScenePath>& known = all[i % city.viewpoints.size()][s].paths;
            for (const ScenePath& path : passes[i][s].paths)
                if (std::none_of(known.begin(), known.end(), [&](const ScenePath& k) { return same_path(k, path); }))
                    known.push_back(path);
        }
    return all;
}

double recall_of(const Answers& found, const Answers& reference, int most_reflections) {
    double all = 0, hit = 0;
    for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t s = 0; s < found[i].size(); ++s)
            for (const ScenePath& path : reference[i % reference.size()][s].paths) {
                if (path.reflections() > most_reflections) continue;
                const auto& got = found[i][s].paths;
                ++all;
                hit += std::any_of(got.begin(), got.end(), [&](const ScenePath& p) { return same_path(p, path); });
            }
    return all > 0 ? hit / all : 1;
}

void print_row(const char* ratio, double value, const char* target, const std::string& remark) {
    std::printf("| %-58s | %9.3g | %-7s | %s\n", ratio, value, target, remark.c_str());
    std::fflush(stdout);
}

template <class... Parts>
std::string text_of(const char* format, Parts... parts) {
    std::array<char, 200> text{};
    std::snprintf(text.data(), text.size(), format, parts...);
    return text.data();
}

/// The rays that one search of a viewpoint sends, followed one at a time.
void record_rays(const BenchCity& city, const Viewpoint& viewpoint, int rays, std::vector<SceneRay>& recorded) {
    const RayLattice lattice(rays);
    std::vector<ElevationBand> bands;
    for (const SceneSatellite& satellite : viewpoint.sky) {
        const Eigen::Vector3d u = (satellite.position - viewpoint.place).normalized();
        const double elevation = std::asin(u.z()), most = std::numbers::pi / 2;
        if (city.scene->blocked({viewpoint.place, u}))
            bands.push_back({std::sin(std::max(elevation - lattice.spacing(), -most)),
                             std::sin(std::min(elevation + lattice.spacing(), most))});
    }
    merge_bands(bands);
    std::vector<Eigen::Vector3d> directions;
    lattice.select(bands, 0, directions);
    std::vector<SceneRay> front;
    for (const Eigen::Vector3d& direction : directions)
        front.push_back({viewpoint.place, direction});
    for (int round = 0; round <= most_reflections && !front.empty(); ++round) {
        recorded.insert(recorded.end(), front.begin(), front.end());
        std::size_t left = 0;
        for (SceneRay ray : front) {
            const SceneHit hit = city.scene->first_hit(ray);
            if (!hit.any() || city.scene->planes()[hit.plane].kind != SurfaceKind::wall) continue;
            const Eigen::Vector3d& normal = city.scene->planes()[hit.plane].normal;
            const double towards = normal.dot(ray.direction);
            ray.origin += hit.distance * ray.direction + (towards > 0 ? -2e-3 : 2e-3) * normal;
            ray.direction -= 2 * towards * normal;
            front[left++] = ray;
        }
        front.resize(left);
    }
}

void segments_against_raw(const BenchCity& city, const char* name, const char* target) {
    constexpr int rays = 32768;
    std::vector<SceneRay> recorded;
    for (const Viewpoint& viewpoint : city.viewpoints)
        record_rays(city, viewpoint, rays, recorded);
    std::vector<double> ours, raw;
    for (int repetition = 0; repetition < 5; ++repetition) {
        const Measured search = measured(city, at_once(rays), 1);
        ours.push_back(static_cast<double>(search.segments) / (mean(search.seconds) * viewpoints_of_city));
        int hits = 0;
        const double begin = thread_seconds();
        for (const SceneRay& ray : recorded)
            hits += city.scene->first_hit(ray).any() ? 1 : 0;
        raw.push_back(static_cast<double>(recorded.size()) / (thread_seconds() - begin));
        benchmark::DoNotOptimize(hits);
    }
    print_row(name, median(ours) / median(raw), target,
              text_of("%.2f ÷ %.2f million a second, %zu rays recorded", median(ours) / 1e6, median(raw) / 1e6,
                      recorded.size()));
}

void against_prefix_tests(const BenchCity& city, const Answers& reference) {
    const PathSearchSettings settings = at_once(8192);
    bench::PrefixFinder prefix(*city.scene, settings);
    Measured usual;
    for (const Viewpoint& viewpoint : city.viewpoints) {
        const double begin = thread_seconds();
        usual.paths.push_back(prefix.epoch(viewpoint.place, viewpoint.sky));
        usual.seconds.push_back(thread_seconds() - begin);
    }
    const Measured ours = measured(city, settings);
    print_row(
        "prefix-testing finder ÷ ours, 8192 rays each", mean(usual.seconds) / mean(ours.seconds), ">= 20",
        text_of("%.1f ÷ %.2f ms, recall to k 8 %.3f, ours %.3f", 1e3 * mean(usual.seconds), 1e3 * mean(ours.seconds),
                recall_of(usual.paths, reference, 8), recall_of(ours.paths, reference, 8)));
}

void banded_against_unbanded(const BenchCity& city, const Answers& reference) {
    PathSearchSettings settings = at_once(32768);
    const Measured with = measured(city, settings);
    settings.banded = false;
    const Measured without = measured(city, settings);
    print_row("banded ÷ unbanded, 32768 rays", mean(with.seconds) / mean(without.seconds), "<= .40",
              text_of("recall to k 8 %.4f, unbanded %.4f", recall_of(with.paths, reference, 8),
                      recall_of(without.paths, reference, 8)));
}

/// An epoch of a caller whose search another thread does: what is left is to look at the satellites and the known
/// paths.
std::vector<double> revalidation_seconds(const BenchCity& city, int rays) {
    PathSearchSettings settings;
    settings.rays = rays;
    settings.threads = 1;
    std::vector<double> seconds;
    for (const Viewpoint& viewpoint : city.viewpoints) {
        PathFinder finder(city.scene, settings);
        SceneObserver observer;
        observer.position = viewpoint.place;
        std::vector<double> here;
        for (int epoch = 0; epoch < 12; ++epoch) {
            observer.now = to_gps_time(2300, 0.1 * epoch);
            const double begin = thread_seconds();
            finder.epoch(observer, viewpoint.sky);
            if (epoch >= 2) here.push_back(thread_seconds() - begin);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        seconds.push_back(median(here));
    }
    return seconds;
}

void cold_against_warm(const BenchCity& city) {
    const double cold = median(measured(city, at_once(65536)).seconds);
    const double warm = median(revalidation_seconds(city, 65536));
    print_row("cold epoch of 65536 rays ÷ warm re-validation", cold / warm, ">= 300",
              text_of("%.2f ms ÷ %.1f us", 1e3 * cold, 1e6 * warm));
}

void large_against_small(const BenchCity& large, const BenchCity& small) {
    const double a = median(measured(large, at_once(16384)).seconds);
    const double b = median(measured(small, at_once(16384)).seconds);
    print_row("epoch in 1M ÷ in 10k triangles, 16384 rays", a / b, "<= 1.6",
              text_of("%.2f ÷ %.2f ms", 1e3 * a, 1e3 * b));
}

// A receiver at rest: the fewest rays that find enough alone, against what it does with its memory.
void static_memory(const BenchCity& city, const Answers& reference) {
    int rays = 1024;
    Measured alone;
    do {
        rays *= 2;
        alone = measured(city, at_once(rays));
    } while (recall_of(alone.paths, reference, 4) < 0.999 && rays < 1 << 18);
    PathSearchSettings settings;
    settings.rays = 65536;
    Measured memory;
    for (const Viewpoint& viewpoint : city.viewpoints) {
        PathFinder finder(city.scene, settings);
        SceneObserver observer;
        observer.position = viewpoint.place;
        for (int epoch = 0; epoch < 40; ++epoch) {
            observer.now = to_gps_time(2300, 0.1 * epoch);
            const double begin = thread_seconds();
            auto paths = finder.epoch(observer, viewpoint.sky);
            if (epoch < 20) continue;
            memory.seconds.push_back(thread_seconds() - begin);
            if (epoch == 39) memory.paths.push_back(std::move(paths));
        }
    }
    print_row("at rest, uncached ÷ cached, both with recall >= .999", mean(alone.seconds) / mean(memory.seconds),
              ">= 3",
              text_of("%d rays %.2f ms ÷ %.2f ms, recall to k 4 %.4f, cached %.4f", rays, 1e3 * mean(alone.seconds),
                      1e3 * mean(memory.seconds), recall_of(alone.paths, reference, 4),
                      recall_of(memory.paths, reference, 4)));
}

// Every path of the city against the satellite's image in long double.
void closed_form_error(const BenchCity& city) {
    using LongVector = Eigen::Matrix<long double, 3, 1>;
    double largest = 0;
    int paths = 0;
    const Measured found = measured(city, at_once(65536), 1);
    for (std::size_t i = 0; i < found.paths.size(); ++i)
        for (std::size_t s = 0; s < found.paths[i].size(); ++s)
            for (const ScenePath& path : found.paths[i][s].paths) {
                const LongVector antenna = city.viewpoints[i].place.cast<long double>();
                const LongVector satellite = city.viewpoints[i].sky[s].position.cast<long double>();
                LongVector image = satellite;
                for (std::size_t k = path.planes.size(); k-- > 0;) {
                    const ScenePlane& plane = city.scene->planes()[path.planes[k]];
                    const LongVector normal = plane.normal.cast<long double>();
                    image -= 2 * (normal.dot(image) - plane.offset) * normal;
                }
                const long double excess = (image - antenna).norm() - (satellite - antenna).norm();
                largest = std::max(largest, std::abs(static_cast<double>(excess) - path.excess));
                ++paths;
            }
    print_row("largest error of the excess against images, m", largest, "<= 1e-6", text_of("%d paths", paths));
}

void city_ratios(benchmark::State& state) {
    for (auto _ : state) {
        const BenchCity small = made_city(10'000), large = made_city(1'000'000), windows = made_city(1'000'000, true);
        const Answers reference = reference_paths(large);
        std::printf("| %-58s | measured  | target  |\n", "ratio");
        segments_against_raw(large, "segments a second ÷ raw intersect1, 1M", ">= 1.0");
        segments_against_raw(windows, "segments a second ÷ raw intersect1, 1M with windows", ">= .85");
        against_prefix_tests(large, reference);
        banded_against_unbanded(large, reference);
        cold_against_warm(large);
        large_against_small(large, small);
        static_memory(large, reference);
        closed_form_error(large);
    }
}
BENCHMARK(city_ratios)->Name("City/ratios")->Iterations(1)->Unit(benchmark::kSecond);

/// A straight drive from a viewpoint in the direction that is free the longest.
struct Drive {
    Eigen::Vector3d from, velocity;
};

Drive free_drive(const BenchCity& city, double seconds, double speed) {
    Drive best{city.viewpoints[0].place, Eigen::Vector3d::Zero()};
    double furthest = 0;
    for (const Viewpoint& viewpoint : city.viewpoints)
        for (int k = 0; k < 72; ++k) {
            const Eigen::Vector3d way(std::sin(k * 0.0872665), std::cos(k * 0.0872665), 0);
            const SceneHit hit = city.scene->first_hit({viewpoint.place, way});
            const double free = hit.any() ? hit.distance : 1e4;
            if (free > furthest) {
                furthest = free;
                best = {viewpoint.place, way * std::min(speed, (free - 2) / seconds)};
            }
            if (furthest > speed * seconds + 2) return best;
        }
    return best;
}

void drive(benchmark::State& state, const BenchCity& city, double hz) {
    constexpr double seconds = 20;
    const Drive way = free_drive(city, seconds, 12);
    const auto sky = test::random_sky(satellites_of_viewpoint, way.from, 99);
    for (auto _ : state)
        for (const int threads : {0, 1}) {
            PathSearchSettings settings;
            settings.rays = default_rays(hz);
            settings.threads = threads;
            PathFinder finder(city.scene, settings);
            WallScattering scattering(*city.scene, {});
            std::vector<double> spent;
            double paths = 0;
            for (int epoch = 0; epoch < seconds * hz; ++epoch) {
                SceneObserver observer;
                observer.now = to_gps_time(2300, epoch / hz);
                observer.velocity = way.velocity;
                observer.position = way.from + epoch / hz * way.velocity;
                const double begin = thread_seconds();
                const auto found = finder.epoch(observer, sky);
                scattering.look_around(observer);
                for (const SceneSatellite& satellite : sky)
                    benchmark::DoNotOptimize(scattering.of(satellite, Hertz(carrier_frequency_l1)));
                if (epoch > 0) spent.push_back(thread_seconds() - begin);
                for (const SatellitePaths& satellite : found)
                    paths += static_cast<double>(satellite.paths.size());
            }
            const std::string kind = threads == 0 ? "all_" : "caller_";
            state.counters[kind + "median_ms"] = 1e3 * median(spent);
            state.counters[kind + "p99_ms"] = 1e3 * quantile(spent, 0.99);
            if (threads == 0) state.counters["share_of_core"] = mean(spent) * hz;
            state.counters["paths"] = paths / (seconds * hz);
            state.counters["speed"] = way.velocity.norm();
        }
}

void city_drive_1m(benchmark::State& state) { drive(state, made_city(1'000'000), static_cast<double>(state.range(0))); }
BENCHMARK(city_drive_1m)->Name("City/drive_1M_hz")->Arg(10)->Arg(25)->Iterations(1)->Unit(benchmark::kSecond);

void city_drive_munich(benchmark::State& state) {
    const BenchCity city = munich();
    if (!city.scene) return state.SkipWithError("shared data absent or unreadable: city/munich.tar.gz");
    drive(state, city, static_cast<double>(state.range(0)));
}
BENCHMARK(city_drive_munich)->Name("City/drive_Munich_hz")->Arg(10)->Arg(25)->Iterations(1)->Unit(benchmark::kSecond);

}  // namespace
