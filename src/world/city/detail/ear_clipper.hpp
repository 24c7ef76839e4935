/// Polygons with holes, cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "world/city/footprint.hpp"

namespace skyloop::inline world {

/// Ear clipping (Meisters 1975) on one ring to which the holes are bridged (Eberly, "Triangulation by Ear Clipping"),
/// with points found by their place on a Z curve; where no ear is left, crossings of neighbouring edges are cut away
/// and the ring is split at a diagonal. Work is bounded: what a pathological ring leaves over is not covered.
class EarClipper {
public:
    explicit EarClipper(const Footprint& footprint);

    /// Triangles with an area, counter-clockwise, as indices of the points: outer first, then hole after hole.
    std::vector<std::array<std::uint32_t, 3>> triangles();
    /// The outer ring with its holes joined to it by bridges that are run through twice. Call before triangles().
    [[nodiscard]] std::vector<Eigen::Vector2d> bridged_ring() const;

private:
    static constexpr int none = -1;
    struct Corner {
        Eigen::Vector2d at;
        std::uint32_t index = 0;  ///< of the footprint's point
        int previous = none, next = none;
        std::uint32_t code = 0;  ///< on the Z curve
        int earlier = none, later = none;
    };
    /// A ring still to be cut, and what has been tried on it.
    struct Task {
        int start = none;
        int attempt = 0;
    };

    bool measure(const Footprint& footprint);
    int link_ring(const std::vector<Eigen::Vector2d>& ring, std::uint32_t first, bool anticlockwise);
    int append(const Eigen::Vector2d& at, std::uint32_t index, int last);
    void remove(int corner);
    int without_idle_corners(int start, int end);
    int without_idle_corners(int start) { return without_idle_corners(start, start); }

    void join_holes(std::vector<int>& holes);
    [[nodiscard]] int leftmost(int start) const;
    int bridge_to(int hole);
    int better_bridge(int found, int hole, double crossing_x);
    [[nodiscard]] bool sector_contains_sector(int outer, int inner) const;
    int split(int a, int b);

    void clip(Task task);
    [[nodiscard]] bool is_ear(int ear);
    [[nodiscard]] bool is_ear_by_code(int ear, const std::array<std::uint32_t, 2>& codes);
    [[nodiscard]] bool spoils(int corner, int ear) const;
    void emit(int a, int b, int c);
    int without_local_crossings(int start);
    void split_and_clip(int start);

    void order_by_code(int start);
    [[nodiscard]] std::uint32_t code_of(const Eigen::Vector2d& at) const;
    [[nodiscard]] double turn(int a, int b, int c) const;
    [[nodiscard]] bool same_place(int a, int b) const { return corners_[index(a)].at == corners_[index(b)].at; }
    [[nodiscard]] bool locally_inside(int a, int b) const;
    [[nodiscard]] bool middle_inside(int a, int b);
    [[nodiscard]] bool crosses_ring(int a, int b);
    [[nodiscard]] bool valid_diagonal(int a, int b);
    [[nodiscard]] bool segments_meet(std::pair<int, int> first, std::pair<int, int> second) const;
    [[nodiscard]] bool spent(std::int64_t steps) { return (budget_ -= steps) < 0; }

    /// Twice the area of a triangle, positive when it turns left at b.
    static double turn_of(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
        return (b.x() - a.x()) * (c.y() - b.y()) - (b.y() - a.y()) * (c.x() - b.x());
    }
    static double doubled_area(const std::vector<Eigen::Vector2d>& ring);
    static bool inside_triangle(const std::array<Eigen::Vector2d, 3>& t, const Eigen::Vector2d& p) {
        return turn_of(t[0], t[1], p) >= 0 && turn_of(t[1], t[2], p) >= 0 && turn_of(t[2], t[0], p) >= 0;
    }
    static std::size_t index(int corner) { return static_cast<std::size_t>(corner); }
    Corner& at(int corner) { return corners_[index(corner)]; }
    [[nodiscard]] const Corner& at(int corner) const { return corners_[index(corner)]; }

    std::vector<Corner> corners_;
    std::vector<Task> tasks_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    Eigen::Vector2d lowest_ = Eigen::Vector2d::Zero();
    double code_scale_ = 0;
    bool hashed_ = false;
    std::int64_t budget_ = 0;  ///< steps that may still be done
    int outer_ = none;
};

}  // namespace skyloop::inline world
