/// A series of position fixes read from a file: ours, a receiver's log or a plain table.
/// Carrier-to-noise-density ratios by elevation, summed up as they are read.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/core/result.hpp"
#include "base/core/units.hpp"
#include "base/geo/geodetic.hpp"
#include "base/geo/geoid.hpp"
#include "base/time/gps_time.hpp"

namespace skyloop::inline study {

/// Count, mean and standard deviation of numbers that are not kept (Welford 1962).
class RunningStatistics {
public:
    void add(double value);
    [[nodiscard]] std::size_t n() const { return n_; }
    [[nodiscard]] double mean() const { return mean_; }
    /// Sample standard deviation (n − 1); 0 for fewer than two values.
    [[nodiscard]] double std() const;

private:
    std::size_t n_ = 0;
    double mean_ = 0, squares_ = 0;
};

/// What is told of one satellite at one time.
struct SignalReport {
    Angle elevation;
    DbHz cn0;
};

/// C/N0 of tracked satellites in bins of ten degrees of elevation, dB-Hz.
class SignalStrengthByElevation {
public:
    static constexpr std::size_t bins = 9;
    static constexpr double bin_width_deg = 10;

    /// Counts one report of one satellite. Elevations outside 0 … 90° and C/N0 of zero or less (not tracked) are left
    /// out.
    void add(const SignalReport& report);
    /// The bin from 10·i to 10·(i + 1) degrees; the last one includes 90°.
    [[nodiscard]] const RunningStatistics& bin(std::size_t i) const { return bins_[i]; }
    [[nodiscard]] bool empty() const;

private:
    std::array<RunningStatistics, bins> bins_;
};

/// One row of a fix file.
struct FixSample {
    std::optional<GpsTime> time;  ///< see FixSeries::dated
    bool has_fix = false;
    Geodetic position;              ///< means something only with `has_fix`
    std::optional<Geodetic> truth;  ///< where the antenna really was, when the file knows
    std::optional<int> satellites_used{};
    std::vector<SignalReport> signals{};  ///< of the satellites tracked then; empty: not told
};

/// The samples of one file, or of a part of it, in the file's order.
struct FixSeries {
    std::string name;  ///< for people: the file's name, or a window of it
    std::vector<FixSample> samples;
    bool dated = false;                 ///< false: times only tell samples apart, their day is not known
    std::optional<Seconds> interval;    ///< median time between samples; nothing when the file has no times
    std::vector<std::string> warnings;  ///< what was skipped or assumed on reading, a sentence each

    /// The samples with a fix.
    [[nodiscard]] std::size_t fixes() const;
    /// C/N0 by elevation in all samples; empty: not told.
    [[nodiscard]] SignalStrengthByElevation signal_strength() const;
};

/// Reads a fix file, packed or not. The format is known by its content:
///  - receivers' output as read_observed() reads it; a sample from each epoch with a solution, or that says that it has
///    none. A fix is what has a place with a height, and is neither the time alone nor without a fix;
///  - a table with a header line that names latitude, longitude and height: fixes.csv (INTERFACE.md, section 3) or any
///    other CSV with the usual names; columns in any order, others are ignored;
///  - a table of numbers without a header: latitude, longitude (degrees), height above the ellipsoid (metres);
///  - a track as read_track() reads it.
/// Beside a file called fixes.csv the signal strengths are read from satellites.csv, where that is (INTERFACE.md,
/// section 3). Fails with one sentence that names file and line. RINEX files are refused by name: they hold no fixes.
/// @param geoid for heights above sea level where the file does not tell the undulation
Result<FixSeries> read_fix_series(const std::filesystem::path& path, const Geoid* geoid = nullptr);

/// The same from text already read; `name` stands for the file in messages.
Result<FixSeries> parse_fix_series(std::string_view text, const std::string& name, const Geoid* geoid = nullptr);

/// The series as a receiver would have written it, without the truth: errors are then about a point or its own mean.
FixSeries without_truth(FixSeries series);

/// Which fixes to keep.
struct Slice {
    std::size_t offset = 0;  ///< fixes left out at the start
    std::size_t every = 1;   ///< keep one fix of so many, at least 1
    std::size_t count = 0;   ///< fixes to keep at most; 0: all
};

/// The fixes that `slice` keeps, with the samples without a fix between them and before the first; of these, too, one
/// of `slice.every` is kept, so that the share of fixes stays. The interval grows with `slice.every`.
FixSeries slice(const FixSeries& series, const Slice& slice);

/// The series cut into consecutive windows of `length` fixes, each with the samples without a fix before and between
/// them; what is left at the end is dropped. `length` at least 1.
std::vector<FixSeries> windows(const FixSeries& series, std::size_t length);

}  // namespace skyloop::inline study
