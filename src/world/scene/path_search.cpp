#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "detail/path_search.hpp"

namespace skyloop::inline world {

void SightLines::look(const UrbanScene& scene, const Eigen::Vector3d& antenna,
                      std::span<const SceneSatellite> satellites) {
    rays_.clear();
    satellite_.clear();
    blocked_.assign(satellites.size(), 1);
    for (std::uint32_t i = 0; i < satellites.size(); ++i) {
        const Eigen::Vector3d way = satellites[i].position - antenna;
        const double length = way.norm();
        if (!(length > 0 && std::isfinite(length))) continue;
        rays_.push_back({antenna, way / length});
        satellite_.push_back(i);
    }
    answers_.resize(rays_.size());
    scene.blocked(rays_, answers_);
    for (std::size_t i = 0; i < rays_.size(); ++i)
        blocked_[satellite_[i]] = answers_[i];
}

void SightLines::collect_targets(std::span<const SceneSatellite> satellites, bool blocked_only,
                                 std::vector<SearchTarget>& targets) const {
    targets.clear();
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        const std::uint32_t satellite = satellite_[i];
        if (blocked_only && seen(satellite)) continue;
        targets.push_back({satellites[satellite].id, satellite, satellites[satellite].position, rays_[i].direction});
    }
}

namespace {

// Rays of a search where paths are known already: the turning lattice finds the few that are new in some epochs.
constexpr int still_rays = 2048;
constexpr int most_rays = 1 << 22;
constexpr int usual_rays = 65536;
// A share of sloped walls beyond which elevations are not kept well enough for bands alone, and the rays then sent
// everywhere.
constexpr double sloped_walls = 0.03;
constexpr int everywhere_divisor = 16;
// Rays traced together: enough to keep packets full after many reflections, few enough to stay in a core's cache.
constexpr std::size_t chunk_rays = 2048;
// Neighbours of the lattice mostly meet the same wall at first.
constexpr int rounds_together = 1;

int rays_of(const PathSearchSettings& settings) {
    return settings.rays > 0 ? std::min(settings.rays, most_rays) : usual_rays;
}

bool upright_or_level(const Eigen::Vector3d& normal) {
    const double sine = std::sin(0.1 * std::numbers::pi / 180);
    return std::abs(normal.z()) < sine || normal.head<2>().norm() < sine;
}

// Share of the reflecting area that turns elevations into others: the largest among walls, roofs and ground, lest a
// wide flat ground hides steep roofs.
double reflecting_slope_share(const UrbanScene& scene, const ReflectionRules& rules) {
    std::array<double, 3> sloped{};
    std::array<double, 3> whole{};
    for (std::uint32_t i = 0; i < scene.statistics().triangles; ++i) {
        const ScenePlane& plane = scene.planes()[scene.plane_of(i)];
        const auto kind = static_cast<std::size_t>(plane.kind);
        if (!rules.reflects[kind]) continue;
        const auto [a, b, c] = scene.triangle(i);
        const double area = (b - a).cross(c - a).norm();
        whole[kind] += area;
        if (!upright_or_level(plane.normal)) sloped[kind] += area;
    }
    double share = 0;
    for (std::size_t kind = 0; kind < whole.size(); ++kind)
        if (whole[kind] > 0) share = std::max(share, sloped[kind] / whole[kind]);
    return share;
}

bool elevations_change(const UrbanScene& scene, const PathSearchSettings& settings) {
    const bool walls_alone = !settings.roofs_reflect && !settings.ground_reflects;
    const double share =
        walls_alone ? scene.statistics().sloped_share : reflecting_slope_share(scene, reflection_rules(settings));
    return share > sloped_walls;
}

// Vertical walls keep the elevation of a ray, level surfaces its size.
void add_bands(double elevation, double half_width, bool mirrored, std::vector<ElevationBand>& bands) {
    constexpr double zenith = std::numbers::pi / 2;
    const ElevationBand band{std::sin(std::max(elevation - half_width, -zenith)),
                             std::sin(std::min(elevation + half_width, zenith))};
    bands.push_back(band);
    if (mirrored) bands.push_back({-band.highest, -band.lowest});
}

double turn_of(std::uint64_t search) {
    const double turns = static_cast<double>(search) * std::numbers::sqrt2;
    return turns - std::floor(turns);
}

}  // namespace

