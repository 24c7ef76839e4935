/// What ours is measured against: the usual shooting and bouncing of rays.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "world/scene/detail/path_refiner.hpp"
#include "world/scene/detail/ray_lattice.hpp"
#include "world/scene/path_finder.hpp"

namespace skyloop::bench {

/// Rays over the whole hemisphere; from each point of reflection every hidden satellite is looked for, and where one is
/// seen the planes until there, a prefix of the ray's, are a candidate for the image method, once each. The same
/// lattice, packets of rays, merged planes and table of candidates as PathFinder has.
class PrefixFinder {
public:
    PrefixFinder(const UrbanScene& scene, const PathSearchSettings& settings)
        : scene_(scene), rules_(reflection_rules(settings)), lattice_(settings.rays) {}

    std::vector<SatellitePaths> epoch(const Eigen::Vector3d& place, std::span<const SceneSatellite> satellites) {
        place_ = place;
        std::vector<SatellitePaths> answer(satellites.size());
        targets_.clear();
        for (std::size_t s = 0; s < satellites.size(); ++s) {
            const Eigen::Vector3d u = (satellites[s].position - place).normalized();
            answer[s].id = satellites[s].id;
            answer[s].line_of_sight = !scene_.blocked({place, u});
            if (!answer[s].line_of_sight) targets_.push_back({s, u});
        }
        candidates_.clear();
        tried_.clear();
        if (!targets_.empty()) shoot(satellites);
        verify(answer);
        return answer;
    }

private:
    struct Target {
        std::size_t satellite = 0;
        Eigen::Vector3d direction;
    };
    struct Ray {
        SceneRay ray;
        PlaneSequence planes;
    };
    struct Candidate {
        std::size_t satellite = 0;
        PlaneSequence planes;
        UnfoldedPath unfolded;
    };

    void shoot(std::span<const SceneSatellite> satellites) {
        std::vector<Eigen::Vector3d> directions;
        const ElevationBand all{-1, 1};
        lattice_.select({&all, 1}, 0, directions);
        std::vector<Ray> rays;
        for (const Eigen::Vector3d& direction : directions)
            rays.push_back({{place_, direction}, {}});
        std::vector<SceneRay> plain;
        std::vector<SceneHit> hits;
        for (bool first = true; !rays.empty(); first = false) {
            plain.clear();
            for (const Ray& ray : rays)
                plain.push_back(ray.ray);
            hits.resize(plain.size());
            scene_.first_hits(plain, hits, first);
            std::size_t left = 0;
            for (std::size_t i = 0; i < rays.size(); ++i)
                if (hits[i].any() && reflect(rays[i], hits[i])) rays[left++] = rays[i];
            rays.resize(left);
            look_around(rays, satellites);
        }
    }

    bool reflect(Ray& ray, const SceneHit& hit) const {
        const ScenePlane& plane = scene_.planes()[hit.plane];
        if (!rules_.reflects[static_cast<std::size_t>(plane.kind)]) return false;
        if (static_cast<int>(ray.planes.size()) >= rules_.most_reflections) return false;
        const double towards = plane.normal.dot(ray.ray.direction);
        ray.planes.push_back(hit.plane);
        ray.ray.origin += hit.distance * ray.ray.direction + (towards > 0 ? -2e-3 : 2e-3) * plane.normal;
        ray.ray.direction -= 2 * towards * plane.normal;
        return true;
    }

    void look_around(const std::vector<Ray>& rays, std::span<const SceneSatellite> satellites) {
        looks_.clear();
        of_look_.clear();
        for (std::size_t i = 0; i < rays.size(); ++i) {
            const Eigen::Vector3d& normal = scene_.planes()[rays[i].planes[rays[i].planes.size() - 1]].normal;
            const double side = normal.dot(rays[i].ray.direction);
            for (std::size_t t = 0; t < targets_.size(); ++t)
                if (normal.dot(targets_[t].direction) * side > 0) {
                    looks_.push_back({rays[i].ray.origin, targets_[t].direction});
                    of_look_.push_back({i, t});
                }
        }
        hidden_.resize(looks_.size());
        scene_.blocked(looks_, hidden_);
        for (std::size_t k = 0; k < looks_.size(); ++k) {
            if (hidden_[k]) continue;
            const PlaneSequence& planes = rays[of_look_[k].first].planes;
            const std::size_t satellite = targets_[of_look_[k].second].satellite;
            if (!tried_.insert(sequence_key(satellites[satellite].id, planes_of(planes)))) continue;
            candidates_.push_back(
                {satellite, planes, unfold(scene_, planes_of(planes), place_, satellites[satellite].position)});
        }
    }

    void verify(std::vector<SatellitePaths>& answer) {
        front_.clear();
        for (const Candidate& candidate : candidates_)
            front_.add(place_, candidate.unfolded.arrival);
        front_.trace(scene_, rules_, 0);
        for (const EscapedRay& escaped : front_.escaped()) {
            const Candidate& candidate = candidates_[escaped.ray];
            const auto met = front_.planes(escaped.ray), wanted = planes_of(candidate.planes);
            if (std::equal(met.begin(), met.end(), wanted.begin(), wanted.end()))
                answer[candidate.satellite].paths.push_back(
                    {candidate.planes, candidate.unfolded.arrival, candidate.unfolded.excess, 0});
        }
    }

    const UrbanScene& scene_;
    ReflectionRules rules_;
    RayLattice lattice_;
    Eigen::Vector3d place_;
    std::vector<Target> targets_;
    KeySet tried_;
    std::vector<Candidate> candidates_;
    std::vector<SceneRay> looks_;
    std::vector<std::pair<std::size_t, std::size_t>> of_look_;
    std::vector<std::uint8_t> hidden_;
    Wavefront front_;
};

}  // namespace skyloop::bench
