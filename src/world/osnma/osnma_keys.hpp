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

/// What OSNMA is made from.
struct OsnmaSettings {
    std::uint64_t seed = 0;            ///< of all keys: they are for tests
    GpsTime start;                     ///< of the run; the chain begins with the whole hour that is an hour before
    std::optional<GpsTime> new_key{};  ///< from then on the root key is signed by the second public key; nothing: never
};

inline constexpr int osnma_block_bits = 104;

/// A message that is sent in blocks of 104 bits (section 3.2.2).
struct OsnmaMessage {
    std::uint8_t header = 0;  ///< NMA header: status, chain, status of chain and public key
    int id = 0;               ///< 0 … 11 DSM-KROOT, 12 … 15 DSM-PKR
    BitWriter bits{};         ///< whole blocks
};

/// The keys of a run. The status is operational, the chain number 1, with keys of 128 and tags of 40 bits.
///
/// A new public key is announced for a quarter of an hour (status of the key "new public key"; DSM-PKR and DSM-KROOT by
/// turns), then the root key is signed by it, still with that status for another quarter (Receiver Guidelines 1.3,
/// public key renewal).
class OsnmaKeys {
public:
    explicit OsnmaKeys(const OsnmaSettings& settings);
    ~OsnmaKeys();

    [[nodiscard]] const TeslaChain& chain() const { return chain_; }
    /// What the subframes of all satellites tell blocks of: the signed root key; in the first six and a half minutes of
    /// an hour the public key.
    [[nodiscard]] const OsnmaMessage& message(GpsTime subframe) const;
    /// Status, 2 bits: operational.
    static constexpr std::uint64_t status = 2;

    /// How many public keys this run uses: 1, with a change of it 2.
    [[nodiscard]] int public_keys() const;
    /// The key as PEM. @param number PKID, from 1 on
    [[nodiscard]] std::string public_pem(int number) const;
    /// Keys and tree in the form of the European GNSS Service Centre's file, which OSNMA clients read.
    [[nodiscard]] std::string tree_xml() const;

private:
    struct Secrets;
    [[nodiscard]] OsnmaMessage root_message(int key_status, int number, int id) const;
    [[nodiscard]] OsnmaMessage key_message(int key_status, int number, int id) const;

    OsnmaSettings settings_;
    TeslaChain chain_;
    std::unique_ptr<const Secrets> secrets_;
    std::vector<OsnmaMessage> roots_, keys_;  // by the four parts of a change
};

}  // namespace skyloop::inline world
