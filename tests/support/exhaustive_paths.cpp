#include "support/exhaustive_paths.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace skyloop::test {
namespace {

using LongVector = Eigen::Matrix<long double, 3, 1>;
using Sequence = InplaceVector<std::uint32_t, most_reflections>;

constexpr int most_tried = 3;
constexpr double off_the_wall = 2e-3;    // where a reflected ray begins, m
constexpr double box_margin = 5e-3;      // a facet lies within the merge tolerance of its plane, m
constexpr double same_direction = 1e-9;  // rad: of a path and of what its tracing unfolds to
constexpr double same_orientation = 1e-7;
constexpr double near_satellite = 1e-3;  // rad: far more than a satellite's finite distance turns a ray

template <class Vector>
Vector mirror_image(const Vector& point, const ScenePlane& plane) {
    const Vector normal = plane.normal.cast<typename Vector::Scalar>();
    return point - 2 * (normal.dot(point) - plane.offset) * normal;
}

Eigen::Vector3d reflected(const Eigen::Vector3d& direction, const Eigen::Vector3d& normal) {
    return direction - 2 * normal.dot(direction) * normal;
}

/// A plane that reflects, and the box around its facets.
struct Reflector {
    std::uint32_t plane = 0;
    Eigen::Vector3d normal;
    double offset = 0;
    Eigen::Vector3d low, high;
    double antenna_side = 0;  ///< normal · antenna

    [[nodiscard]] bool holds(const Eigen::Vector3d& p) const {
        return p.x() >= low.x() && p.x() <= high.x() && p.y() >= low.y() && p.y() <= high.y() && p.z() >= low.z() &&
               p.z() <= high.z();
    }
};

bool reflects(SurfaceKind kind, const PathSearchSettings& settings) {
    switch (kind) {
        case SurfaceKind::wall:
            return settings.walls_reflect;
        case SurfaceKind::roof:
            return settings.roofs_reflect;
        case SurfaceKind::ground:
            return settings.ground_reflects;
    }
    return false;
}

std::vector<Reflector> reflectors(const UrbanScene& scene, const PathSearchSettings& settings,
                                  const Eigen::Vector3d& antenna) {
    constexpr double far = std::numeric_limits<double>::infinity();
    std::vector<Reflector> of_plane(scene.planes().size());
    for (std::uint32_t i = 0; i < of_plane.size(); ++i) {
        const ScenePlane& plane = scene.planes()[i];
        of_plane[i] = {i,
                       plane.normal,
                       plane.offset,
                       Eigen::Vector3d::Constant(far),
                       Eigen::Vector3d::Constant(-far),
                       plane.normal.dot(antenna)};
    }
    for (std::uint32_t t = 0; t < scene.statistics().triangles; ++t) {
        Reflector& reflector = of_plane[scene.plane_of(t)];
        for (const Eigen::Vector3d& corner : scene.triangle(t)) {
            reflector.low = reflector.low.cwiseMin((corner.array() - box_margin).matrix());
            reflector.high = reflector.high.cwiseMax((corner.array() + box_margin).matrix());
        }
    }
    std::erase_if(of_plane, [&](const Reflector& r) { return !reflects(scene.planes()[r.plane].kind, settings); });
    return of_plane;
}

/// One satellite seen from one antenna.
class ExhaustiveSearch {
public:
    ExhaustiveSearch(const UrbanScene& scene, const SceneObserver& observer, const SceneSatellite& satellite,
                     const PathSearchSettings& settings)
        : scene_(scene), observer_(observer), satellite_(satellite), settings_(settings) {}

    void try_single(const std::vector<Reflector>& all) {
        for (const Reflector& a : all)
            if (meets(a, satellite_.position)) verify(sequence_of({a.plane}));
    }

    // The satellite mirrored by the last plane, then by the first; the way back cuts the first plane, then the last.
    void try_pairs(const std::vector<Reflector>& all) {
        for (const Reflector& b : all) {
            const Eigen::Vector3d image = mirror_image(satellite_.position, scene_.planes()[b.plane]);
            for (const Reflector& a : all)
                if (a.plane != b.plane && meets(a, image) && goes_on(a, b, image))
                    verify(sequence_of({a.plane, b.plane}));
        }
    }

    // R1 u, R1 R2 u and R1 R2 R3 u; u itself stands for two parallel walls.
    void try_orientations(const std::vector<Eigen::Vector3d>& normals) {
        const Eigen::Vector3d u = (satellite_.position - observer_.position).normalized();
        launch(u);
        for (const Eigen::Vector3d& c : normals) {
            const Eigen::Vector3d d2 = reflected(u, c);
            launch(d2);
            for (const Eigen::Vector3d& b : normals) {
                if (&b == &c) continue;
                const Eigen::Vector3d d1 = reflected(d2, b);
                launch(d1);
                for (const Eigen::Vector3d& a : normals)
                    if (&a != &b) launch(reflected(d1, a));
            }
        }
    }

    std::vector<ScenePath> sorted() && {
        std::sort(paths_.begin(), paths_.end(), [](const ScenePath& a, const ScenePath& b) {
            return a.planes.size() != b.planes.size() ? a.planes.size() < b.planes.size() : a.excess < b.excess;
        });
        return std::move(paths_);
    }

private:
    /// What becomes of a ray.
    struct Traced {
        Sequence planes;
        Eigen::Vector3d leaving;
        bool escaped = false;
    };

    static Sequence sequence_of(std::initializer_list<std::uint32_t> planes) {
        Sequence result;
        for (const std::uint32_t plane : planes)
            result.push_back(plane);
        return result;
    }

