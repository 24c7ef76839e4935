/// Faults by name: what they are told, what they do, and what they stand for.
/// Cycles that a receiver's counts of the carrier have lost or won.
/// Which signals the parameters of a fault choose.
/// The catalogue of faults for people.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/core/random.hpp"
#include "base/core/result.hpp"
#include "firmware/core/firmware_faults.hpp"
#include "run/fault/parameters.hpp"
#include "run/fault/receiver_needs.hpp"
#include "run/fault/wire_damage.hpp"
#include "world/flow/observations.hpp"
#include "world/flow/trace.hpp"
#include "world/gnss/satellite.hpp"
#include "world/gnss/signal.hpp"

namespace skyloop::inline run {

/// What faults have done to the counts of one receiver. A count that has slipped stays wrong when its fault is over,
/// until the receiver counts the signal anew.
///
/// State: the counts that are off.
class LostCycles {
public:
    /// Before the faults of an epoch: forgets signals that are counted anew, or not at all.
    void follow(const Observations& observations);
    /// A count breaks by so many cycles. @param noticed the receiver knows it at once
    void slip(const Observation& observation, GpsTime now, double cycles, bool noticed);
    /// After the faults of an epoch: puts what was lost into phases and lock times.
    void apply(Observations& observations, GpsTime now);
    [[nodiscard]] bool empty() const { return counts_.empty(); }

private:
    struct Count {
        double cycles = 0;
        std::optional<GpsTime> noticed{};  // the last slip that it saw
    };
    using Key = std::pair<SatelliteId, Signal>;

    std::map<Key, Count> counts_;
};

/// Where a fault works.
enum class FaultLayer {
    signals,   ///< what reaches the antenna, or is measured of it
    solution,  ///< what the receiver believes or reports
    receiver,  ///< how it behaves
    wire,
    corrections  ///< of a base station on their way to a rover
};
inline constexpr std::string_view fault_layer_names[] = {"signals", "solution", "receiver", "wire", "corrections"};

/// An instant of a fault at work.
struct FaultMoment {
    GpsTime now;
    Seconds since_start{0};             ///< of this occurrence
    double strength = 1;                ///< 0 … 1 along its ramps
    const TruthState* truth = nullptr;  ///< of the epoch; null for edits of the receiver, the wire and the pace
    const SkyView* sky = nullptr;       ///< as `truth`; its satellites stand as those of the arrivals
    LostCycles* lost_cycles = nullptr;  ///< of the receiver, for edits of observations; else null
    MeasurementTerms* terms = nullptr;  ///< what the observations are made of, for edits of them; else null
    double strength_rate = 0;           ///< 1/s, by which `strength` changes along its ramps
};

/// How simulated time passes against the clocks of the device under test.
struct PaceConditions {
    double rate = 1;  ///< simulated seconds per second of the run's own pace
};

/// A change of one value on its way.
template <class Value>
using Edit = std::function<void(Value&, const FaultMoment&)>;

/// One occurrence of a fault at one receiver: the edits that it makes, each called while it lasts. An edit may keep
/// state; a new occurrence is made anew. Edits of epochs are called once an epoch, in the order of their epochs; those
/// of the receiver, the wire and the pace whenever the loop looks, and so must depend on the moment alone.
struct Fault {
    Edit<Arrivals> arrivals{};                  ///< before they are measured
    Edit<Observations> observations{};          ///< before they are solved
    Edit<Epoch> epoch{};                        ///< before the firmware sees it
    Edit<firmware::NavigationState> report{};   ///< what the firmware is about to report
    Edit<firmware::FirmwareFaults> firmware{};  ///< how it behaves
    Edit<WireConditions> wire{};
    Edit<PaceConditions> pace{};
    std::vector<firmware::ReceiverEvent> at_start{};  ///< happen once
    std::vector<firmware::ReceiverEvent> at_end{};
};

/// What an occurrence is made with.
struct FaultContext {
    std::uint64_t seed = 1;  ///< of the receiver that it works on
    std::string name;        ///< of the fault, with the number of the occurrence: "outage", "outage#2"

    /// Random numbers of its own.
    [[nodiscard]] RandomStream stream(std::string_view of) const {
        return RandomStream(seed, "fault." + name + "." + std::string(of));
    }
};

/// A fault that can be asked for, as constant data.
struct FaultKind {
    std::string_view name{};    ///< as scenario files have it: "byte_loss"
    std::string_view effect{};  ///< what it does, a sentence
    std::string_view cause{};   ///< what brings it about in the world, a sentence
    ParameterList parameters{};
    /// Fails with `usage` for parameters that contradict each other.
    Result<Fault> (*make)(const Parameters&, const FaultContext&) = nullptr;
    bool measuring_receivers_only = false;  ///< nothing to see with a sensor model, which measures nothing
    bool has_strength = true;               ///< it can be there in part, and so grow and fade along ramps
    FaultLayer layer = FaultLayer::signals;
    const ReceiverNeed* need = nullptr;  ///< nothing comes of it at a receiver that lacks this

    /// The same, with that need.
    [[nodiscard]] constexpr FaultKind that_needs(const ReceiverNeed& of_receiver) const {
        FaultKind kind = *this;
        kind.need = &of_receiver;
        return kind;
    }
};

// What rows of tables of kinds say of themselves.
inline constexpr bool of_measurements = true, with_strength = true;

/// All of them, by layer, then in the order in which people list them.
const std::vector<FaultKind>& fault_kinds();
/// The one of that name, or null.
const FaultKind* find_fault_kind(std::string_view name);

/// A value of a parameter, or a parameter, of which nothing comes.
struct IdlePart {
    std::string_view parameter{};
    std::string value{};  ///< of a list or a word; else empty
    std::string why{};    ///< "ublox-m9 never sends THS"
};
/// What of a fault comes to nothing at a receiver.
struct IdleParts {
    std::string whole{};  ///< why all of it does; empty: something comes of it
    std::vector<IdlePart> parts{};
};
/// By the needs of the kind and of its parameters. @param parameters checked
IdleParts idle_parts(const FaultKind& kind, const Parameters& parameters, const UsedReceiver& receiver);

/// What is wrong with the ramps of a fault of this kind: what is there or not, cannot have any.
/// @param values `ramp_in_s` and `ramp_out_s` among them
std::vector<ParameterMistake> ramp_mistakes(const FaultKind& kind, const Parameters& values);

/// Whether a fault with these checked parameters is for a signal, wherever in the sky its satellite stands. One that
/// chooses no satellites and signals is for all.
bool is_for(const Parameters& parameters, SatelliteId satellite, Signal signal);

/// A line a kind, by layer.
std::string fault_list_text();
/// One kind with its parameters.
std::string fault_text(const FaultKind& kind);
/// Every kind, command and key of the timeline, as a page of Markdown.
std::string fault_catalogue_markdown();

}  // namespace skyloop::inline run