PathSearch::Lattices PathSearch::lattices(int rays, bool slopes) const {
    Lattices made{RayLattice(rays), {}};
    if (slopes) made.everywhere.emplace(std::max(1, rays / everywhere_divisor));
    return made;
}

PathSearch::PathSearch(const UrbanScene& scene, const PathSearchSettings& settings, std::size_t workers)
    : scene_(scene),
      settings_(settings),
      rules_(reflection_rules(settings)),
      level_surfaces_(settings.roofs_reflect || settings.ground_reflects),
      least_cosine_(least_cosine(settings)),
      moving_(lattices(rays_of(settings), elevations_change(scene, settings))),
      still_(lattices(std::min(rays_of(settings), still_rays), moving_.everywhere.has_value())),
      scratch_(workers),
      refiner_(scene, settings) {}

void PathSearch::run(SearchCrew& crew) {
    sight_.look(scene_, request_.antenna, request_.satellites);
    sight_.collect_targets(request_.satellites, settings_.blocked_only, targets_);
    aim();
    const std::size_t count = (directions_.size() + chunk_rays - 1) / chunk_rays;
    if (chunks_.size() < count) chunks_.resize(count);
    crew.share(count, [this](std::size_t chunk, std::size_t worker) { trace_chunk(chunk, worker); });

    refiner_.begin(request_.antenna, targets_);
    refiner_.tried() = known_;
    effort_ = {directions_.size(), 0, 0};
    for (std::size_t chunk = 0; chunk < count; ++chunk) {
        effort_.segments += chunks_[chunk].segments;
        for (const Proposal& proposal : chunks_[chunk].proposals)
            refiner_.propose(proposal.target, planes_of(proposal.planes));
    }
    paths_.clear();
    refiner_.settle(paths_);
    order_paths(paths_);
    effort_.segments += refiner_.segments();
    effort_.candidates = refiner_.candidates();
    found_.clear();
    for (const FoundPath& path : paths_)
        found_.push_back({targets_[path.target].id, path.planes});
}

void PathSearch::aim() {
    const Lattices& lattices = request_.still ? still_ : moving_;
    const double turn = turn_of(request_.number);
    directions_.clear();
    bands_.clear();
    if (!settings_.banded && !targets_.empty()) bands_.push_back({level_surfaces_ ? -1.0 : 0.0, 1});
    for (const SearchTarget& target : targets_) {
        const double elevation = std::asin(std::clamp(target.direction.z(), -1.0, 1.0));
        add_bands(elevation, lattices.banded.spacing(), level_surfaces_, bands_);
    }
    merge_bands(bands_);
    lattices.banded.select(bands_, turn, directions_);
    if (!lattices.everywhere || targets_.empty()) return;
    const ElevationBand all{-1, 1};
    lattices.everywhere->select({&all, 1}, turn, directions_);
}

void PathSearch::trace_chunk(std::size_t chunk, std::size_t worker) {
    Scratch& scratch = scratch_[worker];
    ChunkResult& result = chunks_[chunk];
    const std::size_t last = std::min(directions_.size(), (chunk + 1) * chunk_rays);
    scratch.front.clear();
    for (std::size_t i = chunk * chunk_rays; i < last; ++i)
        scratch.front.add(request_.antenna, directions_[i]);
    result.segments = scratch.front.trace(scene_, rules_, rounds_together);
    result.proposals.clear();
    scratch.proposed.clear();
    for (const EscapedRay& ray : scratch.front.escaped()) {
        for (std::uint32_t target = 0; target < targets_.size(); ++target) {
            if (ray.direction.dot(targets_[target].direction) <= least_cosine_) continue;
            const std::span<const std::uint32_t> planes = scratch.front.planes(ray.ray);
            if (scratch.proposed.insert(sequence_key(targets_[target].id, planes)))
                result.proposals.push_back({target, to_sequence(planes)});
        }
    }
}

}  // namespace skyloop::inline world
