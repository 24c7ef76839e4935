/// What a run's OSNMA is rooted in: its public keys, their Merkle tree, the chain, and the messages that tell of them
/// (Galileo OSNMA SIS ICD 1.1, sections 3.2 and 6).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/time/gps_time.hpp"
#include "world/osnma/tesla_chain.hpp"

namespace skyloop::inline world {

/// What happens to keys (Receiver Guidelines 1.3, section 6; SIS ICD 1.1, table 4).
enum class OsnmaChange {
    none,
    new_key,        ///< another public key signs
    new_chain,      ///< the chain ends and another one goes on
    revoked_chain,  ///< the chain is not to be used any more, another one follows
    revoked_key,    ///< neither public key nor chain are to be used any more, others follow
    alert,          ///< OSNMA is not to be used any more
};

/// What OSNMA is made from.
struct OsnmaSettings {
    std::uint64_t seed = 0;  ///< of all keys: they are for tests
    GpsTime start;           ///< of the run; the chain begins with the whole hour that is an hour before
    OsnmaChange change = OsnmaChange::none;
    GpsTime at{};  ///< of the change
};

/// NMA status (table 1).
enum class OsnmaStatus : std::uint8_t { operational = 2, do_not_use = 3 };

inline constexpr int osnma_block_bits = 104;

/// A message that is sent in blocks of 104 bits (section 3.2.2).
struct OsnmaMessage {
    std::uint8_t header = 0;  ///< NMA header: status, chain, status of chain and public key
    int id = 0;               ///< 0 … 11 DSM-KROOT, 12 … 15 DSM-PKR
    BitWriter bits{};         ///< whole blocks
};

/// The keys of a run: chains with keys of 128 and tags of 40 bits.
///
/// Beforehand, for a quarter of an hour, a new public key is announced (DSM-PKR and DSM-KROOT by turns), and a new
/// chain (its root in place of the old one's). What is revoked is so from the instant on: for a quarter of an hour the
/// status is "don't use" and the successors are told, for another quarter they serve and the status of the keys still
/// says what has happened. An alert message is sent alone, and nothing follows.
class OsnmaKeys {
public:
    explicit OsnmaKeys(const OsnmaSettings& settings);
    ~OsnmaKeys();

    /// The chain 1, or 2 where there is a change of it.
    [[nodiscard]] const TeslaChain& chain(int number) const { return chains_[static_cast<std::size_t>(number - 1)]; }
    /// The key that is disclosed in a subframe, of the chain in force then; nothing outside of it.
    [[nodiscard]] std::optional<TeslaKey> key(GpsTime subframe) const;
    /// What the subframes of all satellites tell blocks of: the signed root key; in the first six and a half minutes of
    /// an hour the public key.
    [[nodiscard]] const OsnmaMessage& message(GpsTime subframe) const;
    [[nodiscard]] OsnmaStatus status(GpsTime subframe) const;

    /// How many public keys this run uses: 1, with a change of it 2.
    [[nodiscard]] int public_keys() const;
    /// The key as PEM. @param number PKID, from 1 on
    [[nodiscard]] std::string public_pem(int number) const;
    /// Keys and tree in the form of the European GNSS Service Centre's file, which OSNMA clients read.
    [[nodiscard]] std::string tree_xml() const;

private:
    struct Secrets;
    struct Part;
    [[nodiscard]] static std::vector<Part> parts_of(OsnmaChange change);
    [[nodiscard]] std::size_t part_at(GpsTime subframe) const;
    [[nodiscard]] OsnmaMessage root_message(const Part& part, int id) const;
    [[nodiscard]] OsnmaMessage key_message(const Part& part) const;

    OsnmaSettings settings_;
    std::vector<TeslaChain> chains_;
    std::unique_ptr<const Secrets> secrets_;
    std::vector<Part> parts_;                 // in the order of time
    std::vector<OsnmaMessage> roots_, keys_;  // of each of them
};

}  // namespace skyloop::inline world