    // Where the segment from the antenna to the source's image cuts the plane, when antenna and source are on one side.
    static double cut(const Reflector& a, const Eigen::Vector3d& source) {
        const double before = a.offset - a.antenna_side, behind = a.offset - a.normal.dot(source);
        return before * behind > 0 ? before / (before + behind) : -1;
    }

    [[nodiscard]] Eigen::Vector3d cut_point(const Reflector& a, const Eigen::Vector3d& source) const {
        const Eigen::Vector3d image = source + 2 * (a.offset - a.normal.dot(source)) * a.normal;
        return observer_.position + cut(a, source) * (image - observer_.position);
    }

    [[nodiscard]] bool meets(const Reflector& a, const Eigen::Vector3d& source) const {
        return cut(a, source) > 0 && a.holds(cut_point(a, source));
    }

    [[nodiscard]] bool goes_on(const Reflector& a, const Reflector& b, const Eigen::Vector3d& image) const {
        const Eigen::Vector3d first = cut_point(a, image), way = image - first;
        const double t = (b.offset - b.normal.dot(first)) / b.normal.dot(way);
        return t > 0 && t < 1 && b.holds(first + t * way);
    }

    [[nodiscard]] Traced trace(Eigen::Vector3d direction) const {
        Traced result;
        Eigen::Vector3d from = observer_.position;
        const int most = std::min(settings_.most_reflections, most_tried);
        for (;;) {
            result.leaving = direction;
            const SceneHit hit = scene_.first_hit({from, direction});
            if (!hit.any()) {
                result.escaped = true;
                return result;
            }
            const ScenePlane& plane = scene_.planes()[hit.plane];
            if (!reflects(plane.kind, settings_) || static_cast<int>(result.planes.size()) >= most) return result;
            result.planes.push_back(hit.plane);
            const double against = plane.normal.dot(direction);
            from += hit.distance * direction + (against > 0 ? -off_the_wall : off_the_wall) * plane.normal;
            direction = reflected(direction, plane.normal);
        }
    }

    void launch(const Eigen::Vector3d& direction) {
        const Traced traced = trace(direction);
        const Eigen::Vector3d u = (satellite_.position - observer_.position).normalized();
        if (traced.escaped && !traced.planes.empty() && (traced.leaving - u).norm() < near_satellite)
            verify(traced.planes);
    }

    [[nodiscard]] LongVector image_through(const Sequence& planes) const {
        LongVector image = satellite_.position.cast<long double>();
        for (std::size_t i = planes.size(); i-- > 0;)
            image = mirror_image(image, scene_.planes()[planes[i]]);
        return image;
    }

    /// Keeps the path when its ray, traced, runs as unfolded.
    void verify(const Sequence& planes) {
        const LongVector antenna = observer_.position.cast<long double>();
        const LongVector way = image_through(planes) - antenna;
        const Eigen::Vector3d arrival = way.normalized().cast<double>();
        const Traced traced = trace(arrival);
        if (!traced.escaped || traced.planes.empty()) return;
        const LongVector again = image_through(traced.planes) - antenna;
        if ((again.normalized() - way.normalized()).norm() > same_direction) return;
        const LongVector straight = satellite_.position.cast<long double>() - antenna;
        ScenePath path;
        path.planes = traced.planes;
        path.arrival = arrival;
        path.excess = static_cast<double>(again.norm() - straight.norm());
        // The rate at which |S − P'| − |S − P| changes, by the directions at both ends.
        const Eigen::Vector3d sight = straight.normalized().cast<double>();
        path.excess_rate =
            (sight - arrival).dot(observer_.velocity) + (traced.leaving - sight).dot(satellite_.velocity);
        const bool known = std::any_of(paths_.begin(), paths_.end(), [&](const ScenePath& p) {
            return p.planes.size() == path.planes.size() && std::abs(p.excess - path.excess) < 1e-6 &&
                   (p.arrival - path.arrival).norm() < 1e-8;
        });
        if (!known) paths_.push_back(path);
    }

    const UrbanScene& scene_;
    const SceneObserver& observer_;
    const SceneSatellite& satellite_;
    const PathSearchSettings& settings_;
    std::vector<ScenePath> paths_;
};

std::vector<Eigen::Vector3d> orientations(const std::vector<Reflector>& all) {
    std::vector<Eigen::Vector3d> normals;
    for (const Reflector& r : all) {
        const bool known = std::any_of(normals.begin(), normals.end(), [&](const Eigen::Vector3d& n) {
            return std::min((n - r.normal).squaredNorm(), (n + r.normal).squaredNorm()) <
                   same_orientation * same_orientation;
        });
        if (!known) normals.push_back(r.normal);
    }
    return normals;
}

}  // namespace

std::vector<SatellitePaths> exhaustive_paths(const UrbanScene& scene, const SceneObserver& observer,
                                             std::span<const SceneSatellite> satellites,
                                             const PathSearchSettings& settings) {
    const std::vector<Reflector> all = reflectors(scene, settings, observer.position);
    const std::vector<Eigen::Vector3d> normals =
        settings.most_reflections > 2 ? orientations(all) : std::vector<Eigen::Vector3d>{};
    std::vector<SatellitePaths> result;
    for (const SceneSatellite& satellite : satellites) {
        SatellitePaths& paths = result.emplace_back();
        paths.id = satellite.id;
        const Eigen::Vector3d sight = (satellite.position - observer.position).normalized();
        paths.line_of_sight = !scene.blocked({observer.position, sight});
        if (paths.line_of_sight && settings.blocked_only) continue;
        ExhaustiveSearch search(scene, observer, satellite, settings);
        search.try_single(all);
        if (settings.most_reflections > 1) search.try_pairs(all);
        if (settings.most_reflections > 2) search.try_orientations(normals);
        paths.paths = std::move(search).sorted();
    }
    return result;
}

}  // namespace skyloop::test
