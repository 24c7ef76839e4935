/// The header of a RINEX observation file, which later lines of the file may change.
/// Where the observations of each signal stand in the records of an observation file.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fields.hpp"
#include "world/gnss/signal.hpp"
#include "world/rinex/observation_reader.hpp"

namespace skyloop::inline world::rinex {

/// The fields of one observation code; absent ones are -1.
struct CodeColumns {
    int pseudorange = -1, phase = -1, doppler = -1, strength = -1;
};

/// The codes of one signal, the best first.
struct SignalColumns {
    Signal signal = Signal::l1;
    std::vector<CodeColumns> codes;
};

/// What the records of one system look like.
struct SystemLayout {
    std::vector<std::string> types;
    std::size_t announced = 0;  ///< how many types there should be
    std::vector<double> scale;  ///< by field: what its numbers were multiplied by
    std::vector<SignalColumns> signals;
};

/// Takes header lines, before the first epoch and between epochs, and keeps what the epochs need.
class ObservationHeaderReading {
public:
    explicit ObservationHeaderReading(std::string_view name) : name_(name) {}

    /// Reads up to END OF HEADER. Fails with `input` for other kinds of file, other versions, without an end or without
    /// observation types.
    Result<void> read(LineReader& lines);
    /// One line between epochs. What cannot be read is a warning.
    void change(const Line& line);

    [[nodiscard]] int major() const { return static_cast<int>(facts_.version); }
    /// The system of a version 2 satellite without a letter.
    [[nodiscard]] Constellation file_system() const { return system_; }
    /// Nothing when the system has no declared types.
    [[nodiscard]] const SystemLayout* layout(Constellation system) const;
    /// What the header says for users; its epochs are still to come.
    ObservationFile& facts() { return facts_; }
    [[nodiscard]] const ObservationFile& facts() const { return facts_; }

private:
    Result<void> version_line(LineReader& lines);
    void take(const Line& line);
    bool take_types(const Line& line, std::string_view label);
    void take_facts(const Line& line, std::string_view label);
    void types_of_version_2(const Line& line);
    void types_of_version_3(const Line& line);
    void scale_factors(const Line& line);
    void glonass_channels(const Line& line);
    void position(const Line& line);
    void leap_seconds(const Line& line);
    void time_system(const Line& line);
    void add_types(const Line& line, std::size_t first, std::size_t step, std::size_t width, std::size_t most);
    void finish_layouts();
    void warn(const Line& line, std::string_view found, std::string_view expected);

    std::string_view name_;
    Constellation system_ = Constellation::gps;
    std::array<SystemLayout, constellation_names.size()> layouts_;
    std::optional<Constellation> types_of_;  // the system whose list of types may go on
    std::optional<Constellation> scaled_;    // the same of scale factors
    double factor_ = 1;
    bool changed_ = false;
    ObservationFile facts_;
};

}  // namespace skyloop::inline world::rinex
